// The units and wires of every design, in the order of the data's flow (netlist.h). To add a unit: a line that makes it,
// and one for each wire that reaches it.
#include <string>

#include "modules/machine.h"
#include "modules/units/edge_tests/collect_tests.h"
#include "modules/units/edge_tests/sequence_tests.h"
#include "modules/units/family/pass_or_tessellate.h"
#include "modules/units/family/sequence_tests.h"
#include "modules/units/family/tessellation.h"
#include "modules/units/pass_or_tessellate.h"

namespace tessera {

namespace {

/// Figure 8 without the unit that collects the results.
struct TestUnits {
    CalculateNewU& calculate_new_u;
    TexCoordTest& tex_coord_test;
    HeightTestUnit& height_test;
    NormalTest& normal_test;
    ViewTest& view_test;

    explicit TestUnits(Netlist& net)
        : calculate_new_u(net.make<CalculateNewU>("calculate_new_u")),
          tex_coord_test(net.make<TexCoordTest>("tex_coord_test")),
          height_test(net.make<HeightTestUnit>(functions_of(net.context().registers.formats.height_test).unit())),
          normal_test(net.make<NormalTest>("normal_test")),
          view_test(net.make<ViewTest>("view_test")) {}
};

/// One lane of tests, and their results to `collector`.
template <class Collector>
void wire_tests(Netlist& net, const TestUnits& tests, Collector& collector) {
    net.wire(tests.calculate_new_u.to_tex_coord_test, tests.tex_coord_test.input);
    net.wire(tests.calculate_new_u.to_view_test, tests.view_test.input);
    net.wire(tests.tex_coord_test.output, collector.from_tex_coord_test);
    net.wire(tests.height_test.output, collector.from_summed_height_test);
    net.wire(tests.normal_test.output, collector.from_normal_test);
    net.wire(tests.view_test.output, collector.from_view_test);
}

/// All tests in parallel.
void add_parallel_tests(Netlist& net) {
    const TestUnits tests(net);
    auto& collect = net.make<CollectTests>("collect_tests");
    net.wire(tests.calculate_new_u.to_summed_height_test, tests.height_test.input);
    net.wire(tests.calculate_new_u.to_normal_test, tests.normal_test.input);
    wire_tests(net, tests, collect);
}

/// The cheapest first.
void add_sequenced_tests(Netlist& net) {
    const TestUnits tests(net);
    auto& sequence = net.make<SequenceTests>("sequence_tests");
    net.wire(tests.calculate_new_u.to_summed_height_test, sequence.height_operands);
    net.wire(tests.calculate_new_u.to_normal_test, sequence.normal_operands);
    net.wire(sequence.to_summed_height_test, tests.height_test.input);
    net.wire(sequence.to_normal_test, tests.normal_test.input);
    wire_tests(net, tests, sequence);
}

/// Likewise, with lanes of cheap tests and further Normal Tests.
void add_lanes(Netlist& net) {
    const Design& design = net.context().design;
    const TestUnits tests(net);
    auto& sequence = net.make<FamilySequenceTests>("sequence_tests");
    const auto wire_lane = [&](unsigned k, CalculateNewU& calculate, TexCoordTest& tex_coord, ViewTest& view) {
        net.wire(calculate.to_tex_coord_test, tex_coord.input);
        net.wire(calculate.to_view_test, view.input);
        net.wire(calculate.to_summed_height_test, sequence.height_operands[k]);
        net.wire(calculate.to_normal_test, sequence.normal_operands[k]);
        net.wire(tex_coord.output, sequence.from_tex_coord_test[k]);
        net.wire(view.output, sequence.from_view_test[k]);
    };
    wire_lane(0, tests.calculate_new_u, tests.tex_coord_test, tests.view_test);
    for (unsigned k = 1; k < design.edge_lanes; ++k) {
        const std::string number = "_" + std::to_string(k);
        auto& calculate = net.make<CalculateNewU>("calculate_new_u" + number);
        auto& tex_coord = net.make<TexCoordTest>("tex_coord_test" + number);
        auto& view = net.make<ViewTest>("view_test" + number);
        wire_lane(k, calculate, tex_coord, view);
    }
    for (unsigned k = 0; k < design.normal_tests; ++k) {
        NormalTest& test = k == 0 ? tests.normal_test : net.make<NormalTest>("normal_test_" + std::to_string(k));
        net.wire(sequence.to_normal_test[k], test.input);
        net.wire(test.output, sequence.from_normal_test[k]);
    }
    net.wire(sequence.to_summed_height_test, tests.height_test.input);
    net.wire(tests.height_test.output, sequence.from_summed_height_test);
}

}  // namespace

Netlist TessellationTests::units_of(const UnitContext& context, UnitFactory& factory) {
    Netlist net(context, factory);
    const Design& design = context.design;
    const auto add = design.test_order == TestOrder::parallel ? add_parallel_tests
                     : design.work == Work::triangle          ? add_sequenced_tests
                                                              : add_lanes;
    add(net);
    return net;
}

/// From Get Triangle to Transform.
void Machine::add_geometry(Netlist& net) {
    auto& get = net.make<GetTriangle>("get_triangle");
    auto& calculate = net.make<CalculateNewP>("calculate_new_p");
    net.wire(get.to_calculate_new_p, calculate.from_get_triangle);
    auto& displace = net.make<DisplaceVertex>("displace_vertex");
    net.wire(calculate.to_displace_vertex, displace.from_calculate_new_p);
    net.wire([this, &displace] {
        join(displace.displacement_map, displacement_map);
        if (displace.normal_map)
            join(*displace.normal_map, normal_map);
    });
    auto& to_screen = net.make<Transform>("transform");
    net.wire(displace.to_transform, to_screen.from_displace_vertex);
}

/// Joins a triangle with what the geometry branch makes of it.
template <class AnyUnit>
AnyUnit& Machine::add_join(Netlist& net, const char* name) {
    auto& joining = net.make<AnyUnit>(name);
    net.wire(net.the<GetTriangle>().to_join, joining.from_get_triangle);
    net.wire(net.the<Transform>().to_join, joining.from_transform);
    return joining;
}

void Machine::add_tests(Netlist& net) {
    const UnitContext& context = net.context();
    tessellation_tests.init(context.design.tests_units, [&](const char* name, std::size_t number) {
        const auto k = static_cast<unsigned>(number);
        return new TessellationTests(name, {context.clock, context.registers, context.design, k}, net.factory());
    });
    for (TessellationTests& tests : tessellation_tests) {
        net.add(tests);
        net.wire([this, &tests] {
            join(tests.height_test.table, height_table);
            if (tests.height_test.displacement_map)
                join(*tests.height_test.displacement_map,
                     displacement_map_for_tests != nullptr ? *displacement_map_for_tests : displacement_map);
            for (NormalTest* normal_test : tests.normal_tests())
                join(normal_test->normal_map, normal_map);
        });
    }
}

/// From the units that send a triangle on, or its children back.
void Machine::add_ends(Netlist& net, StreamOutput<datapath::Triangle>& to_triangle_queue, DecidingUnit& deciding) {
    auto& get = net.the<GetTriangle>();
    auto& queue = net.make<TriangleQueue>("triangle_queue");
    net.wire(to_triangle_queue, queue.from_tessellation);
    net.wire(queue.to_get_triangle, get.from_triangle_queue);
    net.wire(queue.level, get.queue_level);
    net.wire([this, &queue] { netlist_.factory().join(queue.off_chip_memory, off_chip_memory); });
    auto& light = net.make<Lighting>("lighting");
    net.wire(deciding.to_lighting, light.from_pass_or_tessellate);
}

Netlist Machine::triangle_design(Netlist net) {
    add_geometry(net);
    add_tests(net);
    auto& decide = add_join<PassOrTessellate>(net, "pass_or_tessellate");
    for (std::size_t k = 0; k < tessellation_tests.size(); ++k) {
        const TessellationTests& tests = tessellation_tests[k];
        net.wire(net.the<GetTriangle>().to_tessellation_tests[k], tests.calculate_new_u.input);
        net.wire(net.the<Transform>().to_view_test[k], *tests.view_test.from_transform);
        net.wire(tests.collector.tested_edges(), decide.from_tessellation_tests[k]);
    }
    auto& tessellate = net.make<Tessellation>("tessellation");
    net.wire(decide.to_tessellation, tessellate.from_pass_or_tessellate);
    add_ends(net, tessellate.to_triangle_queue, decide);
    return net;
}

Netlist Machine::family_design(Netlist net) {
    add_geometry(net);
    auto& tessellate = add_join<FamilyTessellation>(net, "tessellation");
    add_tests(net);
    auto& decide = net.make<FamilyPassOrTessellate>("pass_or_tessellate");
    net.wire(tessellate.to_pass_or_tessellate, decide.from_tessellation);
    const TessellationTests& tests = tessellation_tests[0];
    const std::vector<CalculateNewU*> lanes = tests.netlist().all<CalculateNewU>();
    for (std::size_t k = 0; k < lanes.size(); ++k) {
        net.wire(tessellate.to_tessellation_tests[k], lanes[k]->input);
        net.wire(tests.collector.tested_edges(k), decide.from_tessellation_tests[k]);
    }
    add_ends(net, decide.to_triangle_queue, decide);
    return net;
}

}  // namespace tessera

#include "testbench/prove/schedule/machine_plan.h"

#include <algorithm>

#include "modules/units/edge_tests/collect_tests.h"
#include "modules/units/pass_or_tessellate.h"

namespace tessera::schedule {

namespace {

PipelinePlan pipeline_plan(const UnitTiming& timing, unsigned servers = 1, unsigned further_stages = 0) {
    return {timing.latency, timing.interval, servers, register_stages(timing, servers, further_stages)};
}

TablePlan table_plan(const TableMemory& memory, const MemoryTiming& timing, const StallParameters& stalls,
                     const datapath::TableLayout& layout, unsigned under_way) {
    const unsigned slots = timing.width == 0 ? 1 : (layout.entry_bytes + timing.width - 1) / timing.width;
    return {{timing.buffer, RandomStalls(stalls, memory.name())},
            timing.ports,
            timing.banks,
            slots,
            timing.latency,
            timing.window,
            under_way};
}

}  // namespace

Plan plan_of(const tessera::Machine& machine, const Rasteriser& rasteriser, const Design& design) {
    const Timing& t = design.timing;
    const datapath::Registers& registers = machine.registers();
    const TessellationTests& tests = machine.tessellation_tests[0];
    const auto& join = machine.netlist().the<PassOrTessellate>();
    const auto& collect = tests.netlist().the<CollectTests>();
    const auto input = [&](const auto& of) {
        return InputPlan{static_cast<unsigned>(of.depth()), RandomStalls(t.stalls, of.name())};
    };

    Plan plan;
    plan.source.from_host = input(machine.get_triangle.from_host);
    plan.source.from_triangle_queue = input(machine.get_triangle.from_triangle_queue);
    plan.source.from_tessellation = input(machine.triangle_queue.from_tessellation);
    plan.source.queue = pipeline_plan(t.triangle_queue);
    plan.source.newest_first = design.queue.order == TriangleOrder::lifo;
    plan.source.watermark = std::max<std::uint64_t>(design.queue.watermark, 1);
    plan.get_triangle = pipeline_plan(t.get_triangle);
    plan.calculate_new_p = {input(machine.calculate_new_p.from_get_triangle), pipeline_plan(t.calculate_new_p)};
    plan.displace_vertex = {input(machine.displace_vertex.from_calculate_new_p),
                            pipeline_plan(t.displace_vertex, 1, displace_vertex_latency(design))};
    plan.transform = {input(machine.transform.from_displace_vertex),
                      pipeline_plan(t.transform, design.transform_pipelines)};
    UnitTiming normal_test = t.normal_test;
    if (registers.tests.highlight_test)
        normal_test.latency += t.highlight_test_latency;
    plan.tests = {{input(tests.calculate_new_u.input), pipeline_plan(t.calculate_new_u)},
                  {input(tests.tex_coord_test.input), pipeline_plan(t.tex_coord_test)},
                  {input(tests.height_test.input), pipeline_plan(height_test_timing(t, registers.formats), 1,
                                                                 height_test_latency(design, registers.formats))},
                  {input(tests.normal_test.input), pipeline_plan(normal_test, 1, t.read_latency(t.normal_map))},
                  {input(tests.view_test.input), pipeline_plan(t.view_test)},
                  input(*tests.view_test.from_transform),
                  {input(collect.from_normal_test), input(collect.from_tex_coord_test),
                   input(collect.from_summed_height_test), input(collect.from_view_test)},
                  input(join.from_tessellation_tests[0])};
    plan.join_triangles = input(join.from_get_triangle);
    plan.join_parts = input(join.from_transform);
    plan.join_places = t.pass_or_tessellate.buffer;
    plan.join = pipeline_plan(t.pass_or_tessellate);
    plan.tessellation_input = input(machine.netlist().the<Tessellation>().from_pass_or_tessellate);
    plan.tessellation = pipeline_plan(t.tessellation);
    plan.lighting = {input(machine.lighting.from_pass_or_tessellate), pipeline_plan(t.lighting)};
    plan.rasteriser = input(rasteriser.from_lighting);
    const unsigned displaced = plan.displace_vertex.pipeline.stages + 1;
    const unsigned tested = plan.tests.height_test.pipeline.stages + 1;
    const unsigned bumped = plan.tests.normal_test.pipeline.stages + 1;
    plan.displacement_map =
        table_plan(machine.displacement_map, t.displacement_map, t.stalls, registers.displacement_map, displaced);
    if (machine.displacement_map_for_tests != nullptr)
        plan.displacement_map_for_tests = table_plan(*machine.displacement_map_for_tests, t.displacement_map, t.stalls,
                                                     registers.displacement_map, tested);
    plan.normal_map = table_plan(machine.normal_map, t.normal_map, t.stalls, registers.normal_map, bumped);
    plan.height_table =
        table_plan(machine.height_table, height_table_timing(t, registers.formats), t.stalls, registers.height_table,
                   functions_of(registers.formats.height_test).requests * plan.tests.height_test.pipeline.stages + 1);
    return plan;
}

}  // namespace tessera::schedule

#include "modules/pipeline.h"

#include <algorithm>
#include <string>

#include "modules/datapath/pack_triangle.h"

namespace tessera {

Pipeline::Pipeline(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                   const Design& design, Wiring* wiring)
    : sc_module(name),
      clock("clock", clock_period(this->name(), design.timing.cycle_picoseconds)),
      get_triangle("get_triangle", clock, design.timing, design.tests_units, passes),
      calculate_new_p("calculate_new_p", clock, design.timing),
      displace_vertex("displace_vertex", clock, registers, design.timing, design.direct_memory),
      transform("transform", clock, registers, design.timing, design.transform_pipelines, design.tests_units),
      tessellation_tests("tessellation_tests"),
      pass_or_tessellate("pass_or_tessellate", clock, registers, design.timing, design.tests_units, passes),
      tessellation("tessellation", clock, registers, design.timing, passes),
      triangle_queue("triangle_queue", clock, registers, design.queue, design.timing),
      lighting("lighting", clock, registers, design.timing),
      displacement_map("displacement_map", clock, registers.displacement_map, design.timing.displacement_map,
                       design.timing.stalls),
      normal_map("normal_map", clock, registers.normal_map, design.timing.normal_map, design.timing.stalls),
      summed_height_table("summed_height_table", clock, registers.summed_height_table,
                          design.timing.summed_height_table, design.timing.stalls),
      off_chip_memory("off_chip_memory", clock, design.timing.off_chip_memory, design.timing.stalls,
                      design.queue.off_chip_triangles * (datapath::packed_triangle_bytes(registers.formats) +
                                                         datapath::packed_triangle_tag_bytes),
                      datapath::packed_triangle_tag_bytes),
      transport_(design.transport),
      random_stalls_(design.timing.stalls.per_mille > 0) {
    tessellation_tests.init(design.tests_units, [&](const char* unit_name, std::size_t number) {
        return new TessellationTests(unit_name, clock, registers, design.timing,
                                     static_cast<unsigned>(number), design.tests_units, design.direct_memory);
    });
    Wiring straight;
    wire(wiring == nullptr ? straight : *wiring);
    attach();
}

void Pipeline::wire(Wiring& wiring) {
    wiring.join(get_triangle.to_calculate_new_p, calculate_new_p.from_get_triangle);
    get_triangle.queue_level.bind(triangle_queue.level);
    wiring.join(calculate_new_p.to_displace_vertex, displace_vertex.from_calculate_new_p);
    wiring.join(displace_vertex.to_transform, transform.from_displace_vertex);
    wiring.join(displace_vertex.displacement_map, displacement_map);
    wiring.join(transform.to_pass_or_tessellate, pass_or_tessellate.from_transform);
    for (std::size_t k = 0; k < tessellation_tests.size(); ++k) {
        TessellationTests& tests = tessellation_tests[k];
        tests.wire(wiring);
        wiring.join(get_triangle.to_tessellation_tests[k], tests.calculate_new_u.input);
        wiring.join(transform.to_view_test[k], tests.view_test.from_transform);
        wiring.join(tests.collect_tests.to_pass_or_tessellate, pass_or_tessellate.from_tessellation_tests[k]);
        wiring.join(tests.summed_height_test.summed_height_table, summed_height_table);
        wiring.join(tests.normal_test.normal_map, normal_map);
    }
    wiring.join(pass_or_tessellate.to_tessellation, tessellation.from_pass_or_tessellate);
    wiring.join(pass_or_tessellate.to_lighting, lighting.from_pass_or_tessellate);
    wiring.join(tessellation.to_triangle_queue, triangle_queue.from_tessellation);
    wiring.join(triangle_queue.to_get_triangle, get_triangle.from_triangle_queue);
    wiring.join(triangle_queue.off_chip_memory, off_chip_memory);
}

/// On the clock: downstream first (clock.h); in the list: as the figures are read.
void Pipeline::attach() {
    units_ = {&get_triangle, &calculate_new_p, &displace_vertex, &transform};
    for (TessellationTests& tests : tessellation_tests)
        units_.insert(units_.end(), {&tests.calculate_new_u, &tests.tex_coord_test, &tests.summed_height_test,
                                     &tests.normal_test, &tests.view_test, &tests.collect_tests});
    units_.insert(units_.end(), {&pass_or_tessellate, &tessellation, &triangle_queue, &lighting,
                                 &displacement_map, &normal_map, &summed_height_table, &off_chip_memory});
    clock.attach(off_chip_memory);
    for (Unit* memory : {static_cast<Unit*>(&displacement_map), static_cast<Unit*>(&normal_map),
                         static_cast<Unit*>(&summed_height_table)})
        clock.attach(*memory);
    clock.attach(lighting);
    clock.attach(triangle_queue);
    clock.attach(tessellation);
    clock.attach(pass_or_tessellate);
    for (TessellationTests& tests : tessellation_tests) {
        clock.attach(tests.collect_tests);
        clock.attach(tests.view_test);
        clock.attach(tests.normal_test);
        clock.attach(tests.summed_height_test);
        clock.attach(tests.tex_coord_test);
        clock.attach(tests.calculate_new_u);
    }
    clock.attach(transform);
    clock.attach(displace_vertex);
    clock.attach(calculate_new_p);
    clock.attach(get_triangle);
}

bool Pipeline::idle() const {
    if (transport_ == Transport::blocking)
        return triangle_queue.drained() && pass_or_tessellate.joined();
    return std::all_of(units_.begin(), units_.end(),
                       [](const Unit* unit) { return unit->idle() && unit->holds().empty(); });
}

std::uint64_t Pipeline::normal_map_reads() const {
    std::uint64_t reads = 0;
    for (const TessellationTests& tests : tessellation_tests)
        reads += tests.normal_test.normal_map.reads();
    return reads;
}

std::uint64_t Pipeline::summed_height_table_reads() const {
    std::uint64_t reads = 0;
    for (const TessellationTests& tests : tessellation_tests)
        reads += tests.summed_height_test.summed_height_table.reads();
    return reads;
}

datapath::Saturations Pipeline::saturations() const {
    datapath::Saturations all = displace_vertex.saturations();
    all += transform.saturations();
    for (const TessellationTests& tests : tessellation_tests)
        all += tests.normal_test.saturations();
    all += tessellation.saturations();
    all += lighting.saturations();
    return all;
}

}  // namespace tessera

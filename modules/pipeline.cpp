#include "modules/pipeline.h"

namespace tessera {

Pipeline::Pipeline(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                   const Design& design)
    : sc_module(name),
      get_triangle("get_triangle", design.timing),
      calculate_new_p("calculate_new_p", design.timing),
      displace_vertex("displace_vertex", registers, design.timing, design.direct_memory),
      transform("transform", registers, design.timing),
      tessellation_tests("tessellation_tests", registers, design.timing, design.direct_memory),
      pass_or_tessellate("pass_or_tessellate", registers, design.timing),
      tessellation("tessellation", registers, design.timing),
      triangle_queue("triangle_queue", design.queue_order, design.queue_watermark, design.timing),
      lighting("lighting", registers, design.timing),
      displacement_map("displacement_map", registers.displacement_map,
                       design.timing.cycle * design.timing.memory_read),
      normal_map("normal_map", registers.normal_map, design.timing.cycle * design.timing.memory_read),
      summed_height_table("summed_height_table", registers.summed_height_table,
                          design.timing.cycle * design.timing.memory_read) {
    get_triangle.to_calculate_new_p.bind(calculate_new_p.from_get_triangle);
    get_triangle.to_tessellation_tests.bind(tessellation_tests.from_get_triangle);
    get_triangle.queue_level.bind(triangle_queue.level);
    calculate_new_p.to_displace_vertex.bind(displace_vertex.from_calculate_new_p);
    displace_vertex.to_transform.bind(transform.from_displace_vertex);
    displace_vertex.displacement_map.socket.bind(displacement_map.socket);
    transform.to_pass_or_tessellate.bind(pass_or_tessellate.from_transform);
    transform.to_view_test.bind(tessellation_tests.view_test.from_transform);
    tessellation_tests.to_pass_or_tessellate.bind(pass_or_tessellate.from_tessellation_tests);
    tessellation_tests.summed_height_test.summed_height_table.socket.bind(summed_height_table.socket);
    tessellation_tests.normal_test.normal_map.socket.bind(normal_map.socket);
    pass_or_tessellate.to_tessellation.bind(tessellation.from_pass_or_tessellate);
    pass_or_tessellate.to_lighting.bind(lighting.from_pass_or_tessellate);
    tessellation.to_triangle_queue.bind(triangle_queue.from_tessellation);
    triangle_queue.to_get_triangle.bind(get_triangle.from_triangle_queue);
}

datapath::Saturations Pipeline::saturations() const {
    datapath::Saturations all = displace_vertex.saturations();
    all += transform.saturations();
    all += tessellation_tests.normal_test.saturations();
    return all;
}

}  // namespace tessera

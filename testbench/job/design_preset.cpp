#include "testbench/job/design_preset.h"

namespace tessera {

void apply_design(Job& job) {
    const bool modern = job.hardware.design == DesignPreset::modern;
    const Job::Hardware hardware;  // of the paper's design
    const Timing timing;
    Job::Hardware& h = job.hardware;
    h.work = modern ? Work::family : hardware.work;
    h.test_order = modern ? TestOrder::cheap_first : hardware.test_order;
    h.final_edges = hardware.final_edges;
    h.one_texel_from_map = modern || hardware.one_texel_from_map;
    h.edge_lanes = modern ? 3 : hardware.edge_lanes;
    h.normal_tests = hardware.normal_tests;
    h.tests_units = hardware.tests_units;
    h.queue.order = modern ? TriangleOrder::lifo : hardware.queue.order;
    h.queue.capacity = modern ? 256 : hardware.queue.capacity;
    Timing& t = job.timing;
    t.pass_or_tessellate.buffer = modern ? 96 : timing.pass_or_tessellate.buffer;
    t.edges_in_sequence = modern ? 128 : timing.edges_in_sequence;
    t.displacement_map.ports = modern ? 2 : timing.displacement_map.ports;
    t.normal_map.ports = modern ? 2 : timing.normal_map.ports;
    t.summed_height_table.ports = timing.summed_height_table.ports;
    t.summed_height_table.banks = modern ? 16 : timing.summed_height_table.banks;
    t.summed_height_table.interleave = modern ? Interleave::exclusive_or : timing.summed_height_table.interleave;
    t.summed_height_table.window = modern ? 24 : timing.summed_height_table.window;
}

}  // namespace tessera

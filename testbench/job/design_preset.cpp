#include "testbench/job/design_preset.h"

namespace tessera {

namespace {

/// The keys that a preset sets.
void copy_design(const Job::Hardware& hardware, const Timing& timing, Job& job) {
    Job::Hardware& h = job.hardware;
    h.work = hardware.work;
    h.test_order = hardware.test_order;
    h.final_edges = hardware.final_edges;
    h.one_texel_from_map = hardware.one_texel_from_map;
    h.edge_lanes = hardware.edge_lanes;
    h.normal_tests = hardware.normal_tests;
    h.tests_units = hardware.tests_units;
    h.queue_order = hardware.queue_order;
    h.queue_capacity = hardware.queue_capacity;
    Timing& t = job.timing;
    t.pass_or_tessellate.buffer = timing.pass_or_tessellate.buffer;
    t.edges_in_sequence = timing.edges_in_sequence;
    t.displacement_map.ports = timing.displacement_map.ports;
    t.normal_map.ports = timing.normal_map.ports;
    t.summed_height_table.ports = timing.summed_height_table.ports;
    t.summed_height_table.banks = timing.summed_height_table.banks;
    t.summed_height_table.interleave = timing.summed_height_table.interleave;
    t.summed_height_table.window = timing.summed_height_table.window;
}

}  // namespace

void apply_design(Job& job) {
    Job::Hardware hardware;
    Timing timing;
    if (job.hardware.design == DesignPreset::modern) {
        hardware.work = Work::family;
        hardware.test_order = TestOrder::cheap_first;
        hardware.one_texel_from_map = true;
        hardware.edge_lanes = 3;
        hardware.queue_order = QueueOrder::lifo;
        hardware.queue_capacity = 256;
        timing.pass_or_tessellate.buffer = 96;
        timing.edges_in_sequence = 128;
        timing.displacement_map.ports = 2;
        timing.normal_map.ports = 2;
        timing.summed_height_table.banks = 16;
        timing.summed_height_table.interleave = Interleave::exclusive_or;
        timing.summed_height_table.window = 24;
    }
    copy_design(hardware, timing, job);
}

}  // namespace tessera

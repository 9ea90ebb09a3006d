#include "testbench/prove/schedule/scheduled_case.h"

#include "modules/timing/all_units.h"
#include "testbench/common/random.h"

namespace tessera {

namespace {

/// Varies more than the far more numerous random cases: here each figure may decide which of two events comes first.
void choose_timing(Random& random, Timing& timing) {
    const bool slow = random.chance(30), deep = random.chance(30);
    const auto latency = [&] { return random.natural(1, slow ? 60 : 6); };
    const auto buffer = [&] { return random.natural(1, deep ? 12 : 2); };
    if (random.chance(60))
        for (const UnitSpec& unit : all_units)
            if (unit.timing != nullptr && random.coin())
                timing.*unit.timing = {latency(), random.natural(1, 5), buffer()};
    timing.results_buffer = buffer();
    for (const MemorySpec& memory : all_table_memories) {
        if (random.coin())
            timing.*memory.timing = {random.natural(1, 4), 1u << random.natural(0, 5), random.natural(0, slow ? 60 : 3),
                                     random.natural(0, 8), buffer()};
        (timing.*memory.timing).cache = {};
    }
    if (random.coin()) {
        timing.summed_height_table.window = random.natural(0, 12);
        timing.summed_height_table.interleave = random.coin() ? Interleave::exclusive_or : Interleave::entry;
        timing.summed_height_table.banks = 1u << random.natural(0, 6);
    }
    timing.stalls = {};
    if (random.chance(60))
        timing.stalls = {random.natural(0, 1000000), random.natural(10, 500), random.natural(1, 40)};
    for (MemoryTiming* memory : {&timing.displacement_map, &timing.height_table}) {
        if (!random.chance(30))
            continue;
        memory->banks = 1u << random.natural(0, 5);
        memory->window = random.natural(0, 12);
        memory->interleave = random.coin() ? Interleave::exclusive_or : Interleave::entry;
    }
}

}  // namespace

RandomCase make_scheduled_case(std::uint64_t seed) {
    RandomCase made = make_random_case(seed);
    Random random(~seed);
    Job::Hardware& hardware = made.job.hardware;
    hardware.work = Work::triangle;
    hardware.test_order = TestOrder::parallel;
    hardware.edge_lanes = hardware.normal_tests = hardware.tests_units = 1;
    hardware.one_texel_from_map = false;
    hardware.queue.capacity = 0;
    hardware.transform_pipelines = random.one_of<unsigned>({1, 1, 2, 3, 7});
    hardware.queue.watermark = random.one_of<std::size_t>({1, 1, 2, 5, 30, 1000});
    hardware.machines = random.chance(10) ? 2 : 1;
    made.job.tests.rank_view = RankView::none;
    choose_timing(random, made.job.timing);
    return made;
}

}  // namespace tessera

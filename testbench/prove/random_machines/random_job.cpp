#include "testbench/prove/random_machines/random_job.h"

#include <algorithm>
#include <cmath>

#include "modules/datapath/height_tests.h"
#include "modules/timing/all_units.h"
#include "testbench/setup/height_tests/height_test_host.h"

namespace tessera {

namespace {

void choose_formats(Random& random, std::int64_t least_texture_integer, Job::Formats& formats) {
    const std::int64_t width = random.integer(0, 3);  // 0: the defaults, 1: narrow, 2: wide, 3: any
    if (width == 0) {
        formats.texture_integer = std::max(least_texture_integer, formats.texture_integer);
        return;
    }
    const auto bits = [&](std::int64_t low, std::int64_t high) {
        const std::int64_t third = (high - low) / 3;
        return width == 1 ? random.integer(low, low + third)
                          : (width == 2 ? random.integer(high - third, high) : random.integer(low, high));
    };
    formats.position_bits = bits(10, 32);
    formats.position_fraction = random.integer(0, formats.position_bits - 1);
    formats.normal_bits = bits(6, 18);
    formats.normal_fraction = random.chance(70) ? formats.normal_bits - 2 : random.integer(2, formats.normal_bits - 2);
    formats.texture_integer = std::max(least_texture_integer, bits(1, 12));
    formats.texture_fraction = bits(0, 12);
    formats.displacement_bits = bits(1, 16);
    formats.summed_height_bits = random.chance(80) ? 0 : 48;
    formats.screen_bits = bits(12, 31);
    formats.screen_fraction = random.integer(0, formats.screen_bits - 8);
    formats.generation_bits = bits(1, 4);
}

void choose_tests(Random& random, const Job::Formats& formats, Job::Tests& tests) {
    tests.normal = random.chance(85);
    tests.summed_height = random.chance(85);
    tests.view = random.chance(80);
    tests.tex_coord = random.chance(80);
    tests.generation = random.chance(95);
    tests.highlight = random.chance(25);
    tests.normal_threshold = random.one_of({0.0, 0.001, 0.02, 0.05, 0.12, 0.12, 0.3, 0.7, 2.0});
    tests.summed_height_unit = random.coin() ? SummedHeightUnit::sum : SummedHeightUnit::area;
    tests.threshold("summed_height_threshold") = tests.summed_height_unit == SummedHeightUnit::sum
                                                     ? random.one_of({0.0, 0.01, 0.1, 0.5, 2.0, 2.0, 30.0})
                                                     : random.one_of({0.0, 0.001, 0.01, 0.1, 0.5});
    const double most = std::ldexp(1.0, static_cast<int>(formats.screen_bits - formats.screen_fraction));
    tests.view_threshold = std::min(most, random.one_of({0.0, 0.5, 1.0, 4.0, 4.0, 13.3, 40.0, 200.0}));
    tests.generation_limit =
        std::min(random.chance(60) ? 12 : random.integer(0, 15), (std::int64_t{1} << formats.generation_bits) - 1);
    tests.highlight_angle = random.one_of({0.0, 5.0, 25.0, 60.0, 90.0});
    tests.highlight_normal_threshold = random.one_of({0.0, 0.01, 0.05, 0.3});
}

void choose_camera(Random& random, const JobContext& context, const Job::Formats& formats, Job::Camera& camera) {
    const auto near_the_mesh = [&](double distance) {
        std::array<double, 3> point{};
        for (std::size_t k = 0; k < 3; ++k)
            point[k] = context.centre[k] + distance * context.size * random.real(-1, 1);
        return point;
    };
    camera.eye = near_the_mesh(random.one_of({0.5, 1.0, 3.0, 3.0, 6.0, 20.0}));
    camera.target = near_the_mesh(random.one_of({0.1, 0.1, 1.0, 10.0}));
    camera.up = {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
    camera.field_of_view = random.one_of({2.0, 20.0, 36.0, 60.0, 120.0, 170.0});
    camera.near_plane = std::clamp(context.size * random.one_of({0.0001, 0.01, 0.01, 0.3, 2.0}), 1e-6, 1e6);
    const std::int64_t most = std::int64_t{1}
                              << std::min<std::int64_t>(13, formats.screen_bits - formats.screen_fraction - 1);
    camera.viewport_width = std::min(most, random.one_of<std::int64_t>({1, 160, 640, 1024, 1920, 5000}));
    camera.viewport_height = std::min(most, random.one_of<std::int64_t>({1, 120, 480, 768, 1080, 4000}));
}

void choose_hardware(Random& random, Job::Hardware& hardware) {
    hardware.triangulation = random.one_of({Triangulation::shorter, Triangulation::first, Triangulation::second});
    hardware.culling = random.chance(30) ? Culling::back : Culling::none;
    hardware.queue.order = random.coin() ? TriangleOrder::fifo : TriangleOrder::lifo;
    hardware.queue.watermark = random.one_of<std::size_t>({1, 1, 3, 20, 1000});
    hardware.queue.capacity = random.one_of<std::size_t>({0, 0, 1, 2, 7, 64, 500});
    hardware.queue.overflow = QueueOverflow::spill;  // with other settings, a run with an arbitrary queue may fail
    hardware.queue.off_chip_triangles = 100000;
    hardware.tests_units = random.coin() ? 1 : 3;
    hardware.transform_pipelines = random.one_of<unsigned>({1, 1, 2, 5});
    hardware.direct_memory = random.chance(80);
    hardware.light = {random.real(-1, 1), random.real(-1, 1), random.real(0.1, 1)};
    hardware.ambient = random.real(0, 1);
}

void choose_timing(Random& random, Timing& timing) {
    const auto any = [&](unsigned low, unsigned high) { return random.natural(low, high); };
    if (random.chance(60))
        for (const UnitSpec& unit : all_units)
            if (unit.timing != nullptr && random.chance(40))
                timing.*unit.timing = {any(1, 30), any(1, 4), any(1, 9)};
    timing.highlight_test_latency = any(0, 5);
    timing.results_buffer = any(1, 6);
    for (const MemorySpec& memory : all_table_memories)
        if (random.chance(50))
            timing.*memory.timing = {any(1, 8), any(1, 4), any(0, 40), any(0, 8), any(1, 4)};
    if (random.chance(50))
        timing.off_chip_memory = {any(0, 120), any(1, 64), any(1, 8)};
    if (random.chance(40))
        timing.stalls = {random.natural(0, 1000000), random.one_of({20U, 200U, 700U}), any(1, 20)};
}

}  // namespace

void make_random_job(Random& random, const JobContext& context, Job& job) {
    choose_formats(random, context.least_texture_integer, job.formats);
    choose_tests(random, job.formats, job.tests);
    choose_camera(random, context, job.formats, job.camera);
    choose_hardware(random, job.hardware);
    choose_timing(random, job.timing);
    job.displacement.scale = context.size * random.one_of({0.0, 0.02, 0.1, 0.1, 0.3, 1.0, -0.1, -0.5, 3.0, 0.0001});
    job.displacement.bias = context.size * random.one_of({0.0, 0.0, 0.1, -0.05, 1.0});
    job.check.end_to_end = false;   // narrow formats give another mesh of the same surface
    job.check.allowed_flips = 100;  // narrow formats flip often; each flip is judged by its bound
    job.limits.cycles_without_progress = 200000;
}

void choose_mesh_options(Random& random, Job& job) {
    if (random.coin())
        job.hardware.displacement_filter = MapFilter::bilinear;
    job.formats.tex_coord_fraction =
        std::min(job.formats.texture_fraction, random.one_of<std::int64_t>({-1, -1, 0, 1, 2}));
    if (random.chance(75))
        return;
    const auto tests = static_cast<unsigned>(datapath::height_tests().size());
    job.hardware.height_test = static_cast<HeightTest>(random.natural(1, tests - 1));
    if (job.hardware.height_test != HeightTest::rank) {
        for (const HeightThresholdKey& key : host_of(job.hardware.height_test).thresholds())
            job.tests.threshold(key.name) = std::min(key.range.high, key.value * random.one_of({0.0, 0.1, 1.0, 10.0}));
        job.tests.mipmap_filter = random.one_of({MipmapFilter::mean, MipmapFilter::maximum});
        return;
    }
    if (random.chance(70))
        job.hardware.triangulation = Triangulation::greatest_rank;
    job.formats.rank_bits = random.one_of<std::int64_t>({0, 6, 8, 11, 16});
    job.formats.bound_bits = job.formats.rank_bits == 0 ? 8 : random.one_of<std::int64_t>({0, 0, 6, 13});
    job.tests.threshold("rank_threshold") = random.one_of({0.002, 0.02, 0.2});
    job.tests.threshold("bound_threshold") = random.one_of({0.002, 0.02, 0.2});
    job.tests.rank_view = random.one_of({RankView::none, RankView::per_point, RankView::per_pixel});
    if (job.tests.rank_view != RankView::none) {
        job.hardware.test_order = TestOrder::cheap_first;
        job.tests.threshold("rank_threshold") = random.one_of({0.5, 10.0, 1000.0});
        job.tests.threshold("bound_threshold") = random.one_of({0.5, 4.0, 30.0});
    }
}

void choose_evaluations(Random& random, Job& job) {
    job.hardware.test_order =
        random.coin() && job.tests.rank_view == RankView::none ? TestOrder::parallel : TestOrder::cheap_first;
    job.hardware.final_edges = random.coin();
    job.hardware.work = random.coin() ? Work::triangle : Work::family;
    if (job.hardware.work == Work::family) {
        job.hardware.tests_units = 1;
        if (job.hardware.test_order == TestOrder::cheap_first) {
            job.hardware.edge_lanes = static_cast<unsigned>(random.integer(1, 9));
            job.hardware.normal_tests = static_cast<unsigned>(random.integer(1, 3));
        }
    }
    job.timing.edges_in_sequence = random.natural(1, 40);
    MemoryTiming& table = job.timing.summed_height_table;
    table.window = random.one_of({0U, 1U, 2U, 5U, 12U});
    if (random.coin()) {
        table.interleave = Interleave::exclusive_or;
        table.banks = 1U << random.natural(0, 6);
    }
    job.hardware.one_texel_from_map = random.coin();
    const bool codes_are_sums =
        job.hardware.one_texel_from_map && job.hardware.height_test == HeightTest::summed_height;
    if (random.chance(25) && job.hardware.displacement_filter == MapFilter::nearest && !codes_are_sums)
        job.map.heights = MapHeights::fitted;
    if (random.chance(15))
        job.hardware.machines = random.integer(2, 4);
    if (random.chance(60))
        return;
    for (const MemorySpec& memory : all_table_memories)
        (job.timing.*memory.timing).cache = {random.one_of({0U, 1U, 300U, 4096U}), random.one_of({1U, 16U, 64U, 100U}),
                                             random.natural(1, 4), random.natural(1, 20)};
}

}  // namespace tessera

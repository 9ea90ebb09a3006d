#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "testbench/tests/support/bare_mesh.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"

// The whole machine with a Highlight Test: its meshes and its cycles.

using namespace tessera;
using namespace tessera::testing;

namespace {

Job with_highlight(Job job) {
    job.tests.highlight = true;
    return job;
}

Job functional_job() {
    Job job;
    job.mode = Mode::functional;
    return job;
}

/// Meshes in which some edges are split by HT alone.
const CaseTable meshes(
    "Highlight Test: ",
    {
        // with thresholds that leave edges to the Highlight Test
        SettingsRow{"noisy sphere, narrow normals, functional, conforms",
                    "mode=functional mesh.source=sphere mesh.columns=24 mesh.rows=12 map.source=noise "
                    "map.address_u=repeat displacement.scale=0.02 formats.normal_bits=12 formats.normal_fraction=10 "
                    "tests.summed_height_threshold=2 tests.view_threshold=2"},
        {"half donut, timed, conforms", "mode=timed"},
        {"three tests units, stalls, and a queue that spills its bit, timed, conforms",
         "mode=timed hardware.tests_units=3 hardware.queue_capacity=20 timing.summed_height_table_ports=4 "
         "timing.stalls_seed=5 timing.stalls_per_mille=300"},
    },
    [](const SettingsRow& row) {
        const CheckedRun run(with_settings(with_highlight({}), row.settings));
        CHECK(run.conformance.passed(0.5));
        const auto& counts = run.simulation.decisions.counts();
        CHECK(counts.split_by_highlight > 100);
        CHECK(counts.split_by_highlight <= counts.split_in_highlight);
        CHECK(counts.split_by_normal + counts.split_by_summed_height + counts.split_by_both +
                  counts.split_by_highlight ==
              run.counts.edges_split);
    });

struct Timed {
    std::string name;
    std::string settings;
    std::uint64_t cycles;
};

const CaseTable cycles(
    "Highlight Test: one triangle, ",
    {
        // test_one_triangle.cpp: edge 2 starts in the Normal Test in 32, is read in 33 and complete 9 + 1 later, in 43,
        // before the Summed Height Test's 47.
        Timed{"86 cycles, as without the test", "", 86},
        // The Summed Height Test is complete in 41, the Normal Test in 43: 43 + 38, plus cycle 0.
        {"two ports: one cycle more than the 81 without the test", "timing.summed_height_table_ports=2", 43 + 38 + 1},
    },
    [](const Timed& row) {
        TimedRun simulation(one_triangle(with_settings(with_highlight(one_quad_job()), row.settings)));
        CHECK(simulation.cycles() == row.cycles);
    });

}  // namespace

// 18 base triangles, each split into four until generation 4 (test_throughput.cpp): bound by the Summed Height Table's
// 36 cycles per pass; the Highlight Test only asks for edges that split anyway.
TEST_CASE("Highlight Test: it does not slow down the paper's design") {
    Job job = with_highlight(full_split_job(3, 4));
    job.tests.highlight_normal_threshold = 0;
    TimedRun simulation(setup_of(job));
    CHECK(simulation.machine.pass_or_tessellate.counts().passes == 6138);
    CHECK(simulation.decisions.counts().split_in_highlight > 50);
    CHECK(simulation.cycles() == 5 + 3 + 36 * 6138 + 9);
}

TEST_CASE("Highlight Test: registers follow from the light and the camera") {
    Job job = with_highlight(functional_job());
    job.hardware.light = {0, 0, 5};
    job.camera.eye = {0, -3, 0};
    job.camera.target = {0, 0, 0};
    job.tests.highlight_angle = 60;
    job.tests.highlight_normal_threshold = 0.25;
    const MachineSetup setup = setup_of(job);
    const datapath::TestParameters& tests = setup.registers.tests;
    CHECK(tests.highlight_test);
    CHECK(setup.registers.formats.highlight_tag);
    const std::int32_t half = 11585;  // sqrt(1/2) * 2^14
    CHECK(tests.half_vector == std::array<std::int32_t, 3>{0, -half, half});
    CHECK(tests.highlight_cosine == 1 << 27);
    CHECK(tests.highlight_normal_threshold == 1 << 12);
    CHECK(setup.remarks.empty());

    job.camera.eye = {0, 0, -3};  // opposite the light
    job.camera.up = {0, 1, 0};
    const MachineSetup against = setup_of(job);
    CHECK(against.registers.tests.half_vector == std::array<std::int32_t, 3>{});
    REQUIRE(against.remarks.size() == 1);
    CHECK(against.remarks.front().find("hardware.light") != std::string::npos);

    job.tests.highlight = false;
    const MachineSetup off = setup_of(job);
    CHECK_FALSE(off.registers.tests.highlight_test);
    CHECK_FALSE(off.registers.formats.highlight_tag);
    CHECK(off.registers.tests.half_vector == std::array<std::int32_t, 3>{});
}

TEST_CASE("Highlight Test: it splits edges in the highlight, and nowhere else") {
    const MachineSetup with = setup_of(with_highlight(functional_job()));
    const auto cosine = [&](const datapath::Direction& n) {
        const auto& h = with.registers.tests.half_vector;
        return std::int64_t{n.x} * h[0] + std::int64_t{n.y} * h[1] + std::int64_t{n.z} * h[2];
    };
    std::uint64_t alone = 0;
    for (const EmittedTriangle& triangle : bare_mesh(with).triangles) {
        if (triangle.split_by != datapath::highlight_bit)
            continue;
        ++alone;
        // A corner is an inserted vertex of an edge that NT did not split: its normal's components are within 0.12 of
        // the lit one's, an angle of at most 12 degrees.
        std::int64_t nearest = cosine(triangle.corners[0].displaced_normal);
        for (const auto& corner : triangle.corners)
            nearest = std::max(nearest, cosine(corner.displaced_normal));
        CHECK(static_cast<double>(nearest) > std::ldexp(std::cos((25 + 12) * 3.14159 / 180), 28));
    }
    CHECK(alone > 1000);
}

#include <catch2/catch.hpp>
#include <string>

#include "testbench/job/validate_job.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/prove/exact_arithmetic/exact_comparison.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"

// The same machine with the narrowest and the widest formats, and with odd ones: every decision and value within its
// bound, a closed mesh, and the bare datapath's. Random cases draw others, in both modes.

using namespace tessera;
using namespace tessera::testing;

namespace {

const std::string narrowest =
    "formats.position_bits=8 formats.position_fraction=0 formats.normal_bits=6 formats.normal_fraction=4 "
    "formats.texture_integer=5 formats.texture_fraction=0 formats.displacement_bits=4 "
    "formats.screen_bits=11 formats.screen_fraction=0 formats.generation_bits=3 ";
const std::string widest =
    "formats.position_bits=32 formats.position_fraction=24 formats.normal_bits=18 "
    "formats.normal_fraction=16 formats.texture_integer=12 formats.texture_fraction=12 "
    "formats.displacement_bits=16 formats.summed_height_bits=48 formats.screen_bits=31 "
    "formats.screen_fraction=16 formats.generation_bits=4 ";
/// Prime widths where possible.
const std::string odd =
    "formats.position_bits=23 formats.position_fraction=7 formats.normal_bits=13 formats.normal_fraction=7 "
    "formats.texture_integer=7 formats.texture_fraction=5 formats.displacement_bits=11 "
    "formats.summed_height_bits=37 formats.screen_bits=19 formats.screen_fraction=3 "
    "formats.generation_bits=3 ";
/// Integer bits only, no fraction.
const std::string whole_numbers =
    "formats.position_bits=32 formats.position_fraction=0 formats.normal_bits=18 formats.normal_fraction=4 "
    "formats.texture_fraction=0 formats.screen_bits=31 formats.screen_fraction=0 ";
/// Fraction bits only: positions within -1 .. 1.
const std::string fractions =
    "formats.position_bits=32 formats.position_fraction=31 formats.screen_bits=31 "
    "formats.screen_fraction=20 ";

const std::string plane = "map.width=32 map.height=32 tests.generation_limit=5 ";
const std::string cylinder =
    plane +
    "mesh.source=cylinder mesh.columns=8 mesh.rows=3 map.source=noise map.height=21 map.address_u=repeat "
    "displacement.scale=0.1 hardware.queue_capacity=8 ";  // what is spilled is packed by the formats

/// Compares the datapath without SystemC, which equals the machine, with exact arithmetic.
void check(const ExactComparison& run) {
    INFO(run.conformance.first_mismatch);
    CHECK(run.conformance.mismatches == 0);
    INFO(run.invariants.first_violation);
    CHECK(run.invariants.passed());
}

ExactComparison comparison_of(const Job& job) {
    validate(job);
    const auto [mesh, map, resolved] = load_inputs(job);
    return compare_with_exact(make_setup(resolved.job, mesh, map), ExactModel(resolved.job, mesh, map), 1'000'000);
}

struct Row {
    std::string name;
    std::string job;
    std::string formats;
};

const CaseTable meshes("formats: ",
                       {
                           Row{"the narrowest, a plane", plane, narrowest},
                           {"the narrowest, a cylinder in repeat that spills", cylinder,
                            narrowest + "formats.texture_integer=6"},
                           {"the widest, a cylinder in repeat that spills", cylinder, widest},
                           {"odd bit counts, a cylinder in repeat that spills", cylinder, odd},
                           {"whole numbers, a cylinder in repeat that spills", cylinder, whole_numbers},
                           {"fractions only, a plane", plane, fractions},
                       },
                       [](const Row& row) {
                           const Job job = with_settings({}, "mode=timed " + row.job + row.formats);
                           check(comparison_of(job));
                           const CheckedRun run(job);
                           CHECK(run.counts.edges_split > 0);
                           CHECK(run.setup.input_saturations.position == 0);
                           CHECK(run.setup.input_saturations.normal == 0);
                           const datapath::Saturations counted = run.machine.saturations();
                           // ensured by validation: 1.0 fits a normal, the farthest corner fits w, the model fits half
                           // of the position's range
                           CHECK(counted.normal == 0);
                           CHECK(counted.screen_normal == 0);
                           CHECK(counted.view_distance == 0);
                           CHECK(counted.displaced_position == 0);
                           CHECK(counted.generation == 0);
                       });

}  // namespace

TEST_CASE("formats: a format too wide for an intermediate of the datapath is refused with its name") {
    Job job;
    const BaseMesh mesh = load_mesh(job);
    const HeightMap map = load_map(job);
    job = resolve_job(job, mesh, map).job;
    job.formats.normal_bits = 40;  // beyond the key's range, which validate() would refuse
    job.formats.normal_fraction = 26;
    CHECK_THROWS_WITH(make_setup(job, mesh, map),
                      Catch::Contains("difference times a weight in interpolate") &&
                          Catch::Contains("narrow the formats to the ranges of their keys"));
    job.formats = {};
    CHECK_NOTHROW(make_setup(job, mesh, map));
    job.tests.generation_limit = 16;  // likewise
    CHECK_THROWS_WITH(make_setup(job, mesh, map),
                      Catch::Contains("tests.generation_limit has 4 bits") && Catch::Contains("cannot hold 16") &&
                          Catch::Contains("lower tests.generation_limit or raise formats.generation_bits"));
    job.tests.generation_limit = 15;
    CHECK_NOTHROW(make_setup(job, mesh, map));
    job.formats.generation_bits = 3;
    CHECK_THROWS_WITH(make_setup(job, mesh, map), Catch::Contains("has 3 bits and cannot hold 15"));
    job.formats.generation_bits = 4;
    CHECK_NOTHROW(make_setup(job, mesh, map));
}

// 5 integer bits hold texels up to 32; the registers of the map's size have one bit more.
TEST_CASE("formats: a map too large for its registers is refused, even if no texture coordinate is") {
    Job job;
    job.formats.texture_integer = 5;
    BaseMesh mesh = load_mesh(job);
    for (BaseVertex& vertex : mesh.vertices)
        vertex.texture *= 0.25;
    const auto refused = [&](std::int64_t width, std::int64_t height, const std::string& side) {
        job.map.width = width;
        job.map.height = height;
        const HeightMap map = load_map(job);
        CHECK_THROWS_WITH(make_setup(resolve_job(job, mesh, map).job, mesh, map),
                          "the register map." + side +
                              " has 6 bits and cannot hold 64: use a smaller map or raise "
                              "formats.texture_integer");
        Job wider = job, smaller = job;
        wider.formats.texture_integer = 6;
        CHECK_NOTHROW(make_setup(resolve_job(wider, mesh, map).job, mesh, map));
        smaller.map.width = smaller.map.height = 63;
        const HeightMap smaller_map = load_map(smaller);
        CHECK_NOTHROW(make_setup(resolve_job(smaller, mesh, smaller_map).job, mesh, smaller_map));
    };
    refused(64, 63, "width");
    refused(63, 64, "height");
}

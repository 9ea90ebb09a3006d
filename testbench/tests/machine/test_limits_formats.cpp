#include <catch2/catch.hpp>

#include "testbench/common/error.h"
#include "testbench/explore/widths/width_run.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/prove/random_edges/datapath_random.h"
#include "testbench/tests/support/timed_checks.h"

// The same machine with the narrowest and the widest formats, and with odd ones: no decision or value beyond its bound,
// a closed mesh, and one mesh from both modes and from the bare datapath.

using namespace tessera;
using namespace tessera::testing;

namespace {

Job::Formats narrowest() {
    Job::Formats f;
    f.position_bits = 8;
    f.position_fraction = 0;
    f.normal_bits = 6;
    f.normal_fraction = 4;
    f.texture_integer = 5;
    f.texture_fraction = 0;
    f.displacement_bits = 4;
    f.screen_bits = 11;
    f.screen_fraction = 0;
    f.generation_bits = 3;
    return f;
}

Job::Formats widest() {
    Job::Formats f;
    f.position_bits = 32;
    f.position_fraction = 24;
    f.normal_bits = 18;
    f.normal_fraction = 16;
    f.texture_integer = f.texture_fraction = 12;
    f.displacement_bits = 16;
    f.summed_height_bits = 48;
    f.screen_bits = 31;
    f.screen_fraction = 16;
    f.generation_bits = 4;
    return f;
}

/// Primes, where there are any.
Job::Formats odd() {
    Job::Formats f;
    f.position_bits = 23;
    f.position_fraction = 7;
    f.normal_bits = 13;
    f.normal_fraction = 7;
    f.texture_integer = 7;
    f.texture_fraction = 5;
    f.displacement_bits = 11;
    f.summed_height_bits = 37;
    f.screen_bits = 19;
    f.screen_fraction = 3;
    f.generation_bits = 3;
    return f;
}

/// All range and no fraction.
Job::Formats whole_numbers() {
    Job::Formats f;
    f.position_bits = 32;
    f.position_fraction = 0;
    f.normal_bits = 18;
    f.normal_fraction = 4;
    f.texture_fraction = 0;
    f.screen_bits = 31;
    f.screen_fraction = 0;
    return f;
}

/// All fraction: positions within -1 .. 1.
Job::Formats fractions() {
    Job::Formats f;
    f.position_bits = 32;
    f.position_fraction = 31;
    f.screen_bits = 31;
    f.screen_fraction = 20;
    return f;
}

Job plane_job(const Job::Formats& formats, Mode mode) {
    Job job;
    job.mode = mode;
    job.formats = formats;
    job.map.width = job.map.height = 32;
    job.tests.generation_limit = 5;
    return job;
}

Job cylinder_job(const Job::Formats& formats, Mode mode) {
    Job job = plane_job(formats, mode);
    job.mesh.source = MeshSource::cylinder;
    job.mesh.columns = 8;
    job.mesh.rows = 3;
    job.map.source = MapSource::noise;
    job.map.height = 21;
    job.map.address_u = Addressing::repeat;
    job.displacement.scale = 0.1;
    job.hardware.queue_capacity = 8;  // what is spilled is packed by the formats
    return job;
}

void check(const WidthRun& run) {
    INFO(run.conformance.first_mismatch);
    CHECK(run.conformance.mismatches == 0);
    INFO(run.invariants.first_violation);
    CHECK(run.invariants.passed());
    CHECK(run.invariants.cracks == 0);
    CHECK(run.invariants.t_vertices == 0);
}

/// Both ways of the machine, and the datapath alone.
void expect_one_mesh(const Job& job) {
    validate(job);
    const auto [mesh, map, resolved] = load_inputs(job);
    const MachineSetup setup = make_setup(resolved.job, mesh, map);
    CHECK(setup.input_saturations.position == 0);
    CHECK(setup.input_saturations.normal == 0);
    check(run_widths(setup, ExactModel(resolved.job, mesh, map), 1'000'000));

    Simulation simulation(setup, 1'000'000, 100'000);
    if (job.mode == Mode::timed)
        run_timed(simulation);
    else
        REQUIRE(simulation.run().empty());
    BareRecursion bare(setup);
    EmittedMesh expected;
    CHECK(bare.run(expected) == simulation.pipeline.edges_tested());
    CHECK(keys(expected) == keys(simulation.monitor.mesh));
    CHECK(expected.triangles.size() > setup.base_triangles.size());
    const datapath::Saturations counted = simulation.pipeline.saturations();
    // by validation: 1.0 fits a normal, the farthest corner fits w, the model fits half of the position's range
    CHECK(counted.normal == 0);
    CHECK(counted.screen_normal == 0);
    CHECK(counted.view_distance == 0);
    CHECK(counted.displaced_position == 0);
    CHECK(counted.generation == 0);
}

}  // namespace

TEST_CASE("formats: the narrowest, a plane, functional") {
    expect_one_mesh(plane_job(narrowest(), Mode::functional));
}
TEST_CASE("formats: the narrowest, a plane, timed") {
    expect_one_mesh(plane_job(narrowest(), Mode::timed));
}
TEST_CASE("formats: the narrowest, a cylinder in repeat that spills, timed") {
    Job job = cylinder_job(narrowest(), Mode::timed);
    job.formats.texture_integer = 6;
    expect_one_mesh(job);
}
TEST_CASE("formats: the widest, a plane, functional") {
    expect_one_mesh(plane_job(widest(), Mode::functional));
}
TEST_CASE("formats: the widest, a cylinder in repeat that spills, timed") {
    expect_one_mesh(cylinder_job(widest(), Mode::timed));
}
TEST_CASE("formats: odd ones, a plane, functional") {
    expect_one_mesh(plane_job(odd(), Mode::functional));
}
TEST_CASE("formats: odd ones, a cylinder in repeat that spills, timed") {
    expect_one_mesh(cylinder_job(odd(), Mode::timed));
}
TEST_CASE("formats: whole numbers, a cylinder in repeat that spills, timed") {
    expect_one_mesh(cylinder_job(whole_numbers(), Mode::timed));
}
TEST_CASE("formats: fractions only, a plane, timed") {
    expect_one_mesh(plane_job(fractions(), Mode::timed));
}

TEST_CASE("formats: what an intermediate of the datapath cannot hold is refused with its name") {
    Job job;
    const BaseMesh mesh = load_mesh(job);
    const HeightMap map = load_map(job);
    job = resolve_job(job, mesh, map).job;
    job.formats.normal_bits = 40;  // beyond the key's range, which validate() would refuse
    job.formats.normal_fraction = 26;
    CHECK_THROWS_WITH(make_setup(job, mesh, map),
                      Catch::Contains("(S * d + bias) * N in displace") && Catch::Contains("formats"));
    job.formats = {};
    job.tests.generation_limit = 16;  // likewise
    CHECK_THROWS_WITH(make_setup(job, mesh, map), Catch::Contains("tests.generation_limit has 4 bits") &&
                                                      Catch::Contains("cannot hold 16") &&
                                                      Catch::Contains("raise formats.generation_bits"));
}

// 5 integer bits hold texels up to 32; a register of the map's side has one bit more.
TEST_CASE("formats: a map larger than its registers hold is refused, even where no texture coordinate is") {
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
    };
    refused(64, 63, "width");
    refused(63, 64, "height");
}

TEST_CASE("formats: any that a job may have, on any small job: within the bounds, and closed") {
    Random random(20);
    int ran = 0, refused = 0;
    for (int k = 0; k < 150; ++k) {
        Job job = random.coin() ? plane_job({}, Mode::functional) : cylinder_job({}, Mode::functional);
        Job::Formats& f = job.formats;
        f.position_bits = random.integer(8, 32);
        f.position_fraction = random.integer(0, f.position_bits - 1);
        f.normal_bits = random.integer(6, 18);
        f.normal_fraction = random.integer(0, std::min<std::int64_t>(16, f.normal_bits - 2));
        f.texture_integer = random.integer(5, 12);
        f.texture_fraction = random.integer(0, 12);
        f.displacement_bits = random.integer(1, 16);
        f.summed_height_bits = random.coin() ? 0 : random.integer(8, 48);
        f.screen_bits = random.integer(12, 31);
        f.screen_fraction = random.integer(0, f.screen_bits - 12);
        f.generation_bits = random.integer(3, 4);
        job.camera.viewport_width = random.integer(1, 1024);
        job.camera.viewport_height = random.integer(1, 1024);
        job.displacement.scale = std::ldexp(1.0, static_cast<int>(random.integer(-8, 1)));
        job.tests.generation_limit = 4;
        job.tests.summed_height_threshold = 2;  // a step of the coarsest displacement and more
        job.tests.highlight = random.coin();
        INFO("case " << k);
        try {
            validate(job);
            const auto [mesh, map, resolved] = load_inputs(job);
            const MachineSetup setup = make_setup(resolved.job, mesh, map);
            check(run_widths(setup, ExactModel(resolved.job, mesh, map), 1'000'000));
            ++ran;
        } catch (const InputError& error) {
            ++refused;
            CHECK_THAT(error.what(), Catch::Contains(".") && Catch::Contains("`") ||
                                         Catch::Contains("formats.") || Catch::Contains("tests."));
        }
    }
    CHECK(ran > 60);
    CHECK(refused > 5);
}

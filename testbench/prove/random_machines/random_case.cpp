#include "testbench/prove/random_machines/random_case.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "testbench/common/atomic_file.h"
#include "testbench/common/error.h"
#include "testbench/common/random.h"
#include "testbench/input/mesh/obj_reader.h"
#include "testbench/job/dump_job.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/prove/random_machines/random_job.h"
#include "testbench/setup/height_tests/height_test_host.h"

namespace tessera {

namespace {

constexpr int most_draws = 50;

JobContext context_of(const BaseMesh& mesh, const RandomMap& map) {
    const auto [low, high] = bounds_of(mesh.vertices);
    glm::dvec2 texture_low(0), texture_high(0);
    for (const BaseVertex& vertex : mesh.vertices) {
        texture_low = glm::min(texture_low, glm::floor(vertex.texture));
        texture_high = glm::max(texture_high, vertex.texture);
    }
    JobContext context;
    const glm::dvec3 half = (high - low) / 2.0, centre = (high + low) / 2.0;
    context.size = std::max({half.x, half.y, half.z});
    context.centre = {centre.x, centre.y, centre.z};
    const glm::dvec2 texels = (texture_high - texture_low) * glm::dvec2(map.width, map.height);
    while (context.least_texture_integer < 12 &&
           std::ldexp(1.0, static_cast<int>(context.least_texture_integer)) < std::max(texels.x, texels.y))
        ++context.least_texture_integer;
    return context;
}

RandomCase draw(Random& random) {
    RandomCase made;
    made.map = make_random_map(random);
    made.mesh = make_random_mesh(random, made.map);
    Job& job = made.job;
    job.mesh.source = MeshSource::file;
    job.mesh.file = "mesh.obj";
    job.map.source = MapSource::file;
    job.map.file = "map.pgm";
    job.map.address_u = random.coin() ? Addressing::repeat : Addressing::clamp;
    job.map.address_v = random.coin() ? Addressing::repeat : Addressing::clamp;
    make_random_job(random, context_of(made.base_mesh(), made.map), job);
    choose_mesh_options(random, job);
    job.output.folder = "run";
    return made;
}

/// Changes the tests so that the mesh has somewhat fewer triangles.
void coarsen(Random& random, Job::Tests& tests) {
    if (!tests.generation) {
        tests.generation = true;
        return;
    }
    if (tests.generation_limit > 0 && random.chance(30)) {
        --tests.generation_limit;
        return;
    }
    tests.normal_threshold = std::min(2.0, 2 * tests.normal_threshold + 0.005);
    tests.highlight_normal_threshold = std::min(2.0, 2 * tests.highlight_normal_threshold + 0.005);
    for (const HeightTestHost* const host : height_test_hosts())
        for (const HeightThresholdKey& key : host->thresholds())
            tests.threshold(key.name) = std::min(key.range.high, 2 * tests.threshold(key.name) + key.value / 5);
    const bool area = tests.summed_height_unit == SummedHeightUnit::area;
    tests.threshold("summed_height_threshold") =
        std::min(area ? 2.0 : 4096.0, tests.threshold("summed_height_threshold"));
}

/// Changes the tests so that the mesh has somewhat more triangles.
void refine(Random& random, const Job::Formats& formats, Job::Tests& tests) {
    tests.normal_threshold /= 4;
    for (const HeightTestHost* const host : height_test_hosts())
        for (const HeightThresholdKey& key : host->thresholds())
            tests.threshold(key.name) /= 4;
    if (random.coin())
        tests.view_threshold /= 4;
    else
        tests.view = false;
    if (random.chance(30))
        tests.tex_coord = false;
    tests.generation_limit = std::min(tests.generation_limit + random.integer(0, 2),
                                      std::min<std::int64_t>(15, (std::int64_t{1} << formats.generation_bits) - 1));
}

std::uint64_t edges_of(const RandomCase& random_case) {
    const MachineSetup setup = random_case.setup();
    EmittedMesh mesh;
    return BareRecursion(setup).run(mesh, RandomCase::most_edges);
}

/// Adjusts the case with the bare datapath, which gives the number of edges that the mesh takes.
void settle(Random& random, RandomCase& random_case) {
    Job::Tests& tests = random_case.job.tests;
    constexpr int most_notches = 6;
    std::uint64_t edges = edges_of(random_case);
    if (random.chance(80))
        for (int notch = 0; notch < most_notches && edges < RandomCase::wanted_edges; ++notch) {
            refine(random, random_case.job.formats, tests);
            edges = edges_of(random_case);
        }
    while (edges >= RandomCase::most_edges) {
        if (tests.generation && tests.generation_limit == 0)
            throw InputError("the base mesh has more edges than a case may have");
        coarsen(random, tests);
        edges = edges_of(random_case);
    }
}

}  // namespace

std::string RandomCase::summary() const {
    return fmt::format("{}, map {} x {}, position {}.{}, normal {}.{}, texture {}+{}, screen {}.{}, {}{}", mesh.kind,
                       map.width, map.height, job.formats.position_bits, job.formats.position_fraction,
                       job.formats.normal_bits, job.formats.normal_fraction, job.formats.texture_integer,
                       job.formats.texture_fraction, job.formats.screen_bits, job.formats.screen_fraction,
                       job.hardware.tests_units == 3 ? "3 tests units" : "1 tests unit",
                       job.hardware.queue.order == TriangleOrder::lifo ? ", lifo" : ", fifo");
}

BaseMesh RandomCase::base_mesh() const {
    return parse_obj(mesh.obj, job.mesh.file.empty() ? "mesh.obj" : job.mesh.file);
}

MachineSetup RandomCase::setup() const {
    return make_setup(job, base_mesh(), height_map());
}

void RandomCase::write(const std::filesystem::path& folder, Mode mode) const {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw InputError(fmt::format("{}: {}", folder.string(), error.message()));
    Job written = job;
    written.mode = mode;
    write_file(folder / "job.toml", dump_job(written));
    write_file(folder / "mesh.obj", mesh.obj);
    write_file(folder / "map.pgm", map.pgm());
}

RandomCase make_random_case(std::uint64_t seed) {
    Random random(seed);
    for (int draws = 0; draws < most_draws; ++draws) {
        try {
            RandomCase made = draw(random);
            made.seed = seed;
            validate(made.job);
            settle(random, made);
            // Without a Generation Test a generation may not fit the fields of a spilled triangle, which is an error.
            if (!made.job.tests.generation)
                made.job.hardware.queue.capacity = 0;
            choose_evaluations(random, made.job);
            return made;
        } catch (const InputError&) {
            // Refused by the host, as it should be: draw again.
        }
    }
    throw std::logic_error(fmt::format("seed {}: the host refused {} draws in a row", seed, most_draws));
}

}  // namespace tessera

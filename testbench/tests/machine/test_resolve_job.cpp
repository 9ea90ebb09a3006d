#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/glm.hpp>

#include "testbench/check/conformance/golden_job.h"
#include "testbench/input/map/built_in_maps.h"
#include "testbench/input/map/map_range.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/input/mesh/obj_reader.h"
#include "testbench/job/job_keys.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/tests/support/refusals.h"

// The values that the program chooses for a job, against values derived by hand.

using namespace tessera;
using Catch::Contains;

namespace {

constexpr double pi = 3.14159265358979323846;

HeightMap map_of(float low, float high) {
    HeightMap map;
    map.width = 2;
    map.height = 1;
    map.values = {low, high};
    return map;
}

/// A box's eight corners as an OBJ file of twelve triangles.
BaseMesh box(double x, double y, double z, const glm::dvec3& low = glm::dvec3(0)) {
    std::string text;
    for (unsigned k = 0; k < 8; ++k)
        text += "v " + std::to_string(low.x + ((k & 1u) != 0 ? x : 0)) + " " +
                std::to_string(low.y + ((k & 2u) != 0 ? y : 0)) + " " +
                std::to_string(low.z + ((k & 4u) != 0 ? z : 0)) + "\n";
    return parse_obj(text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n", "box");
}

Job file_job() {
    Job job;
    job.mesh.source = MeshSource::file;
    return job;
}

glm::dvec3 vector(const std::array<double, 3>& a) {
    return {a[0], a[1], a[2]};
}

/// The largest fraction of half the picture that any of the points reaches, in width or height.
double filled_part(const Job::Camera& camera, const std::vector<glm::dvec3>& points) {
    const glm::dvec3 backward = glm::normalize(vector(camera.eye) - vector(camera.target));
    const glm::dvec3 right = glm::normalize(glm::cross(vector(camera.up), backward));
    const glm::dvec3 above = glm::cross(backward, right);
    const double tangent = std::tan(camera.field_of_view * pi / 360);
    const double aspect = static_cast<double>(camera.viewport_width) / static_cast<double>(camera.viewport_height);
    double part = 0;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 seen = point - vector(camera.eye);
        const double depth = -glm::dot(seen, backward);
        REQUIRE(depth > camera.near_plane);
        part = std::max({part, std::abs(glm::dot(seen, right)) / (depth * tangent * aspect),
                         std::abs(glm::dot(seen, above)) / (depth * tangent)});
    }
    return part;
}

std::vector<glm::dvec3> corners(const glm::dvec3& low, const glm::dvec3& high) {
    std::vector<glm::dvec3> result;
    for (unsigned k = 0; k < 8; ++k)
        result.emplace_back((k & 1u) != 0 ? high.x : low.x, (k & 2u) != 0 ? high.y : low.y,
                            (k & 4u) != 0 ? high.z : low.z);
    return result;
}

}  // namespace

TEST_CASE("the scale is an eighth of a flat mesh's largest extent, and a fortieth of any other mesh's") {
    const auto scale_of = [](const BaseMesh& mesh, const HeightMap& map, const Job& job) {
        return resolve_job(job, mesh, map).job.displacement.scale;
    };
    const HeightMap map = map_of(0, 1);
    CHECK(scale_of(make_plane(3, 3, 2, 2), map, Job{}) == 0.25);
    CHECK(scale_of(make_plane(3, 3, 12, 3), map, Job{}) == 1.5);
    CHECK(scale_of(box(4, 3, 0.2), map, file_job()) == 0.5);  // 0.2 is less than a tenth of 3: flat
    CHECK(scale_of(box(4, 3, 0.4), map, file_job()) == 0.1);
    CHECK(scale_of(box(40, 1, 0.4), map, file_job()) == 1);  // a rod is not flat
    CHECK(scale_of(make_sphere(8, 4, 500), map, Job{}) == 25);
    CHECK(scale_of(make_sphere(8, 4, 1e-3), map, Job{}) == 5e-5);
    // With a map in metres instead of 0..1 the heights are the same fraction of the mesh's size.
    CHECK(scale_of(make_plane(3, 3, 2, 2), map_of(0, 1000), Job{}) == 0.25 / 1000);
    CHECK(scale_of(make_plane(3, 3, 2, 2), map_of(-1, 1), Job{}) == 0.125);
    Job job;
    job.displacement.scale = -3;
    CHECK(scale_of(make_plane(3, 3, 2, 2), map, job) == -3);
}

TEST_CASE("up is z, but y for an OBJ file, and for a flat one its axis on the side of its normals") {
    const HeightMap map = map_of(0, 1);
    const auto up_of = [&](const BaseMesh& mesh, MeshSource source) {
        Job job;
        job.mesh.source = source;
        return resolve_job(job, mesh, map).job.camera.up;
    };
    using Up = std::array<double, 3>;
    CHECK(up_of(make_sphere(8, 4, 1), MeshSource::sphere) == Up{0, 0, 1});
    CHECK(up_of(box(1, 1, 1), MeshSource::file) == Up{0, 1, 0});
    CHECK(up_of(make_plane(3, 3, 2, 2), MeshSource::file) == Up{0, 0, 1});
    CHECK(up_of(parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n", "a"), MeshSource::file) == Up{0, 0, -1});
    CHECK(up_of(parse_obj("v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n", "a"), MeshSource::file) == Up{1, 0, 0});
    CHECK(up_of(parse_obj("v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n", "a"), MeshSource::file) == Up{0, 1, 0});
    BaseMesh of_a_run = make_plane(3, 3, 2, 2);
    CHECK(up_of(of_a_run, MeshSource::run) == Up{0, 0, 1});
    of_a_run.up = glm::dvec3(0, -4, 0);
    CHECK(up_of(of_a_run, MeshSource::run) == Up{0, -1, 0});
}

TEST_CASE("the camera looks at the displaced box from the right of the front, and the box fills nine tenths") {
    const double right = std::sin(20 * pi / 180) * std::cos(38 * pi / 180),
                 front = std::cos(20 * pi / 180) * std::cos(38 * pi / 180), above = std::sin(38 * pi / 180);
    SECTION("with z up, the front is -y") {
        Job job;
        job.displacement.bias = 0.5;
        const ResolvedJob resolved = resolve_job(job, make_plane(3, 3, 2, 2), map_of(0, 1));
        const Job::Camera& camera = resolved.job.camera;
        // z from 0.5 to 0.75
        CHECK(camera.target == std::array<double, 3>{0, 0, 0.625});
        const glm::dvec3 direction = glm::normalize(vector(camera.eye) - vector(camera.target));
        CHECK(glm::length(direction - glm::dvec3(right, -front, above)) < 1e-5);
        CHECK(filled_part(camera, corners({-1, -1, 0.5}, {1, 1, 0.75})) == Approx(0.9).epsilon(2e-5));
        CHECK(camera.near_plane ==
              Approx(glm::length(vector(camera.eye) - vector(camera.target)) / 1000).epsilon(1e-5));
        CHECK(resolved.found.size() == 5);
        CHECK(resolved.found[0].key == "displacement.scale");
        CHECK(resolved.found[0].value == "0.25");
        CHECK_THAT(resolved.found[0].rule, Contains("flat: an eighth of the base mesh's largest extent, 2"));
    }
    SECTION("with y up, the front is z") {
        Job job = file_job();
        job.displacement.scale = 0;
        job.camera.viewport_width = 300;
        job.camera.viewport_height = 900;
        job.camera.field_of_view = 70;
        const Job::Camera camera = resolve_job(job, box(2, 4, 6, {100, 200, 300}), map_of(0, 1)).job.camera;
        CHECK(camera.target == std::array<double, 3>{101, 202, 303});
        const glm::dvec3 direction = glm::normalize(vector(camera.eye) - vector(camera.target));
        CHECK(glm::length(direction - glm::dvec3(right, above, front)) < 1e-5);
        CHECK(filled_part(camera, corners({100, 200, 300}, {102, 204, 306})) == Approx(0.9).epsilon(2e-5));
    }
    SECTION("for any size of the model") {
        for (const double size : {1e-5, 1e-3, 1.0, 1e5, 1e9}) {
            const Job::Camera camera = resolve_job(Job{}, make_sphere(8, 4, size), map_of(0, 0)).job.camera;
            CHECK(filled_part(camera, corners(glm::dvec3(-size), glm::dvec3(size))) == Approx(0.9).epsilon(2e-5));
        }
    }
}

TEST_CASE("camera keys that are set are kept, and the others are derived from them") {
    const BaseMesh plane = make_plane(3, 3, 2, 2);
    const HeightMap map = map_of(0, 1);
    Job job;
    job.displacement.scale = 0.5;
    job.camera.eye = {0, 0, 5.25};
    const Job::Camera above = resolve_job(job, plane, map).job.camera;
    CHECK(above.eye == job.camera.eye);
    CHECK(above.target == std::array<double, 3>{0, 0, 0.25});
    CHECK(above.up == std::array<double, 3>{0, 1, 0});  // z points towards the viewer
    CHECK(above.near_plane == 0.005);

    job.camera = {};
    job.camera.target = {0.5, 0, 0};
    const Job::Camera aside = resolve_job(job, plane, map).job.camera;
    CHECK(aside.target == job.camera.target);
    CHECK(filled_part(aside, corners({-1, -1, 0}, {1, 1, 0.5})) == Approx(0.9).epsilon(2e-5));

    job.camera = {};
    job.camera.up = {0, 0, -3};
    CHECK(resolve_job(job, plane, map).job.camera.eye[2] < 0);

    const ResolvedJob resolved = resolve_job(job, plane, map);
    const ResolvedJob again = resolve_job(resolved.job, plane, map);
    CHECK(again.found.empty());
    CHECK(same_settings(again.job, resolved.job));
    CHECK(automatic_key(resolved.job).empty());
}

TEST_CASE("a model beyond the range of the camera keys is refused with a remedy") {
    const auto refusal = [](const BaseMesh& mesh) {
        return testing::input_error_of([&] { resolve_job(Job{}, mesh, map_of(0, 1)); });
    };
    CHECK_THAT(
        refusal(make_sphere(8, 4, 1e20)),
        Contains("out of range") &&
            Contains(
                "derived from a base mesh of 2e+20 model units; multiply each coordinate of the mesh's vertices by 1e-20"));
    CHECK_THAT(refusal(box(2, 2, 2, {0, -3e13, 5})),
               Contains("derived from a base mesh of 2 model units around (1, "
                        "-3e+13, 6); subtract (1, -3e+13, 6) from each vertex of the mesh"));
}

TEST_CASE("a displacement that is too large is refused with its cause, before a camera is derived from it") {
    const BaseMesh plane = make_plane(3, 3, 2, 2);
    const auto refusal = [&](Job job, HeightMap map) {
        span_values(map, job.map.range);
        return testing::input_error_of([&] { resolve_job(job, plane, map); });
    };
    const std::string far_range =
        "The map's values are -3.4e+38 to 1235, of which displacement.scale = 0.25 spans 35 to 1235";
    Job job;
    job.displacement.scale = 0.25;
    job.map.range = {MapRange::Kind::given, 35, 1235};
    CHECK_THAT(refusal(job, map_of(-3.4e38F, 1235)), Contains(far_range + ": set map.range = \"data\""));
    HeightMap voids = map_of(-3.4e38F, 1235);
    voids.no_data_hint = "set map.no_data = -3.4e+38";
    CHECK_THAT(refusal(job, voids), Contains(far_range + ". set map.no_data = -3.4e+38"));
    CHECK(refusal(job, map_of(35, 1235)).empty());
    for (const double high : {35.0000001, 35.000000001}) {
        job.map.range.high = high;
        CHECK_THAT(refusal(job, map_of(35, 1235)), Contains("set map.range = \"data\""));
    }
    INFO("scale, bias, and the first frame's scale");
    job = {};
    job.map.range.kind = MapRange::Kind::data;
    job.displacement.scale = 1e12;
    CHECK_THAT(refusal(job, map_of(35, 1235)),
               Contains("0 to 1e+12 model units") && Contains("divide displacement.scale by 8388608"));
    job.displacement.scale = 0.25;
    CHECK(refusal(job, map_of(35, 3.4e38F)).empty());
    job.displacement.bias = 1e11;
    CHECK_THAT(refusal(job, map_of(35, 1235)), Contains("divide displacement.bias by 1048576"));
}

TEST_CASE("setup and golden model refuse a job that is not resolved as a program error") {
    const BaseMesh plane = make_plane(3, 3, 2, 2);
    const HeightMap map = half_donut_map(8, 8);
    Job job = resolve_job({}, plane, map).job;
    const MachineSetup setup = make_setup(job, plane, map);
    CHECK_NOTHROW(GoldenJob(job, plane, map, setup.model_scale));
    job.camera.up = automatic_vector;
    CHECK_THROWS_WITH(make_setup(job, plane, map),
                      "make_setup: camera.up is \"auto\"; call "
                      "resolve_job() on the job first");
    CHECK_THROWS_WITH(GoldenJob(job, plane, map, setup.model_scale),
                      "GoldenJob: camera.up is \"auto\"; call resolve_job() on the job first");
    CHECK_NOTHROW(make_setup(resolve_job(job, plane, map).job, plane, map));
}

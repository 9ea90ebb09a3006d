#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numeric>

#include "testbench/common/atomic_file.h"
#include "testbench/common/error.h"
#include "testbench/input/map/built_in_maps.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/input/mesh/run_mesh.h"
#include "testbench/job/dump_job.h"
#include "testbench/machine/host_traffic.h"
#include "testbench/output/report/ply_writer.h"
#include "testbench/tests/support/test_folder.h"

using namespace tessera;
using Catch::Contains;

namespace {

using Corner = EmittedTriangle::Corner;

constexpr std::int32_t one = 65536, unit = 16384, texel = 4096;

/// At (x, y, 0) in world units, with t = (x, y) / 4 of the map.
Corner corner(int x, int y, std::int32_t base_x = 0) {
    Corner c;
    c.position = {base_x, 0, 0};
    c.displaced = {x * one, y * one, 0};
    c.displaced_normal = {0, 0, unit};
    c.texture = {static_cast<std::uint32_t>(x * 2 * texel), static_cast<std::uint32_t>(y * 2 * texel)};
    return c;
}

EmittedTriangle triangle(const Corner& a, const Corner& b, const Corner& c) {
    EmittedTriangle t;
    t.corners = {a, b, c};
    return t;
}

/// Replaces automatic values by the values that a run would choose.
Job without_automatic(Job job) {
    job.displacement.scale = 0.25;
    job.camera.eye = {1.05, -2.9, 2.45};
    job.camera.target = {0, 0, 0.05};
    if (is_automatic(job.camera.up))
        job.camera.up = {0, 0, 1};
    job.camera.near_plane = 0.01;
    return job;
}

BaseMesh read_back(const std::vector<EmittedTriangle>& triangles, const Job& job = {}, std::uint32_t map_size = 8) {
    const TestFolder run;
    EmittedMesh mesh;
    mesh.triangles = triangles;
    MeshUnits units;
    units.map.width = units.map.height = map_size;
    write_ply(run.path() / "mesh.ply", mesh, units);
    write_file(run.path() / "job.toml", dump_job(without_automatic(job), run.path()));
    return read_run_mesh(run.path());
}

bool repaired(const BaseMesh& mesh, const std::string& words) {
    for (const std::string& repair : mesh.repairs)
        if (repair.find(words) != std::string::npos)
            return true;
    return false;
}

/// The default job's set-up with this displacement scale.
MachineSetup setup_of(double scale) {
    Job job = without_automatic({});
    job.displacement.scale = scale;
    return make_setup(job, make_plane(3, 3, 2, 2), half_donut_map(64, 64));
}

}  // namespace

TEST_CASE("a run's mesh as a base mesh has displaced vertices, shared and complete") {
    const BaseMesh mesh = read_back(
        {triangle(corner(0, 0), corner(4, 0), corner(4, 4)), triangle(corner(0, 0), corner(4, 4), corner(0, 4))});
    REQUIRE(mesh.vertices.size() == 4);
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.repairs.empty());
    CHECK(mesh.dropped_degenerate == 0);
    const BaseVertex& far = mesh.vertices[mesh.triangles[0][2]];
    CHECK(far.position == glm::dvec3(4, 4, 0));
    CHECK(far.normal == glm::dvec3(0, 0, 1));
    CHECK(far.tangent == glm::dvec3(1, 0, 0));
    CHECK(far.handedness == 1);
    CHECK(far.texture == glm::dvec2(1, 1));
    CHECK(mesh.texture_scale.mean_u == 4);
}

TEST_CASE("texture coordinates keep every bit for any map size") {
    // as a float, 2999 + 1/4096 of 3000 texels is a third of a step off: sides of a seam would round differently
    Corner fine = corner(4, 4);
    fine.texture = {2999 * texel + 1, 1001 * texel + 4095};
    const BaseMesh mesh = read_back({triangle(corner(0, 0), corner(4, 0), fine)}, {}, 3000);
    const glm::dvec2 steps = mesh.vertices[2].texture * (3000.0 * texel);
    CHECK(std::abs(steps.x - fine.texture.u) < 1e-6);
    CHECK(std::abs(steps.y - fine.texture.v) < 1e-6);
}

TEST_CASE("vertices of a run that differ in base position only are merged, and collapsed triangles are dropped") {
    // Corner (4, 0) came from two places; the triangle between them has no edge left that a neighbour needs.
    const BaseMesh mesh = read_back({triangle(corner(0, 0), corner(4, 0), corner(4, 4)),
                                     triangle(corner(4, 0), corner(4, 0, 7), corner(4, 4)),
                                     triangle(corner(4, 0, 7), corner(8, 0), corner(4, 4))});
    CHECK(mesh.vertices.size() == 4);
    CHECK(mesh.triangles.size() == 2);
    CHECK(mesh.dropped_degenerate == 1);
    CHECK(repaired(mesh, "1 triangle(s) of the run"));
}

TEST_CASE("a triangle without area that closes a T-vertex is kept") {
    // (2, 2) lies on the edge from (0, 2) to (4, 2): unsplit on one side, split on the other, with the flat triangle
    // between.
    const BaseMesh mesh = read_back(
        {triangle(corner(0, 2), corner(4, 2), corner(4, 4)), triangle(corner(4, 2), corner(0, 2), corner(2, 2)),
         triangle(corner(2, 2), corner(0, 2), corner(2, 0)), triangle(corner(4, 2), corner(2, 2), corner(2, 0))});
    CHECK(mesh.triangles.size() == 4);
    CHECK(mesh.dropped_degenerate == 0);
    for (const BaseVertex& vertex : mesh.vertices)
        CHECK(vertex.tangent == glm::dvec3(1, 0, 0));
}

TEST_CASE("normals missing from the run and triangles it culled are reported") {
    Corner bare = corner(4, 4);
    bare.displaced_normal = {0, 0, 0};
    EmittedTriangle culled = triangle(corner(0, 0), corner(4, 4), corner(0, 4));
    culled.culled = true;
    Job job;
    job.hardware.culling = Culling::back;
    const BaseMesh mesh = read_back({triangle(corner(0, 0), corner(4, 0), bare), culled}, job);
    CHECK(mesh.triangles.size() == 1);
    CHECK(mesh.vertices[2].normal == glm::dvec3(0, 0, 1));
    CHECK(repaired(mesh, "1 vertices of the run have no normal"));
    CHECK(repaired(mesh, "culled"));
    CHECK_THROWS_WITH(read_back({culled}, job), Contains("no triangle is left"));
    CHECK_THROWS_WITH(read_back({triangle(corner(0, 0), corner(0, 0), corner(0, 0))}), Contains("no triangle is left"));
}

TEST_CASE("up is the run's camera.up if its mesh was a file or a run, else z") {
    const auto up_of = [](MeshSource source) {
        Job job;
        job.mesh.source = source;
        job.mesh.file = reads_file(source) ? "not looked at" : "";
        job.camera.up = {0, 2, 1};
        return read_back({triangle(corner(0, 0), corner(4, 0), corner(4, 4))}, job).up;
    };
    CHECK(up_of(MeshSource::file) == glm::dvec3(0, 2, 1));
    CHECK(up_of(MeshSource::run) == glm::dvec3(0, 2, 1));
    CHECK(up_of(MeshSource::cylinder) == glm::dvec3(0, 0, 1));
}

namespace {

/// Of how many register words the values differ.
long words_changed(const MachineSetup& before, const MachineSetup& now) {
    const std::vector<std::uint32_t> old_words = register_words(before.registers),
                                     words = register_words(now.registers);
    REQUIRE(old_words.size() == words.size());
    return std::inner_product(words.begin(), words.end(), old_words.begin(), 0L, std::plus<>(), std::not_equal_to<>());
}

}  // namespace

TEST_CASE("another scale changes the normal map and S, and no other table or register") {
    const MachineSetup low = setup_of(0.2), high = setup_of(0.25);
    REQUIRE(low.model_scale.scale == high.model_scale.scale);
    CHECK(low.map.codes == high.map.codes);
    CHECK(low.heights() == high.heights());
    CHECK(low.registers.formats.summed_height.bits == high.registers.formats.summed_height.bits);
    CHECK(words_changed(low, high) == 1);
    CHECK(words_changed(low, setup_of(5)) > 1);  // another scale of the model: Transform's matrix, too
}

TEST_CASE("the host sends base mesh, tables and registers") {
    const MachineSetup setup = setup_of(0.2);
    const HostTraffic sent = host_traffic(setup);
    CHECK(sent.base_mesh == base_mesh_bytes(setup));
    CHECK(sent.displacement_map == 64 * 64 * 2);
    CHECK(sent.normal_map == 64 * 64 * 6);
    CHECK(sent.summed_height_table == 65 * 65 * 4);
    // choices 1, map 2, tables 3 x 2, tests 5, S and bias, rows 3 x (3 + 2), shifts 2, near plane 2, normals 9, light 4
    CHECK(sent.registers == 4 * 48);
}

TEST_CASE("another scale: a Rank Table has other radii, and the same ranks and bounds") {
    const auto table_changes = [](RankView view) {
        Job job = without_automatic({});
        job.hardware.height_test = HeightTest::rank;
        job.formats.bound_bits = 8;
        job.tests.rank_view = view;
        const auto setup_of_scale = [&](double scale) {
            job.displacement.scale = scale;
            return make_setup(job, make_plane(2, 2, 2, 2), half_donut_map(64, 64));
        };
        return setup_of_scale(0.2).rank_tables.radius != setup_of_scale(0.25).rank_tables.radius;
    };
    CHECK_FALSE(table_changes(RankView::none));
    CHECK(table_changes(RankView::per_point));
}

TEST_CASE("the binary point of w and the Highlight Test's values are registers") {
    const MachineSetup before = setup_of(0.2);
    MachineSetup now = before;
    --now.registers.formats.view_distance.fraction;
    CHECK(words_changed(before, now) == 1);
    now = before;
    now.registers.formats.highlight_tag = true;
    // H 3, cosine 1, threshold 1; its enable bit is in the same register as the others
    CHECK(register_words(now.registers).size() == 48 + 5);
    now.registers.formats.normal = datapath::Format::make_signed(18, 16);
    CHECK(register_words(now.registers).size() == 48 + 6);  // the cosine has 34 bits
}

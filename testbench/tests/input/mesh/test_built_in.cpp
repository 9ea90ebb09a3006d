#include <catch2/catch.hpp>
#include <limits>
#include <set>

#include "testbench/common/error.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/input/mesh/make_base_mesh.h"
#include "testbench/tests/input/mesh/mesh_checks.h"
#include "testbench/tests/support/test_folder.h"

using namespace tessera;
using Catch::Contains;

namespace {

bool same_bits(const glm::dvec3& a, const glm::dvec3& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// The number of triangles of a mesh around the z axis that do not face away from the axis or the origin.
std::size_t inward(const BaseMesh& mesh, bool from_axis) {
    std::size_t count = 0;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[t[0]].position, b = mesh.vertices[t[1]].position,
                         c = mesh.vertices[t[2]].position;
        glm::dvec3 out = (a + b + c) / 3.0;
        out.z = from_axis ? 0 : out.z;
        count += !(glm::dot(triangle_normal(a, b, c), out) > 0);
    }
    return count;
}

}  // namespace

TEST_CASE("a plane is flat, centred, and faces up") {
    const BaseMesh mesh = make_plane(4, 3, 8, 3);
    require_complete(mesh);
    CHECK(mesh.vertices.size() == 20);
    CHECK(mesh.triangles.size() == 24);
    CHECK(mesh.repairs.empty());
    CHECK(mesh.vertices.front().position == glm::dvec3(-4, -1.5, 0));
    CHECK(mesh.vertices.back().position == glm::dvec3(4, 1.5, 0));
    CHECK(mesh.vertices.back().texture == glm::dvec2(1, 1));
    for (const BaseVertex& v : mesh.vertices) {
        CHECK(v.normal == glm::dvec3(0, 0, 1));
        CHECK(v.tangent == glm::dvec3(1, 0, 0));
        CHECK(v.handedness == 1);
    }
    CHECK(mesh.texture_scale.mean_u == Approx(8));
    CHECK(mesh.texture_scale.mean_v == Approx(3));
    const EdgeCounts edges = count_edges(mesh);
    CHECK(edges.border == 14);
    CHECK(edges.odd == 0);
}

TEST_CASE("a cylinder closes at its seam, bit for bit, and faces outward") {
    const auto columns = GENERATE(3, 7, 30, 64);
    const BaseMesh mesh = make_cylinder(columns, 5, 2, 3);
    require_complete(mesh);
    CHECK(mesh.triangles.size() == static_cast<std::size_t>(columns) * 10);
    CHECK(mesh.repairs.empty());
    CHECK(inward(mesh, true) == 0);
    const auto line = static_cast<std::size_t>(columns) + 1;
    for (std::size_t j = 0; j <= 5; ++j) {
        const BaseVertex& left = mesh.vertices[j * line];
        const BaseVertex& right = mesh.vertices[j * line + line - 1];
        CHECK(left.texture.x == 0);
        CHECK(right.texture.x == 1);
        CHECK(same_bits(left.position, right.position));
        CHECK(same_bits(left.normal, right.normal));
        CHECK(same_bits(left.tangent, right.tangent));
        CHECK(left.handedness == right.handedness);
    }
    const EdgeCounts edges = count_edges(mesh);
    CHECK(edges.border == static_cast<std::size_t>(columns) * 2);
    CHECK(edges.odd == 0);
    CHECK(mesh.texture_scale.mean_v == Approx(3));
    CHECK(mesh.texture_scale.mean_u == Approx(2.0 * columns * 2 * std::sin(3.14159265358979 / columns)));
    for (const BaseVertex& v : mesh.vertices) {
        CHECK(v.handedness == 1);
        CHECK(v.tangent.z == Approx(0).margin(1e-14));
    }
}

TEST_CASE("a cylinder's middle column faces -y") {
    const BaseMesh mesh = make_cylinder(4, 1, 1, 2);
    CHECK(mesh.vertices[2].normal.y == Approx(-1));
    CHECK(mesh.vertices[2].tangent.x == Approx(1));
}

TEST_CASE("a sphere is closed, faces outward and has no flat triangle") {
    const auto columns = GENERATE(3, 8, 33);
    const auto rows = GENERATE(2, 3, 16);
    const BaseMesh mesh = make_sphere(columns, rows, 0.5);
    require_complete(mesh);
    CHECK(mesh.triangles.size() == static_cast<std::size_t>(2 * columns * (rows - 1)));
    CHECK(inward(mesh, false) == 0);
    const EdgeCounts edges = count_edges(mesh);
    CHECK(edges.border == 0);
    CHECK(edges.odd == 0);
    CHECK(edges.shared == mesh.triangles.size() * 3 / 2);
    const auto line = static_cast<std::size_t>(columns) + 1;
    for (std::size_t j = 0; j + 1 < static_cast<std::size_t>(rows); ++j) {
        const BaseVertex& left = mesh.vertices[j * line];
        const BaseVertex& right = mesh.vertices[j * line + line - 1];
        CHECK(same_bits(left.position, right.position));
        CHECK(same_bits(left.normal, right.normal));
        CHECK(same_bits(left.tangent, right.tangent));
    }
    for (const BaseVertex& v : mesh.vertices) {
        CHECK(safe_length(v.position) == Approx(0.5));
        CHECK(v.handedness == 1);
    }
    CHECK(mesh.repairs.empty());
}

TEST_CASE("built-in meshes refuse invalid parameters and name the key") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH(make_plane(0, 3, 2, 2), Contains("mesh.columns = 0: must be 1 to 4096 for this mesh"));
    CHECK_NOTHROW(make_plane(1, 4096, 2, 2));
    CHECK_THROWS_WITH(make_plane(3, 4097, 2, 2), Contains("mesh.rows = 4097"));
    CHECK_THROWS_WITH(make_plane(3, 3, nan, 2), Contains("mesh.width = nan: must be a length above 0, "));
    CHECK_NOTHROW(make_plane(3, 3, 1e-30, 1e30));
    CHECK_THROWS_WITH(make_plane(3, 3, 2, -1), Contains("mesh.depth = -1"));
    CHECK_THROWS_WITH(make_cylinder(2, 3, 1, 2), Contains("mesh.columns = 2") && Contains("3 to 4096"));
    CHECK_THROWS_WITH(make_cylinder(3, 3, 0, 2), Contains("mesh.radius = 0"));
    CHECK_THROWS_WITH(make_cylinder(3, 3, 1, infinity), Contains("mesh.height = inf"));
    CHECK_THROWS_WITH(make_sphere(3, 1, 1), Contains("mesh.rows = 1"));
    CHECK_THROWS_AS(make_sphere(INT64_MAX, INT64_MAX, 1), InputError);
    CHECK_THROWS_AS(make_plane(4096, 4096, 2, 2), ResourceError);
    CHECK_THROWS_WITH(make_plane(4096, 489, 2, 2), Contains("4005888") && Contains("4000000"));
}

TEST_CASE("a plane of the greatest size is made") {
    CHECK(make_plane(4096, 488, 1e30, 1e-30).triangles.size() == 3997696);
}

TEST_CASE("the mesh source of the job is dispatched") {
    Job::Mesh job;
    CHECK(make_base_mesh(job, "").triangles.size() == 18);
    job.source = MeshSource::cylinder;
    CHECK(make_base_mesh(job, "").triangles.size() == 2048);
    job.source = MeshSource::sphere;
    CHECK(make_base_mesh(job, "").triangles.size() == 1984);
    job.columns = 3;
    job.rows = 2;
    CHECK(make_base_mesh(job, "").triangles.size() == 6);
    job.source = MeshSource::file;
    CHECK_THROWS_WITH(make_base_mesh(job, ""), Contains("mesh.source = \"file\" it must name an OBJ file"));
    const TestFolder here;
    here.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(make_base_mesh(job, (here.path() / "a.obj").string()).triangles.size() == 1);
    CHECK_THROWS_WITH(make_base_mesh(job, "nowhere/at_all.obj"), Contains("nowhere/at_all.obj: no such file"));
    CHECK_THROWS_WITH(make_base_mesh(job, "."), Contains("not a regular file"));
    job.source = static_cast<MeshSource>(99);
    CHECK_THROWS_WITH(make_base_mesh(job, ""), "mesh.source is not one of plane, cylinder, sphere, file, run");
}

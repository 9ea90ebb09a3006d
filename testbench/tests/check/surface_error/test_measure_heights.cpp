#include <catch2/catch.hpp>

#include "testbench/input/mesh/built_in.h"
#include "testbench/tests/check/surface_error/measure_cases.h"

using namespace tessera;

namespace {

DisplacementOf scaled(double scale, double bias = 0, Addressing mode = Addressing::clamp) {
    return {scale, bias, mode, mode};
}

VerticalError vertical(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                       const RecordedMesh& mesh) {
    std::string why;
    const auto field = find_height_field(base, map, displacement, why);
    INFO(why);
    REQUIRE(field);
    return measure_vertical_error(*field, base, map, displacement, mesh);
}

}  // namespace

TEST_CASE("the vertical error of the undisplaced base is the map itself") {
    const BaseMesh base = make_plane(3, 2, 4, 6);
    HeightMap map = make_map(5, 7, [](int x, int y) { return x == 3 && y == 2 ? 1 : 0.25; });
    map.source_units = 200;
    const VerticalError error = vertical(base, map, scaled(2), emitted(base));
    CHECK(error.grid_points == 35);
    CHECK(error.covered == 35);
    CHECK(error.max == Approx(2));
    CHECK(error.rms == Approx(2 * std::sqrt((34 * 0.0625 + 1) / 35)));
    CHECK(error.max / error.map_unit == Approx(200));
    CHECK(error.worst_texel == glm::dvec2(3.5, 2.5));
    CHECK(glm::length(error.worst_position - glm::dvec3(3.5 / 5 * 4 - 2, 2.5 / 7 * 6 - 3, 2)) < 1e-12);
}

TEST_CASE("a mesh through all texel centres has no vertical error, and a hole is not covered") {
    // Vertices at all texel centres, no triangles beyond them.
    const int size = 6;
    BaseMesh base = make_plane(1, 1, size, size);
    const HeightMap map = make_map(size, size, [](int x, int y) { return (x * 5 + y * 3) % 7; });
    const BaseMesh grid = make_plane(size - 1, size - 1, size - 1, size - 1);
    RecordedMesh mesh = emitted(grid, [&](const BaseVertex& v) {
        const int x = static_cast<int>(std::lround(v.position.x + (size - 1) / 2.0));
        const int y = static_cast<int>(std::lround(v.position.y + (size - 1) / 2.0));
        return v.position + glm::dvec3(0, 0, 1 + 0.5 * static_cast<double>(map.at(x, y)));
    });
    VerticalError error = vertical(base, map, scaled(0.5, 1), mesh);
    CHECK(error.covered == 36);
    CHECK(error.max < 1e-6);
    for (glm::dvec3& p : mesh.positions)
        p.z += 0.125;
    error = vertical(base, map, scaled(0.5, 1), mesh);
    CHECK(error.max == Approx(0.125).epsilon(1e-6));
    CHECK(error.rms == Approx(0.125).epsilon(1e-6));
    // Without the two triangles at the first corner its grid point is not covered.
    mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
    error = vertical(base, map, scaled(0.5, 1), mesh);
    CHECK(error.grid_points == 36);
    CHECK(error.covered == 35);
    CHECK(vertical(base, map, scaled(0.5, 1), RecordedMesh{}).covered == 0);
    CHECK(vertical(base, map, scaled(0), mesh).map_unit == 0);
}

TEST_CASE("heights are measured over a plane in any position and over each copy of a repeating map") {
    const HeightMap map = make_map(4, 4, [](int x, int y) { return x + y; });
    BaseMesh base = make_plane(2, 2, 2, 2);
    const glm::dvec3 e0 = glm::normalize(glm::dvec3(1, 2, 2)), e1 = glm::normalize(glm::dvec3(2, 1, -2));
    const glm::dvec3 e2 = glm::cross(e0, e1);
    for (BaseVertex& v : base.vertices) {
        v.position = 100.0 + v.position.x * e0 + v.position.y * e1;
        v.normal = e2;
        v.texture = 2.0 * v.texture;
    }
    const VerticalError error = vertical(base, map, scaled(0.5, 0, Addressing::repeat), emitted(base));
    CHECK(error.grid_points == 64);
    CHECK(error.covered == 64);
    CHECK(error.max == Approx(3));
    double squares = 0;
    for (const float value : map.values)
        squares += 0.25 * static_cast<double>(value) * static_cast<double>(value) / 16;
    CHECK(error.rms == Approx(std::sqrt(squares)));
    // Turned over, with the texture mirrored, it is still a height field.
    for (BaseVertex& v : base.vertices) {
        v.normal = -v.normal;
        v.texture.x = 2 - v.texture.x;
    }
    CHECK(vertical(base, map, scaled(0.5, 0, Addressing::repeat), emitted(base)).max == Approx(3));
}

TEST_CASE("a repeating axis and a clamping axis are distinguished") {
    const HeightMap map = make_map(4, 4, [](int x, int y) { return x + 10 * y; });
    for (const bool along_u : {true, false}) {
        // Two copies along one axis: clamped there, it would read 3 instead of 0, 1 and 2 beyond the first.
        BaseMesh base = make_plane(2, 2, 2, 2);
        for (BaseVertex& v : base.vertices)
            (along_u ? v.texture.x : v.texture.y) *= 2;
        DisplacementOf displacement = scaled(1);
        (along_u ? displacement.address_u : displacement.address_v) = Addressing::repeat;
        const VerticalError error = vertical(base, map, displacement, emitted(base));
        CHECK(error.grid_points == 32);
        CHECK(error.max == Approx(33));
        // the sum of (x + 10 y)^2 for x, y = 0..3
        CHECK(error.rms == Approx(std::sqrt((4 * 14 + 20 * 36 + 400 * 14) / 16.0)));
    }
}

TEST_CASE("a surface that is not a height field is reported with the reason") {
    const HeightMap map = make_map(4, 4, [](int, int) { return 0; });
    std::string why;
    CHECK_FALSE(find_height_field(make_cylinder(8, 1, 1, 1), map, scaled(1), why));
    CHECK(why == "the base mesh is not planar");
    BaseMesh tilted = make_plane(1, 1, 2, 2);
    tilted.vertices[0].normal = glm::normalize(glm::dvec3(0.1, 0, 1));
    CHECK_FALSE(find_height_field(tilted, map, scaled(1), why));
    CHECK(why == "the base mesh's normals are not perpendicular to its plane");
    BaseMesh bent = make_plane(2, 2, 2, 2);
    bent.vertices[4].texture.x += 0.1;
    CHECK_FALSE(find_height_field(bent, map, scaled(1), why));
    CHECK(why == "texture coordinates are not an affine function of position");
    BaseMesh line = make_plane(1, 1, 2, 2);
    for (BaseVertex& v : line.vertices)
        v.texture.y = 0;
    CHECK_FALSE(find_height_field(line, map, scaled(1), why));
    CHECK(find_height_field(make_plane(3, 3, 1e-30, 1e-30), map, scaled(1), why));
    CHECK(find_height_field(make_plane(3, 3, 1e30, 1e30), map, scaled(1), why));
    CHECK(why.empty());
}

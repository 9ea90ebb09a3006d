#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "testbench/input/mesh/built_in.h"
#include "testbench/tests/compare/measure_cases.h"

using namespace tessera;

namespace {

DisplacementOf scaled(double scale, double bias = 0, Addressing mode = Addressing::clamp) {
    return {scale, bias, mode, mode};
}

VerticalError vertical(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                       const RecordedMesh& mesh, const ErrorView* view = nullptr) {
    std::string why;
    const auto field = find_height_field(base, map, displacement, why);
    INFO(why);
    REQUIRE(field);
    return measure_vertical_error(*field, base, map, displacement, mesh, view);
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

TEST_CASE("grid points on a lattice's border count, wherever rounding has moved the border") {
    const int size = 33;
    const BaseMesh base = make_lattice({size, size}, {false, false}, 32, 2, 2);
    // to nothing, outwards, inwards, to one side; the last is a fifth of a texel
    for (const double grown : {1.0, 1 + 1e-7, 1 - 1e-7, 0.999, 1 - 0.2 / 16}) {
        for (const double shift : {0.0, 3e-5}) {
            const RecordedMesh mesh = emitted(base, [&](const BaseVertex& v) { return grown * v.position + shift; });
            for (const auto& [x, y] :
                 {std::pair{5, 0}, {0, 5}, {32, 7}, {9, 32}, {0, 0}, {32, 32}, {32, 0}, {16, 15}}) {
                INFO(grown << ' ' << shift << ' ' << x << ' ' << y);
                const HeightMap map =
                    make_map(size, size, [x = x, y = y](int u, int v) { return u == x && v == y ? 1 : 0; });
                const VerticalError error = vertical(base, map, scaled(0.25), mesh);
                CHECK(error.grid_points == 1089);
                CHECK(error.covered == 1089);
                CHECK(error.max == Approx(0.25).margin(4e-5));
                CHECK(error.rms == Approx(0.25 / 33).epsilon(1e-2));
                CHECK(error.worst_texel == glm::dvec2(x + 0.5, y + 0.5));
            }
        }
    }
}

TEST_CASE("a grid point beside the border counts with the mesh's nearest height, one in a hole does not count") {
    const BaseMesh base = make_lattice({5, 5}, {false, false}, 1, 5, 5);  // 4 x 4 quads of a texel
    const HeightMap map = make_map(5, 5, [](int, int) { return 0; });
    // Heights fall to the right; rounding has moved every vertex by 0.1 texels to the right.
    RecordedMesh mesh = emitted(
        base, [](const BaseVertex& v) { return glm::dvec3(v.position.x + 0.1, v.position.y, 10 - v.position.x); });
    // Column 0 is 0.1 texels beside the mesh: its heights are those of the first vertices, 12, not 12.1.
    VerticalError error = vertical(base, map, scaled(1), mesh);
    CHECK(error.covered == 25);
    CHECK(error.max == Approx(12));
    // Without its four triangles' quads the grid point in the middle is half a texel and more from the mesh.
    mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(),
                                        [&](const RecordedMesh::Triangle& t) {
                                            glm::dvec3 centre(0);
                                            for (const glm::dvec3& corner : mesh.corners(t))
                                                centre += corner / 3.0;
                                            return std::abs(centre.x - 0.1) < 1 && std::abs(centre.y) < 1;
                                        }),
                         mesh.triangles.end());
    REQUIRE(mesh.triangles.size() == 24);
    error = vertical(base, map, scaled(1), mesh);
    CHECK(error.grid_points == 25);
    CHECK(error.covered == 24);
}

// Heights of 0.4 over a flat mesh, seen along y from the side: the picture is 50 pixels high at a distance of 25.
TEST_CASE("errors in the picture are those of the grid points in it, in pixels") {
    const BaseMesh base = make_plane(1, 1, 2, 2);
    const HeightMap map = make_map(2, 2, [](int, int) { return 1; });  // grid points at (+-0.5, +-0.5)
    CameraSettings camera;
    camera.up = {0, 0, 1};
    camera.field_of_view = 90;
    camera.near_plane = 0.01;
    const auto seen_from = [&](double y, int width, int height) {
        camera.eye = {0, y, 0};
        camera.target = {0, y + 1, 0};
        camera.viewport_width = width;
        camera.viewport_height = height;
        const ErrorView view(camera);
        return vertical(base, map, scaled(0.4), emitted(base), &view);
    };
    const double near = 50 * 0.4 / 9.5, far = 50 * 0.4 / 10.5;
    VerticalError error = seen_from(-10, 200, 100);
    CHECK(error.seen == 4);
    CHECK(error.max_pixels == Approx(near));
    CHECK(error.rms_pixels == Approx(std::sqrt((near * near + far * far) / 2)));
    CHECK(error.max == Approx(0.4));
    // The nearer two are 50 * 0.5 / 9.5 = 2.63 pixels beside the centre, the others 2.38.
    error = seen_from(-10, 5, 100);
    CHECK(error.seen == 2);
    CHECK(error.max_pixels == Approx(far));
    CHECK(error.rms_pixels == Approx(far));
    CHECK(error.max == Approx(0.4));  // wherever it is
    // The nearer two are behind the camera.
    error = seen_from(0, 200, 100);
    CHECK(error.seen == 2);
    CHECK(error.max_pixels == Approx(50 * 0.4 / 0.5));
    error = seen_from(10, 200, 100);
    CHECK(error.seen == 0);
    CHECK(error.max_pixels == 0);
    CHECK(error.rms_pixels == 0);
}

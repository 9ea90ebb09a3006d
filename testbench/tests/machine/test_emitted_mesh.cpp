#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "testbench/tests/support/edited_mesh.h"

using namespace tessera;

namespace {

EmittedTriangle::Corner corner(std::uint32_t u, std::uint32_t v) {
    EmittedTriangle::Corner corner;
    corner.texture = {u, v};
    return corner;
}

/// A grid of `side` quads of two triangles each. The second triangle is above the first, with equal texture coordinates.
std::vector<EmittedTriangle> grid(std::uint32_t side) {
    std::vector<EmittedTriangle> triangles;
    for (std::uint32_t u = 0; u < side; ++u)
        for (std::uint32_t v = 0; v < side; ++v) {
            EmittedTriangle triangle;
            triangle.base = v % 3;
            triangle.split_by = static_cast<std::uint8_t>(u % 4);
            triangle.stopped_by = static_cast<std::uint8_t>(v % 5);
            triangle.culled = (u + v) % 7 == 0;
            triangle.corners = {corner(u, v), corner(u + 1, v), corner(u + 1, v + 1)};
            triangles.push_back(triangle);
            triangle.corners = {corner(u, v), corner(u + 1, v + 1), corner(u, v + 1)};
            triangles.push_back(triangle);
        }
    EmittedTriangle above = triangles.front();
    for (auto& corner : above.corners)
        corner.displaced.z = 5;
    triangles.insert(triangles.begin() + 1, above);
    return triangles;
}

}  // namespace

TEST_CASE("emitted triangles are returned as they came") {
    const std::vector<EmittedTriangle> triangles = grid(50);
    EmittedTriangles stored(triangles);
    CHECK((list_of({stored}) == triangles));
    CHECK(stored.corners().size() < 2 * triangles.size());
    stored.clear();
    CHECK(stored.empty());
    stored.push_back(triangles[7]);
    CHECK(stored[0] == triangles[7]);
}

TEST_CASE("emitted triangles of any order are sorted alike, and each corner is stored once") {
    std::vector<EmittedTriangle> triangles = grid(50);
    EmittedMesh mesh{triangles};
    mesh.sort();
    CHECK(mesh.triangles.corners().size() == 51 * 51 + 3);
    CHECK(mesh.triangles.corner_indices(0) == std::array<std::uint32_t, 3>{0, 1, 2});
    CHECK(mesh.triangles[1] == triangles[1]);
    std::shuffle(triangles.begin(), triangles.end(), std::mt19937(3));
    EmittedMesh shuffled{triangles};
    shuffled.sort();
    CHECK((list_of(shuffled) == list_of(mesh)));
    CHECK((shuffled.triangles.corners() == mesh.triangles.corners()));
}

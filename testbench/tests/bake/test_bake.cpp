#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "testbench/bake/bake.h"
#include "testbench/common/error.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/input/mesh/obj_reader.h"

using namespace tessera;
using Catch::Contains;

namespace {

Surface surface(const std::string& text) {
    return parse_surface(text, "s.toml");
}

QuadricSurface sphere(double radius, const glm::dvec3& centre = glm::dvec3(0)) {
    QuadricSurface result;
    result.quadric = make_quadric(QuadricShape::ellipsoid, centre, glm::dvec3(radius), 2, 0);
    result.where = "s.toml:1";
    return result;
}

double at(const BakedMap& map, int x, int y) {
    return map.values[static_cast<std::size_t>(y * map.width + x)];
}

Job::Map repeat_u() {
    Job::Map map;
    map.address_u = Addressing::repeat;
    return map;
}

}  // namespace

TEST_CASE("bake: heights are sampled at texel centres of the domain, from the bottom row up") {
    const BakedMap map = bake_heights(surface("[domain]\nx = [0, 4]\ny = [10, 12]\n[quadric]\nshape = \"general\"\n"
                                              "coefficients = [0, 0, 0, 0, 0, 0, 1, 100, -1, 0]\n"),
                                      4, 2);
    CHECK(map.values == std::vector<double>{1050.5, 1051.5, 1052.5, 1053.5, 1150.5, 1151.5, 1152.5, 1153.5});
    CHECK(map.absent + map.raised + map.uncovered + map.overlaps == 0);
}

TEST_CASE("bake: a symmetric surface gives a bit-exactly symmetric map") {
    const BakedMap map = bake_heights(
        surface("[domain]\nx = [-0.7, 0.7]\ny = [-0.3, 0.3]\n[quadric]\nshape = \"sphere\"\nradius = 0.9\n"), 37, 22);
    for (int y = 0; y < 22; ++y)
        for (int x = 0; x < 37; ++x) {
            REQUIRE(at(map, x, y) == at(map, 36 - x, y));
            REQUIRE(at(map, x, y) == at(map, x, 21 - y));
        }
}

TEST_CASE("bake: the map has its floor value where the quadric is absent or too low") {
    const std::string text = "[quadric]\nshape = \"sphere\"\nradius = 0.5\ncentre = [0, 0, 0.1]\n";
    const BakedMap open = bake_heights(surface(text), 64, 64);
    double lowest = 1;
    std::size_t inside = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double px = (x + 0.5) / 32 - 1, py = (y + 0.5) / 32 - 1, square = 0.25 - px * px - py * py;
            if (square < 0)
                continue;
            ++inside;
            CHECK(at(open, x, y) == Approx(0.1 + std::sqrt(square)).epsilon(1e-14));
            lowest = std::min(lowest, at(open, x, y));
        }
    CHECK(open.absent == 64 * 64 - inside);
    CHECK(open.raised == 0);
    CHECK(open.floor == lowest);
    CHECK(at(open, 0, 0) == lowest);

    const BakedMap floored = bake_heights(surface(text + "floor = 0.4\n"), 64, 64);
    CHECK(floored.floor == 0.4);
    CHECK(floored.absent == open.absent);
    std::size_t raised = 0;
    for (std::size_t k = 0; k < open.values.size(); ++k) {
        CHECK(floored.values[k] == std::max(0.4, open.values[k]));
        raised += open.values[k] < 0.4;
    }
    CHECK(floored.raised + floored.absent == raised);
}

TEST_CASE("bake: a quadric without a point over the domain is refused with its line") {
    CHECK_THROWS_WITH(
        bake_heights(surface("\n[quadric]\nshape = \"sphere\"\nradius = 0.1\ncentre = [5, 0, 0]\n"), 8, 8),
        Contains("s.toml:2: the quadric was not found: none of 8 x 8"));
    CHECK_THROWS_AS(bake_over_mesh(sphere(0.1, {9, 9, 9}), make_plane(1, 1, 2, 2), {}, 4, 4), InputError);
}

TEST_CASE("bake: over a plane, a quadric along the normals is its height") {
    const BaseMesh plane = make_plane(3, 5, 2, 2);
    const BakedMap over = bake_over_mesh(sphere(3, {0.2, 0.1, -1}), plane, {}, 50, 40);
    const BakedMap heights =
        bake_heights(surface("[quadric]\nshape = \"sphere\"\nradius = 3\ncentre = [0.2, 0.1, -1]\n"), 50, 40);
    CHECK(over.uncovered + over.overlaps + over.absent == 0);
    for (std::size_t k = 0; k < over.values.size(); ++k)
        REQUIRE(over.values[k] == Approx(heights.values[k]).epsilon(1e-13));
}

TEST_CASE("bake: over a cylinder, every texel displaces its point onto the sphere") {
    const int columns = 7, width = 96, height = 32;
    const double radius = 1.5;
    const glm::dvec3 centre(0.2, -0.1, 0.15);
    const BakedMap map =
        bake_over_mesh(sphere(radius, centre), make_cylinder(columns, 3, 1, 2), repeat_u(), width, height);
    CHECK(map.uncovered + map.overlaps + map.absent == 0);
    const double pi = std::acos(-1.0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            // Base point and normal on the chord between two columns, computed without the mesh.
            const double u = (x + 0.5) / width * columns, z = 2 * (y + 0.5) / height - 1;
            const double from = std::floor(u), part = u - from;
            const auto around = [&](double column) {
                const double angle = 2 * pi * column / columns;
                return glm::dvec3(-std::sin(angle), std::cos(angle), 0);
            };
            const glm::dvec3 p = (1 - part) * around(from) + part * around(from + 1) + glm::dvec3(0, 0, z);
            const glm::dvec3 n = glm::normalize(glm::dvec3(p.x, p.y, 0));
            REQUIRE(std::abs(glm::length(p + at(map, x, y) * n - centre) - radius) < 1e-13);
            REQUIRE(std::abs(at(map, x, y)) < 1);  // the nearer root; the other is across the cylinder
        }
}

TEST_CASE("bake: root chooses between the two sides of a quadric") {
    QuadricSurface ball = sphere(2, {0, 0, 0.5});
    const BaseMesh plane = make_plane(1, 1, 2, 2);
    const auto centre = [&](Root root) {
        ball.root = root;
        return at(bake_over_mesh(ball, plane, {}, 1, 1), 0, 0);
    };
    CHECK(centre(Root::highest) == Approx(2.5));
    CHECK(centre(Root::lowest) == Approx(-1.5));
    CHECK(centre(Root::nearest) == Approx(-1.5));
}

namespace {

/// One triangle over the lower left part; its plane is z = 0, and texture = position.
BaseMesh corner_triangle() {
    return parse_obj("v 0 0 0\nv 0.5 0 0\nv 0 0.5 0\nvt 0 0\nvt 0.5 0\nvt 0 0.5\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n",
                     "t.obj");
}

/// z = x + 10 y
QuadricSurface ramp_surface() {
    QuadricSurface ramp;
    ramp.quadric = {{0, 0, 0}, glm::dmat3(0), {1, 10, -1}, 0};
    return ramp;
}

}  // namespace

TEST_CASE("bake: texels beside a triangle continue the surface, others take the nearest texel's value") {
    constexpr int side = 16;
    const auto ramp = [](int x, int y) { return Approx((x + 0.5 + 10 * (y + 0.5)) / side); };
    const BakedMap map = bake_over_mesh(ramp_surface(), corner_triangle(), {}, side, side);
    CHECK(map.uncovered == side * side - 36);
    std::size_t continued = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            INFO(x << ' ' << y);
            // The nearest point is on the long edge or at one of its ends, 8 texels from the origin.
            const double px = x + 0.5, py = y + 0.5, along = std::clamp((px - py + 8) / 2, 0.0, 8.0);
            const bool covered = x + y + 1 <= 8, beside = !covered && std::hypot(px - along, py - 8 + along) < 4;
            continued += beside;
            if (covered || beside)
                CHECK(at(map, x, y) == ramp(x, y));
        }
    CHECK(map.continued == continued);
    CHECK(at(map, 15, 0) == at(map, 11, 0));
    CHECK(at(map, 0, 15) == at(map, 0, 11));
    const BakedMap repeated = bake_over_mesh(ramp_surface(), corner_triangle(), repeat_u(), side, side);
    CHECK(at(repeated, 15, 0) == ramp(-1, 0));
    CHECK(at(repeated, 12, 0) == ramp(-4, 0));
    CHECK(at(repeated, 11, 0) == ramp(11, 0));
    INFO("not where the surface is absent, nor where it does not go on: a sphere's other side, a given floor");
    BaseMesh edge = make_plane(1, 1, 1, 1);  // x and y to 0.5
    for (BaseVertex& v : edge.vertices)
        v.texture = v.texture * 0.5 + 0.25;
    CHECK(bake_over_mesh(sphere(0.5), edge, {}, 40, 40).continued == 0);
    // (z - 0.5 - x)(z + 1) = 0: from x = 0.5 on, the second is the nearer.
    QuadricSurface pair;
    pair.quadric = {{0, 0, 0}, {{0, 0, -0.5}, {0, 0, 0}, {-0.5, 0, 1}}, {-1, 0, 0.5}, -0.5};
    const BakedMap one = bake_over_mesh(pair, edge, {}, 40, 40);
    CHECK(at(one, 9, 20) == Approx(-0.025));
    CHECK(at(one, 30, 20) == at(one, 29, 20));
    QuadricSurface floored = ramp_surface();
    floored.floor = 0.5;
    const BakedMap raised = bake_over_mesh(floored, edge, {}, 40, 40);
    CHECK(*std::min_element(raised.values.begin(), raised.values.end()) == 0.5);
}

TEST_CASE("bake: between two parts of the map a texel continues the nearer") {
    const std::string text =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "vt 0.1 0\nvt 0.4 0\nvt 0.4 1\nvt 0.1 1\nvt 0.45 0\nvt 0.75 0\nvt 0.75 1\nvt 0.45 1\nvn 0 0 1\n";
    const std::string low = "f 1/1/1 2/2/1 3/3/1 4/4/1\n", high = "f 5/5/1 6/6/1 7/7/1 8/8/1\n";
    QuadricSurface level;
    level.quadric = {{0, 0, 0}, glm::dmat3(0), {0, 0, 1}, -5};
    for (const std::string& faces : {low + high, high + low}) {
        const BakedMap map = bake_over_mesh(level, parse_obj(text + faces, "t.obj"), {}, 40, 4);
        CHECK(at(map, 16, 1) == Approx(5));  // they end at 16 and begin at 18
        CHECK(at(map, 17, 1) == Approx(4));
    }
}

TEST_CASE("bake: at the border of a part of the map a sphere's slopes are right") {
    constexpr double radius = 2;
    constexpr int side = 80;
    BaseMesh mesh = make_plane(4, 4, 2, 2);  // -1 to 1
    for (BaseVertex& v : mesh.vertices)
        v.texture = v.texture * 0.8 + 0.1;
    const BakedMap map = bake_over_mesh(sphere(radius), mesh, {}, side, side);
    const double texel = 2 / (0.8 * side);
    for (int y = 8 - 3; y < side - 8 + 3; ++y)
        for (int x = 8 - 3; x < side - 8 + 3; ++x) {
            if (std::hypot(std::max({7 - x, x - 72, 0}), std::max({7 - y, y - 72, 0})) > 2.5)
                continue;
            const glm::dvec3 normal = glm::normalize(
                glm::dvec3(at(map, x - 1, y) - at(map, x + 1, y), at(map, x, y - 1) - at(map, x, y + 1), 2 * texel));
            const glm::dvec3 point((x + 0.5 - side / 2) * texel, (y + 0.5 - side / 2) * texel, at(map, x, y));
            REQUIRE(glm::distance(normal, point / radius) < 0.002);
        }
}

TEST_CASE(
    "bake: a mesh across the map's borders gives its values to the texels that the address mode selects, on either axis") {
    // A plane z = 0 whose texture coordinates are its positions, from -1/4 to 3/4 and from 5/4 to 9/4.
    const std::string text =
        "v -0.25 1.25 0\nv 0.75 1.25 0\nv 0.75 2.25 0\nv -0.25 2.25 0\n"
        "vt -0.25 1.25\nvt 0.75 1.25\nvt 0.75 2.25\nvt -0.25 2.25\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";
    const BaseMesh mesh = parse_obj(text, "t.obj");
    const auto [width, height] = GENERATE(table<int, int>({{4, 4}, {8, 4}, {4, 12}}));
    Job::Map both;
    both.address_u = both.address_v = Addressing::repeat;
    const BakedMap map = bake_over_mesh(ramp_surface(), mesh, both, width, height);
    CHECK(map.uncovered == 0);
    CHECK(map.overlaps == 0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            INFO(x << ' ' << y);
            const double u = (x + 0.5) / width, v = (y + 0.5) / height;
            CHECK(at(map, x, y) == Approx((u < 0.75 ? u : u - 1) + 10 * (v < 0.25 ? v + 2 : v + 1)));
        }
}

TEST_CASE("bake: values spread across the borders that repeat, on either axis") {
    for (const bool along_u : {true, false}) {
        Job::Map addressing;
        (along_u ? addressing.address_u : addressing.address_v) = Addressing::repeat;
        const BakedMap map = bake_over_mesh(ramp_surface(), corner_triangle(), addressing, 32, 32);
        // Texels 20 to 27 are neither beside 15, the last covered one, nor, if the axis repeats, beside 0.
        CHECK(at(map, 26, 0) == at(map, along_u ? 28 : 19, 0));
        CHECK(at(map, 0, 26) == at(map, 0, along_u ? 19 : 28));
    }
}

TEST_CASE("bake: of overlapping triangles the first is used, and the overlap is reported") {
    // Two sheets with the same texture coordinates, the second higher.
    const std::string sheets =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
        "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 5/1/1 6/2/1 7/3/1 8/4/1\n";
    const BakedMap map = bake_over_mesh(sphere(9), parse_obj(sheets, "t.obj"), {}, 5, 4);
    CHECK(map.overlaps >= 16);  // texels on the diagonals are on borders only
    CHECK(map.overlaps <= 20);
    for (const double value : map.values)
        CHECK(value > 8.8);  // from z = 0
    // A mesh that covers the repeated map twice has every texel in two triangles.
    BaseMesh twice = make_plane(2, 1, 4, 2);
    for (BaseVertex& v : twice.vertices)
        v.texture.x = 2 * v.texture.x - 1;
    CHECK(bake_over_mesh(sphere(9), twice, repeat_u(), 9, 4).overlaps > 30);
    CHECK(bake_over_mesh(sphere(9), make_plane(7, 3, 2, 2), {}, 33, 33).overlaps == 0);
}

TEST_CASE("bake: meshes that cannot be baked onto are refused") {
    BaseMesh pointlike = make_plane(1, 1, 2, 2);
    for (BaseVertex& v : pointlike.vertices)
        v.texture *= 0.1;
    CHECK_THROWS_WITH(bake_over_mesh(sphere(9), pointlike, {}, 2, 2), Contains("no texel's centre lies in a triangle"));
    for (BaseVertex& v : pointlike.vertices)
        v.texture = 10.0 * v.texture + glm::dvec2(3, 1);
    CHECK_THROWS_WITH(bake_over_mesh(sphere(9), pointlike, {}, 2, 2),
                      Contains("set map.address_u = \"repeat\" and map.address_v = \"repeat\" in the base mesh's job"));
    CHECK_THROWS_WITH(bake_over_mesh(sphere(9), pointlike, repeat_u(), 2, 2), Contains(": set map.address_v = "));
    BaseMesh endless = make_plane(1, 1, 2, 2);
    for (BaseVertex& v : endless.vertices)
        v.texture *= 1e6;
    CHECK_THROWS_AS(bake_over_mesh(sphere(9), endless, repeat_u(), 256, 256), ResourceError);
    CHECK(bake_over_mesh(sphere(9), endless, {}, 256, 256).uncovered == 0);  // set to the borders
}

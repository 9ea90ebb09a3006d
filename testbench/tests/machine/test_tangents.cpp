// Tangent frames and the size of a texel on unwrapped meshes: emitted normals against closed forms, golden's own frames
// against wrong ones of the host, the remarks on what cannot be right, openings by normals.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "testbench/check/mesh/invariants.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/input/mesh/obj_reader.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/setup/mesh/tangent_frames.h"
#include "testbench/setup/mesh/texture_gradient.h"
#include "testbench/setup/mesh/texture_scale.h"
#include "testbench/tests/check/conformance/setup_run.h"
#include "testbench/tests/support/bare_mesh.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/job_setup.h"
#include "testbench/tests/support/text.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

constexpr double pi = 3.14159265358979323846, degrees = 180 / pi;

/// A hill in the lower right of the map, of height 1, and its gradient.
double hill(const glm::dvec2& t) {
    const double d = glm::length(t - glm::dvec2(0.7, 0.3)) / 0.45;
    return d < 1 ? 0.5 + 0.5 * std::cos(pi * d) : 0;
}
glm::dvec2 hill_gradient(const glm::dvec2& t) {
    const glm::dvec2 away = t - glm::dvec2(0.7, 0.3);
    const double length = glm::length(away), d = length / 0.45;
    return d < 1 && length > 0 ? -0.5 * pi / 0.45 * std::sin(pi * d) / length * away : glm::dvec2(0);
}

HeightMap hill_map(int size = 256) {
    HeightMap map;
    map.width = map.height = size;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            map.values.push_back(static_cast<float>(hill({(x + 0.5) / size, (y + 0.5) / size})));
    map.range_high = map.span_high = 1;
    return map;
}

/// Texture coordinates of a quad: t = origin + x * along_x + y * along_y, x and y within the quad, 0 to 1.
struct Unwrap {
    glm::dvec2 origin, along_x, along_y;
};

Unwrap turned(double angle, double size = 1) {
    const glm::dvec2 x(std::cos(angle / degrees), std::sin(angle / degrees)), y(-x.y, x.x);
    return {glm::dvec2(0.5) - size * (x + y) / 2.0, size * x, size * y};
}
const Unwrap straight{{0, 0}, {1, 0}, {0, 1}}, mirrored_u{{1, 0}, {-1, 0}, {0, 1}}, mirrored_v{{0, 1}, {1, 0}, {0, -1}};

/// A plane of quads of side 1, each unwrapped by itself, turned in space. Points that agree are one vertex, as in a file.
struct Plane {
    std::size_t columns, rows;
    std::vector<Unwrap> unwraps;  // row by row from the bottom
    glm::dvec3 along_x{1, 0, 0}, along_y{0, 1, 0};

    BaseMesh mesh() const {
        BaseMesh mesh;
        std::map<std::array<double, 4>, std::uint32_t> known;
        for (std::size_t q = 0; q < unwraps.size(); ++q) {
            std::array<std::uint32_t, 4> corners{};
            for (std::size_t k = 0; k < 4; ++k) {
                const glm::dvec2 in(k == 1 || k == 2 ? 1 : 0, k >= 2 ? 1 : 0);
                const glm::dvec2 at = in + glm::dvec2(q % columns, q / columns);
                const Unwrap& unwrap = unwraps[q];
                const glm::dvec2 t = unwrap.origin + in.x * unwrap.along_x + in.y * unwrap.along_y;
                const auto [place, made] =
                    known.try_emplace({at.x, at.y, t.x, t.y}, static_cast<std::uint32_t>(mesh.vertices.size()));
                if (made) {
                    BaseVertex vertex;
                    vertex.position = at.x * along_x + at.y * along_y;
                    vertex.normal = unit_or_zero(glm::cross(along_x, along_y));
                    vertex.texture = t;
                    mesh.vertices.push_back(vertex);
                }
                corners[k] = place->second;
            }
            mesh.triangles.push_back({corners[0], corners[1], corners[2]});
            mesh.triangles.push_back({corners[0], corners[2], corners[3]});
        }
        complete_tangent_frames(mesh);
        measure_texture_scale(mesh);
        return mesh;
    }
};

Plane turned_in_space(Plane plane) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, 3));
    const double angle = 50 / degrees;
    for (glm::dvec3* v : {&plane.along_x, &plane.along_y})
        *v = *v * std::cos(angle) + glm::cross(axis, *v) * std::sin(angle) +
             axis * glm::dot(axis, *v) * (1 - std::cos(angle));
    return plane;
}

Job plane_job(const std::string& settings) {
    return with_settings({}, "mode=functional displacement.scale=0.25 tests.view=false " + settings);
}

MachineSetup setup_of(const BaseMesh& mesh, const HeightMap& map, const std::string& settings = {}) {
    return make_setup(resolve_job(plane_job(settings), mesh, map).job, mesh, map);
}

struct NormalErrors {
    std::vector<double> degrees;  // sorted
    double largest() const { return degrees.back(); }
    double median() const { return degrees[degrees.size() / 2]; }
};

/// The angles between emitted normals and the displaced plane's, not on the quads' sides, where it has creases.
NormalErrors normal_errors(const Plane& plane, const MachineSetup& setup, const EmittedMesh& mesh) {
    const datapath::Formats& formats = setup.registers.formats;
    const glm::dvec3 up = glm::cross(plane.along_x, plane.along_y);
    const double lift = setup.height_per_code * setup.map.highest_code() / setup.model_scale.scale;
    NormalErrors errors;
    for (const EmittedTriangle& triangle : mesh.triangles)
        for (const EmittedTriangle::Corner& corner : triangle.corners) {
            const auto& p = corner.position;
            const glm::dvec3 model =
                setup.model_scale.to_model(glm::dvec3(p.x, p.y, p.z) * std::ldexp(1.0, -formats.position.fraction));
            const std::size_t q = triangle.base / 2;
            const glm::dvec2 in = glm::dvec2(glm::dot(model, plane.along_x), glm::dot(model, plane.along_y)) -
                                  glm::dvec2(q % plane.columns, q / plane.columns);
            if (std::min({in.x, in.y, 1 - in.x, 1 - in.y}) < 0.01)
                continue;
            const Unwrap& unwrap = plane.unwraps[q];
            const glm::dvec2 t = unwrap.origin + in.x * unwrap.along_x + in.y * unwrap.along_y;
            const glm::dvec2 rise = lift * hill_gradient(t - glm::floor(t));
            const glm::dvec3 right =
                up - glm::dot(rise, unwrap.along_x) * plane.along_x - glm::dot(rise, unwrap.along_y) * plane.along_y;
            const auto& n = corner.displaced_normal;
            const glm::dvec3 emitted(n.x, n.y, n.z);
            errors.degrees.push_back(degrees *
                                     std::atan2(glm::length(glm::cross(right, emitted)), glm::dot(right, emitted)));
        }
    std::sort(errors.degrees.begin(), errors.degrees.end());
    return errors;
}

struct Row {
    std::string name;
    Plane plane;
    std::string settings = {};
    bool closed = false;  // also where islands meet
};

std::vector<Row> right_rows() {
    const Unwrap shifted{{0, 0}, {0.5, 0}, {0, 0.5}}, shifted_mirrored{{1, 0.5}, {-0.5, 0}, {0, 0.5}};
    std::vector<Row> rows{
        {"islands alike", {2, 1, {straight, straight}}},
        {"an island turned by 90 degrees", {2, 1, {straight, turned(90)}}},
        {"an island turned by 180 degrees", {2, 1, {straight, turned(180)}}},
        {"an island turned by 270 degrees", {2, 1, {straight, turned(270)}}},
        {"islands turned by 17 and 54 degrees", {2, 1, {turned(17, 0.7), turned(54, 0.7)}}},
        {"four islands that meet at a point", {2, 2, {turned(0), turned(90), turned(180), turned(270)}}},
        {"four islands that meet at a point, all at the same place of the map",
         {2, 2, {turned(180), turned(270), turned(90), turned(0)}}},
        {"an island mirrored in u, elsewhere in the map", {2, 1, {shifted, shifted_mirrored}}},
        {"an island mirrored in v, whole periods away",
         {2, 1, {straight, {{0, 3}, {1, 0}, {0, -1}}}},
         "map.address_u=repeat map.address_v=repeat"},
        {"tiles side by side that continue",
         {2, 1, {straight, {{1, 0}, {1, 0}, {0, 1}}}},
         "map.address_u=repeat",
         true},
        {"halves mirrored in u that share their edge", {2, 1, {straight, mirrored_u}}, "", true},
        {"halves mirrored in v that share their edge", {1, 2, {straight, mirrored_v}}, "", true},
        {"a strip mirrored over and over, with corners between the mirrored edges",
         {4,
          1,
          {{{0, 0}, {0.5, 0}, {0, 0.5}},
           {{0.5, 0}, {0.5, 0}, {0, 0.5}},
           {{1, 0}, {-0.5, 0}, {0, 0.5}},
           {{0.5, 0}, {-0.5, 0}, {0, 0.5}}}},
         "",
         true},
    };
    const std::size_t count = rows.size();
    for (std::size_t k = 0; k < count; ++k)
        rows.push_back(
            {rows[k].name + ", turned in space", turned_in_space(rows[k].plane), rows[k].settings, rows[k].closed});
    return rows;
}

const CaseTable right_normals("emitted normals are those of the displaced plane: ", right_rows(), [](const Row& row) {
    const MachineSetup setup = setup_of(row.plane.mesh(), hill_map(), row.settings);
    const EmittedMesh mesh = testing::bare_mesh(setup);
    const NormalErrors errors = normal_errors(row.plane, setup, mesh);
    REQUIRE(errors.degrees.size() > 300);
    CHECK(errors.median() < 1);
    CHECK(errors.largest() < 2);
    const InvariantResult invariants = check_invariants(mesh, setup);
    CHECK(invariants.passed());
    if (row.closed)
        CHECK(invariants.open_texture_seam_edges == 0);
    CHECK(invariants.open_crease_edges == 0);
    CHECK_THAT(testing::joined(setup.remarks), !Contains("texel size"));
    // golden's frames and texel size are the host's
    Plane plane = row.plane;
    SetupRun run(plane_job(row.settings + " tests.generation_limit=2"), plane.mesh(), hill_map(32));
    const SetupResult checked = run.check();
    INFO(checked.first_wrong);
    CHECK(checked.passed());
});

}  // namespace

TEST_CASE("vertices that share one frame although their texture differs are 46 degrees off: the measure notices") {
    const Plane plane{2, 1, {straight, turned(180)}};
    BaseMesh mesh = plane.mesh();
    for (BaseVertex& vertex : mesh.vertices)
        vertex.tangent = {1, 0, 0};
    const MachineSetup setup = setup_of(mesh, hill_map());
    CHECK(normal_errors(plane, setup, testing::bare_mesh(setup)).largest() > 40);
}

TEST_CASE("triangles with only mirrored edges are counted, and each remedy works") {
    const BaseMesh mesh = Plane{4, 1, {straight, mirrored_u, straight, mirrored_u}}.mesh();
    CHECK_THAT(testing::joined(mesh.repairs),
               Contains("At 6 point(s) the texture is mirrored") && Contains("4 triangle(s) have only such points"));
    for (const BaseVertex& vertex : mesh.vertices)
        CHECK((vertex.tangent == glm::dvec3(0)) == (vertex.position.x > 0 && vertex.position.x < 4));
    // a corner off the mirrored edges: the row "a strip mirrored over and over"
    const Plane cut{4,
                    1,
                    {{{0, 0}, {0.5, 0}, {0, 1}},
                     {{0.5, 0}, {0.5, 0}, {0, 1}},
                     {{1, 0}, {-0.5, 0}, {0, 1}},
                     {{0.5, 0}, {-0.5, 0}, {0, 1}}}};
    CHECK_THAT(testing::joined(cut.mesh().repairs),
               Contains("At 2 point(s) the texture is mirrored") && !Contains("only such"));
    // a place of its own
    const Plane apart{2, 1, {{{0, 0}, {0.5, 0}, {0, 1}}, {{0.95, 0}, {-0.5, 0}, {0, 1}}}};
    CHECK(testing::joined(apart.mesh().repairs).empty());
}

TEST_CASE("a small triangle turned over in the map follows the others around it") {
    // a fan of six triangles, one of which is thin and mirrored
    const std::string fan =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0.02 -1 0\nvt .5 .5\nvt 1 .5\nvt .5 1\nvt 0 .5\nvt .5 0\n"
        "vt .49 0\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 1/1 4/4 5/5\nf 1/1 5/5 6/6\nf 1/1 6/6 2/2\n";
    const BaseMesh mesh = parse_obj(fan, "fan");
    CHECK_THAT(testing::joined(mesh.repairs), Contains("a few small triangles are mirrored"));
    CHECK(mesh.vertices[0].handedness == 1);
    CHECK(mesh.vertices[0].tangent.x > 0.99);
}

TEST_CASE(
    "parts of the map that are joined only by a triangle without area in it are noted if they are turned against each other") {
    // two right-angled triangles and between them one of `gap` degrees, whose sides lie on one line of the map
    const auto fan = [](double gap) {
        std::string text = "v 0 0 0\n";
        for (const double angle : {90 + gap / 2, 90 - gap / 2, -gap / 2, 180 + gap / 2})
            text += fmt::format("v {} {} 0\n", std::cos(angle / degrees), std::sin(angle / degrees));
        return text +
               "vn 0 0 1\nvt .5 .3\nvt .5 .5\nvt .7 .3\nvt .3 .3\nf 1/1/1 3/2/1 2/2/1\nf 1/1/1 4/3/1 3/2/1\n"
               "f 1/1/1 2/2/1 5/4/1\n";
    };
    CHECK_THAT(testing::joined(parse_obj(fan(60), "fan").repairs),
               Contains("1 triangle(s) have no area") &&
                   Contains("At 1 point(s) triangles without area in texture space connect") &&
                   Contains("up to 30 degrees from their own"));
    CHECK_THAT(testing::joined(parse_obj(fan(10), "fan").repairs),
               Contains("1 triangle(s) have no area") && !Contains("connect"));
}

TEST_CASE("a coarse prism whose cap has no area in the map has one part around each point of its rim") {
    std::string text = "v 0 0 1\nvt .5 1\nvn 0 0 1\n", faces;
    for (int k = 0; k <= 6; ++k) {
        const double angle = k % 6 * pi / 3, x = std::cos(angle), y = std::sin(angle);
        text += fmt::format("v {0} {1} 0\nv {0} {1} 1\nvn {0} {1} 0\nvt {2} 0\nvt {2} 1\n", x, y, k / 6.0);
        if (k == 6)
            break;
        const int low = 2 * k + 2, high = low + 1, normal = k + 2, next = normal + 1;
        faces += fmt::format("f {0}/{0}/{4} {1}/{1}/{5} {2}/{2}/{5}\nf {0}/{0}/{4} {2}/{2}/{5} {3}/{3}/{4}\n", low,
                             low + 2, high + 2, high, normal, next);
        faces += fmt::format("f 1/1/1 {0}/{0}/{2} {1}/{1}/{3}\n", high, high + 2, normal, next);
    }
    CHECK_THAT(testing::joined(parse_obj(text + faces, "prism").repairs),
               Contains("6 triangle(s) have no area") && !Contains("connect"));
}

TEST_CASE("at a pole triangles with their own coordinates have their own tangents, with one there is none") {
    std::string own, one = "vt 0.5 1\n", ring;
    std::string own_faces, one_faces;
    for (int k = 0; k < 6; ++k) {
        ring += fmt::format("v {} {} -1\n", std::cos(k * pi / 3), std::sin(k * pi / 3));
        own += fmt::format("vt {} 0\nvt {} 1\n", k / 6.0, (k + 0.5) / 6);
        one += fmt::format("vt {} 0\n", k / 6.0);
        const int next = (k + 1) % 6;
        own_faces += fmt::format("f 1/{}/1 {}/{}/1 {}/{}/1\n", 2 * k + 2, k + 2, 2 * k + 1, next + 2,
                                 next == 0 ? 13 : 2 * next + 1);
        one_faces += fmt::format("f 1/1/1 {}/{}/1 {}/{}/1\n", k + 2, k + 2, next + 2, next == 0 ? 8 : next + 2);
    }
    const std::string points = "v 0 0 0\n" + ring + "vn 0 0 1\n";
    const BaseMesh apart = parse_obj(points + own + "vt 1 0\n" + own_faces, "own");
    CHECK(apart.repairs.size() == 1);
    CHECK_THAT(testing::joined(apart.repairs), Contains("not that of the triangles around them"));
    for (std::size_t k = 0; k < 6; ++k) {
        const double middle = (static_cast<double>(k) + 0.5) * pi / 3;
        const BaseVertex& pole = apart.vertices[apart.triangles[k][0]];
        CHECK(safe_length(pole.tangent - glm::dvec3(-std::sin(middle), std::cos(middle), 0)) < 1e-9);
    }
    const BaseMesh together = parse_obj(points + one + "vt 1 0\n" + one_faces, "one");
    CHECK_THAT(testing::joined(together.repairs), Contains("At 1 point(s) the directions of dp/du cancel"));
    CHECK(together.vertices[together.triangles[0][0]].tangent == glm::dvec3(0));
}

namespace {

struct Wrong {
    std::string name, noticed;
    std::function<void(BaseMesh&)> make;
};

const CaseTable wrong_frames(
    "the set-up check of a job with an atlas notices ",
    {Wrong{"a tangent that is too short", "tangent", [](BaseMesh& m) { m.vertices[0].tangent *= 0.999; }},
     {"a tangent turned by a tenth of a degree", "tangent",
      [](BaseMesh& m) {
          BaseVertex& v = m.vertices[3];
          v.tangent = glm::normalize(v.tangent + 0.002 * glm::cross(v.normal, v.tangent));
      }},
     {"a handedness turned over", "handedness", [](BaseMesh& m) { m.vertices[2].handedness *= -1; }},
     {"no tangent", "tangent", [](BaseMesh& m) { m.vertices[1].tangent = glm::dvec3(0); }},
     {"a tangent where there is none", "tangent",
      [](BaseMesh& m) {
          for (BaseVertex& v : m.vertices)
              if (v.tangent == glm::dvec3(0))
                  v.tangent = {1, 0, 0};
      }},
     {"frames shared by islands that are turned against each other", "tangent",
      [](BaseMesh& m) {
          for (BaseVertex& v : m.vertices)
              for (const BaseVertex& w : m.vertices)
                  if (v.position == w.position) {
                      v.tangent = w.tangent;
                      break;
                  }
      }},
     {"texels 1 % too large along u", "normal map", [](BaseMesh& m) { m.texture_scale.mean_u *= 1.01; }},
     {"texels 1 % too small along v", "normal map", [](BaseMesh& m) { m.texture_scale.mean_v *= 0.99; }}},
    [](const Wrong& wrong) {
        BaseMesh mesh = Plane{3, 1, {turned(90), straight, mirrored_u}}.mesh();
        wrong.make(mesh);
        SetupRun run(plane_job("tests.generation_limit=2"), mesh, hill_map(32));
        const SetupResult result = run.check();
        INFO(result.first_wrong);
        CHECK(result.wrong() > 0);
        CHECK_THAT(result.first_wrong, Contains(wrong.noticed));
    });

struct Spread {
    std::string name;
    Plane plane;
    bool matters;
    std::string settings = {};  // further ones
};

/// One quad of `part` of the map along u, and one of the rest.
Plane parts_along_u(double part) {
    return {2, 1, {{{0, 0}, {part, 0}, {0, 0.5}}, {{part, 0}, {1 - part, 0}, {0, 0.5}}}};
}

const CaseTable spreads(
    "one texel size: ",
    {Spread{"1/8 and 7/8 of the map", parts_along_u(0.125), true},
     {"3/10 and 7/10 of the map", parts_along_u(0.3), true},
     {"halves of the map", parts_along_u(0.5), false},
     {"along v", {1, 2, {{{0, 0}, {1, 0}, {0, 0.2}}, {{0, 0.2}, {1, 0}, {0, 0.8}}}}, true},
     {"an island of twice the density", {2, 1, {straight, turned(0, 0.5)}}, true},
     {"sheared by a half", {1, 1, {{{0.1, 0}, {0.6, 0}, {0.3, 0.6}}}}, true},
     {"1/8 and 7/8 of the map, hardly displaced", parts_along_u(0.125), false, "displacement.scale=0.002"}},
    [](const Spread& row) {
        const MachineSetup setup = setup_of(row.plane.mesh(), hill_map(), row.settings);
        const TexelSpread& spread = setup.texel_spread;
        INFO(testing::joined(setup.remarks)
             << spread.median_error << ' ' << spread.largest_error << ' ' << spread.wrong_percent);
        CHECK((testing::joined(setup.remarks).find("one texel size") != std::string::npos) == row.matters);
        CHECK((spread.wrong_percent > 1) == row.matters);
        const NormalErrors errors = normal_errors(row.plane, setup, testing::bare_mesh(setup));
        if (row.matters) {
            // The figure is of the surface; vertices are denser on slopes.
            CHECK(errors.largest() == Approx(spread.largest_error).margin(1.5));
            CHECK(errors.median() > 1);
        } else {
            CHECK(errors.largest() < 2);
        }
    });

TEST_CASE("one texel size: an island that is small on the surface and large in the map is said") {
    BaseMesh mesh = parts_along_u(0.5).mesh();
    const double shrunk = 1.0 / 16;  // the right half, to a 1/256 of its area
    for (BaseVertex& vertex : mesh.vertices)
        if (vertex.texture.x > 0.5)
            vertex.position = glm::dvec3(0) + vertex.position * shrunk;
    measure_texture_scale(mesh);
    const MachineSetup setup = setup_of(mesh, hill_map(), "");
    INFO(testing::joined(setup.remarks) << setup.texel_spread.wrong_percent << ' '
                                        << setup.texel_spread.wrong_map_percent);
    CHECK(setup.texel_spread.wrong_map_percent > 1);
    CHECK_THAT(testing::joined(setup.remarks), Contains("one texel size") && Contains("% of the map there"));
}

TEST_CASE("displacements beside the radius of curvature: their error in N' is said") {
    // r = R + h: the normal's slope is r' / R, and r' / r is right. Here r' = S / 2 pi, S = R = 1.
    const MachineSetup setup = testing::setup_of(testing::with_settings(
        {}, "mesh.source=cylinder mesh.columns=64 map.source=ramp map.address_u=repeat displacement.scale=1"));
    const auto slope = [](double radius) { return degrees * std::atan(1 / (2 * pi * radius)); };
    CHECK(setup.texel_spread.curved_largest == Approx(slope(1) - slope(2)).margin(0.1));
    CHECK(setup.texel_spread.curved_median == Approx(slope(1) - slope(1.5)).margin(0.1));
    CHECK_THAT(testing::joined(setup.remarks), Contains("radius of curvature"));
    for (const char* const small :
         {"mesh.source=cylinder displacement.scale=0.02", "mesh.source=plane displacement.scale=1"})
        CHECK_THAT(testing::joined(testing::setup_of(testing::with_settings({}, small)).remarks),
                   !Contains("radius of curvature"));
}

TEST_CASE("texture coordinates beyond the map by rounding are no fault") {
    const auto beyond = [](double by) {
        return setup_of(Plane{1, 1, {{{-by, 0}, {1 + 2 * by, 0}, {0, 1 + by}}}}.mesh(), hill_map());
    };
    for (const double by : {0.0, 1e-9, 1e-6, 2e-4}) {
        CHECK(beyond(by).texture_clamped == 0);
        CHECK_THAT(testing::joined(beyond(by).remarks), !Contains("outside 0..1"));
    }
    CHECK(beyond(1e-3).texture_clamped == 4);
}

TEST_CASE("a border that stretches the map across triangles is said, with their number") {
    const auto remarks = [](int columns, double from, double to) {
        BaseMesh mesh = make_plane(columns, 1, 2, 2);
        for (BaseVertex& vertex : mesh.vertices)
            vertex.texture.x = from + (to - from) * vertex.texture.x;
        return testing::joined(setup_of(mesh, hill_map()).remarks);
    };
    const std::string text = "that stretches the map across ";
    CHECK_THAT(remarks(1, 0, 2), Contains(text + "2 triangles, and heights and normals within it are wrong"));
    CHECK_THAT(remarks(3, -0.5, 1.5), Contains(text + "4 triangles"));
    CHECK_THAT(remarks(2, 0, 2), Contains("outside 0..1") && !Contains(text));
    CHECK_THAT(remarks(2, -1, 1), Contains("outside 0..1") && !Contains(text));
    CHECK_THAT(remarks(1, 2, 3), Contains("outside 0..1") && !Contains(text));
}

TEST_CASE("one texel size: triangles with next to no area in the map are said") {
    const Plane plane{2, 1, {{{0.3, 0.2}, {1e-6, 0}, {0, 1}}, {{0, 0}, {1, 0}, {0, 1}}}};
    const MachineSetup setup = setup_of(plane.mesh(), hill_map(), "");
    CHECK(setup.texel_spread.wrong_percent > 1);
    CHECK_THAT(testing::joined(setup.remarks), Contains("some have next to no area in it. Normals are off by"));
}

TEST_CASE("one texel size: one so large that the normal map is flat is said") {
    BaseMesh mesh = parts_along_u(0.5).mesh();
    mesh.texture_scale.mean_u = mesh.texture_scale.mean_v = 1e6;
    const MachineSetup setup = setup_of(mesh, hill_map(), "");
    CHECK(setup.texel_spread.wrong_percent > 50);
    CHECK_THAT(testing::joined(setup.remarks), Contains("one texel size"));
}

const std::string corners_of_cube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const std::string normals_of_cube = "vn 0 0 -1\nvn 0 0 1\nvn 0 -1 0\nvn 1 0 0\nvn 0 1 0\nvn -1 0 0\n";

std::string cube(bool with_normals) {
    const std::array<std::array<int, 4>, 6> faces{
        {{4, 3, 2, 1}, {5, 6, 7, 8}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}}};
    std::string text = corners_of_cube + (with_normals ? normals_of_cube : "");
    for (std::size_t f = 0; f < faces.size(); ++f) {
        text += "f";
        for (std::size_t k = 0; k < 4; ++k)
            text += fmt::format(" {}/{}{}", faces[f][k], k + 1, with_normals ? fmt::format("/{}", f + 1) : "");
        text += '\n';
    }
    return text;
}

InvariantResult invariants_of(const BaseMesh& mesh, const HeightMap& map) {
    const MachineSetup setup = setup_of(mesh, map, "tests.generation_limit=3");
    return check_invariants(testing::bare_mesh(setup), setup);
}

HeightMap level_map() {
    HeightMap map = hill_map(16);
    std::fill(map.values.begin(), map.values.end(), 0.5F);
    return map;
}

}  // namespace

TEST_CASE("edges opened by split normals are creases, whatever their texture coordinates") {
    const BaseMesh flat = parse_obj(cube(true), "cube");
    CHECK_THAT(testing::joined(flat.repairs),
               Contains("8 point(s) have more than one normal") &&
                   Contains("Export the mesh with smooth normals, or its faces without normals"));
    SECTION("a level map: the normals alone open the cube, the remedy closes it") {
        const InvariantResult result = invariants_of(flat, level_map());
        CHECK(result.open_crease_edges == 12);
        CHECK(result.open_texture_seam_edges == 0);
        const BaseMesh smooth = parse_obj(cube(false), "cube");
        CHECK_THAT(testing::joined(smooth.repairs), !Contains("normal"));
        const InvariantResult remedied = invariants_of(smooth, level_map());
        CHECK(remedied.open_crease_edges + remedied.open_texture_seam_edges == 0);
    }
    SECTION("normals and map open the cube: creases, and said so") {
        const InvariantResult result = invariants_of(flat, hill_map(16));
        CHECK(result.open_crease_edges > 12);
        CHECK(result.open_crease_edges_of_seams > 0);
        CHECK(result.open_texture_seam_edges == 0);
        const InvariantResult smooth = invariants_of(parse_obj(cube(false), "cube"), hill_map(16));
        CHECK(smooth.open_crease_edges == 0);
        CHECK(smooth.open_texture_seam_edges > 0);
    }
    SECTION("two faces with equal coordinates at their edge") {
        const BaseMesh roof = parse_obj(
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\nvt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nvt 1 0\nvt 1 1\n"
            "vn 0 0 1\nvn 1 0 0\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/2/2 5/5/2 6/6/2 3/3/2\n",
            "roof");
        const InvariantResult result = invariants_of(roof, level_map());
        CHECK(result.open_crease_edges == 1);
        CHECK(result.open_crease_edges_of_seams == 0);
        CHECK(result.open_texture_seam_edges == 0);
    }
    SECTION("islands over a map that is alike on both sides of their seam stay closed") {
        const BaseMesh plane = Plane{2, 1, {straight, turned(180)}}.mesh();
        const InvariantResult result = invariants_of(plane, level_map());
        CHECK(result.texture_seams == 1);
        CHECK(result.open_crease_edges + result.open_texture_seam_edges == 0);
    }
}

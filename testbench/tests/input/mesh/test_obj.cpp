#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <sstream>

#include "testbench/common/error.h"
#include "testbench/input/mesh/obj_reader.h"
#include "testbench/input/mesh/polygon_cutter.h"
#include "testbench/input/mesh/surface_flaws.h"
#include "testbench/setup/mesh/tangent_frames.h"
#include "testbench/tests/input/mesh/mesh_checks.h"
#include "testbench/tests/support/text.h"

using namespace tessera;
using Catch::Contains;
using Catch::StartsWith;

namespace {

/// A unit square with texture coordinates and a normal, to which tests append faces.
const std::string square =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "vn 0 0 1\n";

BaseMesh parse(const std::string& text) {
    return parse_obj(text, "test.obj");
}

/// Area of the mesh in the x,y plane; triangles that face downwards count as negative.
double signed_area(const BaseMesh& mesh) {
    double area = 0;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[t[0]].position;
        area += glm::cross(mesh.vertices[t[1]].position - a, mesh.vertices[t[2]].position - a).z / 2;
    }
    return area;
}

std::string polygon(const std::vector<glm::dvec2>& outline) {
    std::string text, face = "f";
    for (std::size_t i = 0; i < outline.size(); ++i) {
        text += fmt::format("v {} {} 0\nvt {} {}\n", outline[i].x, outline[i].y, outline[i].x, outline[i].y);
        face += fmt::format(" {}/{}", i + 1, i + 1);
    }
    return text + face + "\n";
}

}  // namespace

TEST_CASE("a good quad loads without a repair") {
    const BaseMesh mesh = parse(square + "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    require_complete(mesh);
    CHECK(testing::joined(mesh.repairs) == "");
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.triangles[0] == std::array<std::uint32_t, 3>{0, 1, 2});
    CHECK(mesh.triangles[1] == std::array<std::uint32_t, 3>{0, 2, 3});
    CHECK(mesh.vertices[2].texture == glm::dvec2(1, 1));
}

TEST_CASE("all forms of an OBJ file give the same mesh") {
    const std::string forms[] = {
        square + "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1\n",
        square + "f 1/1 2/2 \\\n 3/3 4/4",
        "\xef\xbb\xbf" + square + "g a\ns off\nusemtl x\no y # z\nf 1/1/1 2/2/1 3/3/1 4/4/1 # comment\nl 1 2\np 1",
        "f 1/1 2/2 3/3 4/4\n" + square,
        "# C:\\temp\\\n" + square + "fo 1/1 2/2 3/3 4/4",
        "v 0e999 -0.0 +0 1\nv 1E+0 1e-320 .0 1 0 0 1\nv 10e-1 1. 0 1 1 1\nv 1e-400 +1 "
        "0.0000000000000000000000000000001e-999\n"
        "vt 0\nvt 1 0\nvt 1 1 0\nvt 0 1\nf 1/1 2/2 3/3 4/4",
    };
    const BaseMesh wanted = parse(square + "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    for (std::string text : forms) {
        for (std::string ending : {"\n", "\r\n", "\r"}) {
            std::string with_ending;
            for (char c : text)
                with_ending += c == '\n' ? ending : std::string(1, c);
            INFO(with_ending);
            const BaseMesh mesh = parse(with_ending);
            CHECK(testing::joined(mesh.repairs) == "");
            CHECK(mesh.triangles == wanted.triangles);
            REQUIRE(mesh.vertices.size() == 4);
            for (std::size_t i = 0; i < 4; ++i) {
                CHECK(safe_length(mesh.vertices[i].position - wanted.vertices[i].position) < 1e-300);
                CHECK(mesh.vertices[i].texture == wanted.vertices[i].texture);
                CHECK(mesh.vertices[i].normal == wanted.vertices[i].normal);
            }
        }
    }
}

TEST_CASE("numbers are correctly rounded from the text") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> mantissa(-10, 10), exponent(-20, 30);
    for (int i = 0; i < 1000; ++i) {
        const double value = mantissa(random), scaled = value * std::pow(10, exponent(random));
        for (const std::string& text :
             {fmt::format("{:.17g}", scaled), fmt::format("{:.9g}", scaled), fmt::format("{:.12f}", value)}) {
            INFO(text);
            const BaseMesh mesh = parse(fmt::format("v 0 0 0\nv {} 0 0\nv 0 {} 0\nf 1 2 3\n", text, text));
            const double wanted = std::strtod(text.c_str(), nullptr);
            CHECK(mesh.vertices[1].position.x == wanted);
        }
    }
}

TEST_CASE("bad input ends in an error with file and line") {
    std::istringstream bad_lines(
        "v nan 0 0|v -inf 0 0|v 1e39 0 0|v 1e999 0 0|v a b c|v 0,5 0 0|"
        "v 123456789012345678901234567890123456789012345e300 0 0|v 0x10 0 0|v 1.5.2 0 0|v +-1 0 0|"
        "v 1e 0 0|v 1 0|v|v 1 2 3 4 5 6 7 8|v 1 2 3 nan|vt nan 0|vt|vt 0 0 0 0|vn 0 0|vn 0 0 1 0|f|"
        "f 1|f 1/1 2/2|f 0 1 2|f 1/0 2/1 3/1|f 1 2 5|f 1 2 -5|f 1/1 2/2 3/-5|f 1 2 -2147483648|"
        "f 1 2 -9223372036854775808|f 1 2 99999999999999999999999|f 1 2 4294967297|f 1/1 2/2 3/9|"
        "f 1//1 2//1 3//2|f 1.5 2 3|f 1-2 2 3|f a b c|f 1/ 2/ 3/|f 1// 2// 3//|f 1/1/ 2/2/ 3/3/|"
        "f /1 /2 /3|f //1 //1 //1|f 1/1/1/1 2/2/1/1 3/3/1/1|f 1,2,3|f 1 2 0x3|f 1 2 3\\");
    for (std::string bad; std::getline(bad_lines, bad, '|');) {
        INFO(bad);
        // line 10, after the nine of the square; a good face follows unless the bad line must be the last
        const std::string text = square + bad + (bad.back() == '\\' ? "" : "\nf 1/1 2/2 3/3 4/4\n");
        CHECK_THROWS_AS(parse(text), InputError);
        CHECK_THROWS_WITH(parse(text), StartsWith("test.obj:10: "));
    }
    CHECK_THROWS_WITH(parse(square + "v 1 nan 0\n"), Contains("'nan' in `v`"));
    CHECK_THROWS_WITH(parse(square + "v 1\v2 3 4\n"), Contains("\\x0b"));
    CHECK_THROWS_WITH(parse(square + "f 1 2 3.5\n"), Contains("'3.5'"));
    CHECK_THROWS_WITH(parse(square + "f 0 1 2\nv 0 0 1\n"), StartsWith("test.obj:10: "));  // not the next
    CHECK_THROWS_WITH(parse(square + "f 1 2 \\\n3\n# none\nv 0 0 nan\n"), StartsWith("test.obj:13: "));
    using namespace std::string_literals;
    const std::pair<std::string, std::string> bad_files[] = {
        {"", "no face"},
        {"<!DOCTYPE html><html>404</html>\n",
         "no face (`f` line) in 1 line(s), but 1 with other keywords (the first is '<!DOCTYPE'"},
        {"v 0 0 0\nv 1 0\0 0\n"s, "a zero byte"},
        {"\xff\xfev\0 \0"s, "UTF-16"},
    };
    for (const auto& [text, message] : bad_files) {
        CHECK_THROWS_AS(parse(text), InputError);
        CHECK_THROWS_WITH(parse(text), StartsWith("test.obj: ") && Contains(message));
    }
}

TEST_CASE("corners without texture coordinates get a projected map, with a repair") {
    const BaseMesh mesh = parse("v 0 0 5\nv 4 0 5\nv 0 2 5\nf 1 2 3\n");
    require_complete(mesh);
    CHECK_THAT(testing::joined(mesh.repairs),
               StartsWith("3 vertices have no texture coordinates") && Contains("along z"));
    CHECK(mesh.vertices[1].texture == glm::dvec2(1, 0));
    CHECK(mesh.vertices[2].texture == glm::dvec2(0, 1));
    CHECK_THAT(testing::joined(parse(square + "f 1/1 2 3/3\n").repairs),
               StartsWith("1 vertices have no texture coordinates, first used in line 10"));
}

TEST_CASE("flat triangles are dropped and counted, an empty result is an error") {
    const BaseMesh mesh = parse(square + "f 1/1 2/2 3/3\nf 1/1 1/1 2/2\nf 1/1 3/3 4/4\nf 1/1 2/2 1/1 2/2\n");
    CHECK(mesh.triangles.size() == 2);
    CHECK(mesh.dropped_degenerate == 3);
    CHECK_THAT(testing::joined(mesh.repairs), Contains("3 triangle(s) of zero area") && Contains("line 11"));
    CHECK_THROWS_WITH(parse("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), Contains("no triangle is left"));
    CHECK_THROWS_WITH(parse("v 0 0 0\nv 0.1 0.1 0.7\nv 0.3 0.3 2.1\nf 1 2 3\n"), Contains("no triangle is left"));
    CHECK_THROWS_WITH(parse("v 0 0 0\nv 1e-200 0 0\nv 0 1e-200 0\nf 1 2 3\n"), Contains("smaller than"));
}

TEST_CASE("an n-gon that repeats a point in succession uses it once") {
    const BaseMesh mesh = parse(square + "f 1/1 2/2 2/2 3/3 4/4 1/1\n");
    CHECK(mesh.triangles.size() == 2);
    CHECK(signed_area(mesh) == Approx(1));
    CHECK_THAT(testing::joined(mesh.repairs), Contains("name one point twice in a row"));
}

TEST_CASE("repeated and turned-over triangles are dropped, two-sided sheets are kept") {
    const BaseMesh repeated = parse(square + "f 1/1 2/2 3/3\nf 2/2 3/3 1/1\n");
    CHECK(repeated.triangles.size() == 1);
    CHECK(repeated.dropped_duplicate == 1);
    CHECK_THAT(testing::joined(repeated.repairs), Contains("repeat an earlier one") && Contains("line 11"));
    const BaseMesh turned = parse(square + "f 1/1 2/2 3/3\nf 3/3 2/2 1/1\n");
    CHECK(turned.triangles.size() == 1);
    CHECK_THAT(testing::joined(turned.repairs), Contains("opposite winding"));
    CHECK(turned.vertices[0].normal == glm::dvec3(0, 0, 1));
    const BaseMesh sheet = parse(square + "vn 0 0 -1\nf 1/1/1 2/2/1 3/3/1\nf 3/3/2 2/2/2 1/1/2\n");
    CHECK(sheet.triangles.size() == 2);
    CHECK_THAT(testing::joined(sheet.repairs), Contains("more than one normal"));
    const auto leaning = [&](const std::string& x) {
        return testing::joined(parse(square + "vn " + x + " 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1/1/2 3/3/2 4/4/2\n").repairs);
    };
    CHECK_THAT(leaning("2e-6"), !Contains("more than one normal"));  // as six decimals round one
    CHECK_THAT(leaning("1e-3"), Contains("2 point(s) have more than one normal"));
}

TEST_CASE("T-junctions, non-manifold edges and changes of winding are reported") {
    const BaseMesh junction =
        parse("v 0 0 0\nv 2 0 0\nv 1 2 0\nv 1 0 0\nv 0 -2 0\nv 2 -2 0\nf 1 2 3\nf 1 5 4\nf 4 5 6\nf 4 6 2\n");
    CHECK_THAT(testing::joined(junction.repairs), Contains("1 border edge(s) contain another vertex"));
    const BaseMesh book = parse("v 0 0 0\nv 0 0 1\nv 1 0 0\nv -1 1 0\nv -1 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
    CHECK_THAT(testing::joined(book.repairs), Contains("1 edge(s) belong to more than two triangles"));
    const BaseMesh twisted = parse(square + "f 1/1 2/2 3/3\nf 1/1 4/4 3/3\n");
    CHECK_THAT(testing::joined(twisted.repairs), Contains("The winding changes across 1 edge(s)"));
    CHECK(twisted.winding_changes == 1);
    CHECK_THAT(testing::joined(twisted.repairs),
               Contains("At 2 point(s) the normals of the surrounding triangles cancel"));
    require_complete(twisted);
}

TEST_CASE("points of the border that rounding separates are joined, and near ones are told") {
    // A tube of a square section; the last column repeats the first, `apart` away.
    const auto tube = [](double apart, const char* shortest = "") {
        const std::string a = fmt::format("{}", 1 + apart);
        return parse("v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv " + a + " 0 0\nv 1 0 2\nv 0 1 2\nv -1 0 2\nv 0 -1 2\nv " +
                     a +
                     " 0 2\nvt 0 0\nvt .25 0\nvt .5 0\nvt .75 0\nvt 1 0\nvt 0 1\nvt .25 1\nvt .5 1\nvt .75 1\nvt 1 1\n"
                     "f 1/1 2/2 7/7 6/6\nf 2/2 3/3 8/8 7/7\nf 3/3 4/4 9/9 8/8\nf 4/4 5/5 10/10 9/9\n" +
                     shortest);
    };
    const BaseMesh exact = tube(0);
    CHECK(exact.repairs.empty());
    for (const double apart : {1e-12, 1e-8, 1.9e-6}) {
        const BaseMesh joined = tube(apart);
        INFO(apart << testing::joined(joined.repairs));
        CHECK_THAT(testing::joined(joined.repairs),
                   Contains("2 point(s) of the border lay within 2e-06 of another, and were joined to it"));
        for (std::size_t k = 0; k < exact.vertices.size(); ++k) {
            CHECK(joined.vertices[k].position == exact.vertices[k].position);
            CHECK(joined.vertices[k].normal == exact.vertices[k].normal);
        }
    }
    for (const double apart : {2.1e-6, 1.9e-4})
        CHECK_THAT(
            testing::joined(tube(apart).repairs),
            Contains("2 point(s) of the border lie within 0.0002 of another: the displaced surface opens there"));
    CHECK(tube(2.1e-4).repairs.empty());
    // A triangle between the two would collapse.
    const BaseMesh small = tube(1e-6, "v 1 1e-6 0\nf 1/1 5/5 11/2\n");
    CHECK(small.triangles.size() == 9);
    CHECK_THAT(testing::joined(small.repairs), Contains("1 point(s) of the border lay within"));
}

TEST_CASE("normals that lean away from their triangles are counted") {
    const auto square_with = [&](const std::string& normal) {
        return testing::joined(parse(square + "vn " + normal + "\nf 1/1/2 2/2/2 3/3/2 4/4/2\n").repairs);
    };
    CHECK_THAT(square_with("0.5 0 0.866"), Contains("4 vertices have a normal that is not that of the triangles around "
                                                    "them, by up to 30 degrees"));
    CHECK_THAT(square_with("0.05 0 1"), !Contains("not that of the triangles"));
    // Smooth and faceted normals of a fold lie within its triangles' cone.
    const std::string fold =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "vn 0 0 1\nvn -1 0 0\nvn -0.7 0 0.7\n";
    CHECK_THAT(testing::joined(parse(fold + "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/1/2 5/2/2 6/3/2 3/4/2\n").repairs),
               !Contains("not that of the triangles"));
    CHECK_THAT(testing::joined(parse(fold + "f 1/1/1 2/2/3 3/3/3 4/4/1\nf 2/1/3 5/2/2 6/3/2 3/4/3\n").repairs),
               !Contains("not that of the triangles"));
}

TEST_CASE("T-junctions are reported if they are off their edge by rounding") {
    const auto with = [](const char* y) {
        return testing::joined(parse(std::string("v 0 0 0\nv 2 0 0\nv 1 2 0\nv 1 ") + y +
                                     " 0\nv 0 -2 0\nv 2 -2 0\nf 1 2 3\nf 1 5 4\nf 4 5 6\nf 4 6 2\n")
                                   .repairs);
    };
    CHECK_THAT(with("-1e-4"), Contains("1 border edge(s) contain another vertex"));
    CHECK_THAT(with("-1e-2"), !Contains("contain another vertex"));
}

TEST_CASE("given normals are normalised, and computed if their length is zero") {
    const BaseMesh mesh =
        parse(square + "vn 0 0 0\nvn 0 0 1e-320\nvn 1e38 1e38 1e38\nvn 0 3 4\nf 1/1/2 2/2/3 3/3/4 4/4/5\n");
    require_complete(mesh);
    CHECK(mesh.vertices[0].normal == glm::dvec3(0, 0, 1));
    CHECK(mesh.vertices[1].normal == glm::dvec3(0, 0, 1));
    CHECK(mesh.vertices[2].normal.x == Approx(std::sqrt(1.0 / 3)));
    CHECK(mesh.vertices[3].normal.y == Approx(0.6));
    CHECK_THAT(testing::joined(mesh.repairs),
               Contains("1 vertex normal(s) have zero length") && Contains("3 vertex normal(s) are not"));
    CHECK_THAT(testing::joined(parse(square + "vn 0 0 -1\nf 1/1/2 2/2/2 3/3/2\n").repairs),
               Contains("against their winding"));
}

TEST_CASE(
    "computed normals are those of the surface, also across texture seams, and do not depend on the triangulation") {
    // a cube of quads: the three faces at each corner have equal angles, whichever diagonal cuts them
    const std::string cube =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt "
        "0 1\n"
        "f 4/1 3/2 2/3 1/4\nf 5/1 6/2 7/3 8/4\nf 1/1 2/2 6/3 5/4\nf 2/1 3/2 7/3 6/4\nf 3/1 4/2 8/3 7/4\nf "
        "4/1 1/2 5/3 8/4\n";
    const BaseMesh mesh = parse(cube);
    require_complete(mesh);
    CHECK(mesh.vertices.size() == 24);  // each face is an island, also where indices are the same in two
    const EdgeCounts edges = count_edges(mesh);
    CHECK(edges.border == 0);
    CHECK(edges.odd == 0);
    for (const BaseVertex& v : mesh.vertices) {
        CHECK(safe_length(v.normal - unit_or_zero(v.position - glm::dvec3(0.5))) < 1e-15);
        for (const BaseVertex& w : mesh.vertices)
            if (v.position == w.position)
                CHECK(v.normal == w.normal);
    }
}

TEST_CASE("a mirrored texture flips the handedness, mixed points have no tangent") {
    const BaseMesh mirrored = parse(square + "vt -1 0\nvt -1 1\nf 1/1/1 2/5/1 3/6/1\n");
    CHECK(mirrored.vertices[0].handedness == -1);
    CHECK(mirrored.vertices[0].tangent == glm::dvec3(-1, 0, 0));
    const BaseMesh mixed =
        parse(square + "v -1 0 0\nv -1 1 0\nf 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\nf 5/2/1 1/1/1 4/4/1\n");
    CHECK_THAT(testing::joined(mixed.repairs), Contains("mirrored"));
    CHECK(mixed.vertices[0].handedness == 1);
    CHECK(mixed.vertices[0].tangent == glm::dvec3(0));
    require_complete(mixed);
}

TEST_CASE("a triangle without area in texture space gives no tangent and a repair") {
    const BaseMesh mesh = parse(square + "v 2 0 0\nf 1/1 2/2 3/3 4/4\nf 2/1 5/1 3/1\n");
    require_complete(mesh);
    CHECK_THAT(testing::joined(mesh.repairs), Contains("1 triangle(s) have no area in texture space"));
}

TEST_CASE("a mesh without any area in texture space gets a projected map") {
    const BaseMesh mesh = parse(square + "f 1/1 2/1 3/1 4/1\n");
    require_complete(mesh);
    CHECK_THAT(testing::joined(mesh.repairs),
               Contains("No triangle has an area in texture space: the map was projected onto the "
                        "mesh's bounding box along z."));
    CHECK(mesh.vertices[2].texture == glm::dvec2(1, 1));
    CHECK(mesh.texture_scale.mean_u == 1);
}

TEST_CASE("texture scale is the area-weighted mean with its spread") {
    // areas 1/2 and 3/2; |dp/du| 1 and 2
    const BaseMesh mesh = parse(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 3 0 0\nv 6 0 0\nv 3 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1.5 0\n"
        "f 1/1 2/2 3/3\nf 4/1 5/4 6/3\n");
    CHECK(mesh.texture_scale.smallest_u == Approx(1));
    CHECK(mesh.texture_scale.largest_u == Approx(2));
    CHECK(mesh.texture_scale.mean_u == Approx(1.75));
    CHECK(mesh.texture_scale.mean_v == Approx(1));
}

TEST_CASE("slivers in the map do not count for a texel's size") {
    const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    for (const char* const width : {"1e-5", "1e-9", "1e-12"}) {
        const BaseMesh mesh =
            parse(quad + "vt " + width + " 0.5\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 1/1 4/4 5/5\nf 2/2 5/5 1/1\n");
        CHECK(mesh.texture_scale.mean_u == Approx(1));
        CHECK(mesh.texture_scale.largest_u == Approx(1));
        CHECK(mesh.texture_scale.mean_v == Approx(4. / 3).margin(0.001));
    }
    const BaseMesh narrow = parse(quad + "vt 0.1 0.5\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 1/1 4/4 5/5\n");  // no sliver
    CHECK(narrow.texture_scale.largest_u > 9);
}

TEST_CASE("concave polygons are cut inside their outline") {
    std::vector<glm::dvec2> saws{{0, -1}};
    for (const double y : {-3, -8, -3, -8, -3, -10})
        saws.emplace_back(saws.size(), y);
    for (const double y : {4, 0, 3, -2, 3, 0, 3})
        saws.emplace_back(14 - saws.size(), y);
    const std::vector<std::vector<glm::dvec2>> outlines{
        {{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}},                                          // a notch
        {{0, 0}, {2, 0}, {1, 0.5}, {1, 2}},                                                // a dart
        {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}},                  // corners on straight edges
        {{0, 0}, {1, 0}, {0, 1}, {0, 0.5}},                                                // an extra corner
        {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}},                  // a U
        {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}},  // a hole with a bridge
        saws,
    };
    const double areas[] = {10, 1.25, 4, 0.5, 7, 12, 42};
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        for (bool reversed : {false, true}) {
            std::vector<glm::dvec2> outline = outlines[i];
            if (reversed)
                std::reverse(outline.begin() + 1, outline.end());
            INFO(i << reversed);
            const BaseMesh mesh = parse(polygon(outline));
            CHECK(testing::joined(mesh.repairs) == "");
            CHECK(mesh.triangles.size() == outline.size() - 2);
            CHECK(signed_area(mesh) == Approx(reversed ? -areas[i] : areas[i]));
            for (const BaseVertex& v : mesh.vertices)
                CHECK(v.normal.z == (reversed ? -1 : 1));
        }
    }
}

TEST_CASE("large polygons, convex and not, are cut") {
    const std::size_t n = 5000;
    for (const double inner : {1.0, 0.3}) {
        std::vector<glm::dvec2> outline;
        double area = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double angle = 2 * 3.14159265358979323846 * static_cast<double>(i) / static_cast<double>(n);
            outline.push_back((i % 2 ? inner : 1.0) * glm::dvec2(std::cos(angle), std::sin(angle)));
        }
        for (std::size_t i = 0; i < n; ++i) {
            glm::dvec2 const &a = outline[i], &b = outline[(i + 1) % n];
            area += (a.x * b.y - a.y * b.x) / 2;
        }
        const BaseMesh mesh = parse(polygon(outline));
        CHECK(mesh.triangles.size() == n - 2);
        CHECK(signed_area(mesh) == Approx(area));
        const EdgeCounts edges = count_edges(mesh);
        CHECK(edges.border == n);
        CHECK(edges.odd == 0);
    }
}

TEST_CASE("no corner of a large convex polygon is shared by most of its triangles") {
    for (const std::size_t n : {std::size_t{9}, std::size_t{10}, std::size_t{1000}, std::size_t{65536}}) {
        std::vector<glm::dvec2> outline;
        for (std::size_t i = 0; i < n; ++i) {
            const double angle = 2 * 3.14159265358979323846 * static_cast<double>(i) / static_cast<double>(n);
            outline.emplace_back(std::cos(angle), std::sin(angle));
        }
        const BaseMesh mesh = parse(polygon(outline));
        CHECK(mesh.triangles.size() == n - 2);
        CHECK(signed_area(mesh) ==
              Approx(static_cast<double>(n) / 2 * std::sin(2 * 3.14159265358979323846 / static_cast<double>(n))));
        std::vector<std::size_t> triangles(mesh.vertices.size());
        for (const auto& t : mesh.triangles)
            for (const std::uint32_t i : t)
                ++triangles[i];
        // Two more each round, and a fan of at most 8 corners at the end.
        const double rounds = std::ceil(std::log2(static_cast<double>(n) / 8));
        CHECK(static_cast<double>(*std::max_element(triangles.begin(), triangles.end())) <= 2 * rounds + 6);
        const EdgeCounts edges = count_edges(mesh);
        CHECK(edges.border == n);
        CHECK(edges.odd == 0);
    }
}

TEST_CASE("outlines that cross themselves or are not planar load with a repair") {
    for (const std::string& text :
         {polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), polygon({{0, 0}, {3, 3}, {3, 0}, {0, 1}}),
          polygon({{0, 1}, {0.59, -0.81}, {-0.95, 0.31}, {0.95, 0.31}, {-0.59, -0.81}})}) {
        const BaseMesh mesh = parse(text);
        require_complete(mesh);
        CHECK_THAT(testing::joined(mesh.repairs), Contains("crosses itself"));
    }
    const BaseMesh bent =
        parse("v 0 0 0\nv 1 0 1\nv 1 1 0\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
    require_complete(bent);
    CHECK(bent.triangles.size() == 2);
    CHECK_THAT(testing::joined(bent.repairs), Contains("not planar"));
}

TEST_CASE("files beyond a limit are refused with the limit") {
    std::string face = "f";
    for (std::size_t i = 0; i < 1'000'000; ++i)
        face += i % 3 == 0 ? " 1" : i % 3 == 1 ? " 2" : " 3";
    CHECK_THROWS_AS(parse(square + face + "\n"), ResourceError);
    CHECK_THROWS_WITH(parse(square + face + "\n"), StartsWith("test.obj:10: ") && Contains("65536"));
    std::string many = square;
    for (std::size_t i = 0; i < 4'000'001; ++i)
        many += "f 1 2 3\n";
    CHECK_THROWS_WITH(parse(many), StartsWith("test.obj:4000010: ") && Contains("4000000"));

    // a comb, in which every ear test examines many corners, with a small work limit
    std::vector<glm::dvec3> comb;
    for (int i = 0; i < 1000; ++i)
        comb.push_back({i, i % 2 * 100, 0});
    comb.push_back({500, -100, 0});
    std::uint64_t little = 1000, much = largest_cutting_work;
    CHECK_FALSE(cut_polygon(comb, little));
    CHECK(cut_polygon(comb, much));
    CHECK(much < largest_cutting_work);
}

TEST_CASE("unknown keywords are skipped and reported") {
    const BaseMesh mesh = parse("hello\n" + square + "\x01\x02 3\nf 1/1 2/2 3/3\nsurf 0 1 0 1 1 2 3 4\n");
    CHECK_THAT(testing::joined(mesh.repairs),
               Contains("3 line(s) begin with an unknown keyword") && Contains("the first is line 1: 'hello'."));
}

namespace {

/// Requires that the text gives a mesh or one of our two errors in printable words. Returns whether it loaded.
bool survives(const std::string& text) {
    std::string message;
    try {
        const BaseMesh mesh = parse(text);
        require_complete(mesh);
        return true;
    } catch (const InputError& error) {
        message = error.what();
    } catch (const ResourceError& error) {
        message = error.what();
    }
    CHECK_THAT(message, StartsWith("test.obj:"));
    CHECK(std::all_of(message.begin(), message.end(), [](char c) { return c >= ' ' && c <= '~'; }));
    return false;
}

const std::string small_mesh =
    "# small\r\nv 0 0 0\nv 1.5 0 -1e-1\nv 1 1 0.25 1\nv 0 1 0\nv .5 2 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn "
    "0 0 1\nvn 0.6 0 0.8\n"
    "s 1\nf 1/1/1 2/2/2 3/3/1 4/4/1\nf 4/4 3/3 \\\n 5/1\nf -1//-1 -2//-1 -4//-2\n";

}  // namespace

TEST_CASE("damaged files end in a mesh or an error") {
    REQUIRE(survives(small_mesh));
    const char* const words[] = {"v ",       "f ",   "/",     "-",  "1e999 ", "0e999 ",
                                 "nan ",     "\\\n", "\n",    "#",  "\r",     "99999999999 ",
                                 "1.5/1/1 ", "\xff", "g x\n", "vn "};
    std::mt19937 random(1);
    std::size_t loaded = 0;
    for (int run = 0; run < 600; ++run) {
        std::string text = small_mesh;
        for (auto damages = 1 + random() % 3; damages > 0; --damages) {
            const std::size_t at = random() % (text.size() + 1), length = random() % 20;
            switch (random() % 5) {
                case 0: text.resize(at); break;
                case 1: text.erase(at, length); break;
                case 2: text.insert(at, words[random() % std::size(words)]); break;
                case 3: text.insert(at, text.substr(random() % (text.size() + 1), length)); break;
                default: text.insert(at, 1, static_cast<char>(random()));
            }
        }
        INFO(text);
        loaded += survives(text);
    }
    CHECK(loaded > 20);
    CHECK(loaded < 400);
}

TEST_CASE("random triangle soups of all sizes meet the guarantees of a base mesh") {
    std::mt19937 random(2);
    std::size_t loaded = 0;
    for (int run = 0; run < 2000; ++run) {
        std::uniform_real_distribution<double> size(-20, 37);
        const double scale = std::pow(10, size(random)), texture_scale = std::pow(10, size(random));
        std::uniform_int_distribution<int> coordinate(-4, 4);
        std::string text;
        for (int i = 0; i < 12; ++i) {
            text += fmt::format("v {} {} {}\n", coordinate(random) * scale / 4, coordinate(random) * scale / 4,
                                coordinate(random) * scale / 4);
            text += fmt::format("vt {} {}\n", coordinate(random) * texture_scale, coordinate(random) * texture_scale);
            text += fmt::format("vn {} {} {}\n", coordinate(random), coordinate(random), coordinate(random));
        }
        for (int f = 0; f < 8; ++f) {
            text += "f";
            const auto corners = 3 + random() % 5;
            const bool with_normal = random() % 2;
            for (unsigned i = 0; i < corners; ++i) {
                const auto v = 1 + random() % 12;
                text += with_normal ? fmt::format(" {}/{}/{}", v, v, v) : fmt::format(" {}/{}", v, v);
            }
            text += "\n";
        }
        INFO(text);
        loaded += survives(text);
    }
    CHECK(loaded > 1900);
}

TEST_CASE("a mesh file of another kind is refused with a remedy") {
    using namespace std::string_literals;
    std::string binary_stl(84 + 2 * 50, '\x3f');
    binary_stl.replace(0, 5, "solid");  // as some exporters begin it
    binary_stl.replace(80, 4, "\2\0\0\0"s);
    const std::vector<std::pair<std::string, std::string>> files{
        {"ply\nformat ascii 1.0\nelement vertex 8\n", "a PLY file"},
        {"ply\r\nformat binary_little_endian 1.0\r\n", "a PLY file"},
        {"glTF\2\0\0\0\x10\0\0\0"s, "a GLB file (binary glTF)"},
        {"{\n  \"asset\" : { \"version\" : \"2.0\" }\n}\n", "a glTF file"},
        {" solid cube\n facet normal 0 0 1\n", "an STL file"},
        {binary_stl, "an STL file"},
        {"OFF\n8 6 12\n", "an OFF file"},
        {"<?xml version=\"1.0\"?><COLLADA/>", "an XML file"},
        {"Kaydara FBX Binary  \0"s, "an FBX file"},
    };
    for (const auto& [content, kind] : files) {
        INFO(kind);
        CHECK_THROWS_WITH(parse(content), StartsWith("test.obj: this is " + kind) && Contains("export it as OBJ"));
    }
    CHECK_NOTHROW(parse("# solid facet ply glTF\n" + square + "f 1/1 2/2 3/3\n"));
}

TEST_CASE("smoothing groups are said to be unused if normals are calculated and the groups differ") {
    const auto repairs = [](const std::string& first, const std::string& second, const std::string& normal = "") {
        const std::string corner = normal.empty() ? " " : "//1 ";
        return testing::joined(parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + normal + first + "\nf 1" + corner +
                                             "2" + corner + "3" + corner + "\n" + second + "\nf 1" + corner + "3" +
                                             corner + "4" + corner + "\n",
                                         "a.obj")
                                   .repairs);
    };
    const auto told = Contains("Smoothing groups (`s`) are not used");
    CHECK_THAT(repairs("s 1", "s 2"), told);
    CHECK_THAT(repairs("s 1", "s off"), told);
    CHECK_THAT(repairs("s 0", "s 3"), told);
    CHECK_THAT(repairs("s 1", ""), !told);
    CHECK_THAT(repairs("s off", "s 0"), !told);
    CHECK_THAT(repairs("", "s 1"), !told);
    CHECK_THAT(repairs("s 1", "s 2", "vn 0 0 1\n"), !told);
}

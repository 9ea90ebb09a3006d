#include <catch2/catch.hpp>
#include <filesystem>

#include "testbench/bake/surface_file.h"
#include "testbench/tests/support/refusals.h"
#include "testbench/tests/support/source_folder.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using Catch::Equals;

namespace {

std::string error_of(const std::string& text) {
    return input_error_of([&] { parse_surface(text, "s.toml"); });
}

std::string quadric(const std::string& keys) {
    return "[quadric]\n" + keys;
}

/// A good [nurbs], or one with a key replaced by another line.
std::string nurbs(const std::string& key = "", const std::string& line = "") {
    std::string text = "[nurbs]\n";
    for (const std::string row :
         {"degree_u = 2", "degree_v = 1", "knots_u = [0, 0, 0, 1, 2, 2, 2]", "knots_v = [0, 0, 1, 1]",
          "heights = [[0, 1, 2, 3], [4, 5, 6, 7]]", "weights = [[1, 1, 1, 1], [1, 1, 1, 1]]"})
        text += (row.substr(0, row.find(' ')) == key ? line : row) + "\n";
    return text;
}

}  // namespace

TEST_CASE("surface file: the examples are read") {
    const std::filesystem::path examples = source_folder() / "testbench/examples/surfaces";
    const Surface dome = read_surface(examples / "dome.toml");
    const auto& sphere = std::get<QuadricSurface>(dome.shape);
    CHECK(sphere.quadric.centre == glm::dvec3(0, 0, -0.25));
    CHECK(sphere.quadric.form == glm::dmat3(1));
    CHECK(sphere.floor == 0.0);
    CHECK_FALSE(sphere.root);
    CHECK(dome.low == glm::dvec2(-1));
    CHECK(dome.high == glm::dvec2(1));
    const Surface saddle = read_surface(examples / "saddle.toml");
    const Quadric& general = std::get<QuadricSurface>(saddle.shape).quadric;
    CHECK(general.form == glm::dmat3(0.3, 0.05, 0, 0.05, -0.2, 0, 0, 0, 0));
    CHECK(general.linear == glm::dvec3(0, 0, -1));
    const Surface hills = read_surface(examples / "hills.toml");
    const auto& patch = std::get<NurbsPatch>(hills.shape);
    CHECK(patch.columns == 6);
    CHECK(patch.rows == 5);
    CHECK(patch.weights[9] == 6);
    CHECK(std::holds_alternative<QuadricSurface>(read_surface(examples / "barrel.toml").shape));
}

TEST_CASE("surface file: every key has its effect") {
    const auto shape = [](const std::string& keys) {
        return std::get<QuadricSurface>(parse_surface(quadric(keys), "s.toml").shape);
    };
    CHECK(shape("shape = \"cylinder\"\nradius = 2\naxis = \"x\"").quadric.form ==
          glm::dmat3(0, 0, 0, 0, 0.25, 0, 0, 0, 0.25));
    CHECK(shape("shape = \"hyperboloid\"\nradius = 1\nsheets = 2").quadric.constant == 1);
    CHECK(shape("shape = \"paraboloid\"\nsemi_axes = [1, 1, -4]").quadric.linear == glm::dvec3(0, 0, -0.25));
    CHECK(shape("shape = \"cone\"\nsemi_axes = [1, 2, 4]\naxis = \"y\"").quadric.form[1][1] == -0.25);
    CHECK(shape("shape = \"sphere\"\nradius = 1\nroot = \"lowest\"").root == Root::lowest);
    CHECK(shape("shape = \"sphere\"\nradius = 1\nroot = \"nearest\"").root == Root::nearest);
    const Surface wide = parse_surface("[domain]\nx = [-2, 5]\n[bezier]\nheights = [[0, 1], [2, 3]]\n", "s.toml");
    CHECK(wide.low == glm::dvec2(-2, -1));
    CHECK(wide.high == glm::dvec2(5, 1));
    const auto& patch = std::get<NurbsPatch>(wide.shape);
    CHECK(patch.degree_u == 1);
    CHECK(patch.weights == std::vector<double>(4, 1.0));
    CHECK(error_of(nurbs()).empty());
    CHECK(error_of(nurbs("weights", "")).empty());
    CHECK(error_of(nurbs("knots_u", "knots_u = [0, 0.5, 1, 2, 3, 4, 5]")).empty());  // not clamped
}

TEST_CASE("surface file: a long row of numbers is not a deep key") {
    std::string row = "[0.5";
    for (int k = 0; k < 30; ++k)
        row += ", 0.5, -1.25e-1, 0.75";
    row += "]";
    const std::string text =
        "[nurbs]\ndegree_u = 1\ndegree_v = 1\nknots_v = [0, 0, 1, 1]\nheights = [\n" + row + ",\n" + row + "]\n";
    std::string knots = "knots_u = [0.0";
    for (int k = 0; k < 91; ++k)
        knots += ", " + std::to_string(k) + ".0";
    CHECK(error_of(text + knots + ", 90.0]\n").empty());
    std::string deep = "a";
    for (int k = 0; k < 100000; ++k)
        deep += ".a";
    CHECK_THAT(error_of(deep + " = 1\n"), Contains("s.toml:1:1: 100000 dots"));
    CHECK_THAT(error_of("b = {c = 1, " + deep + " = 1}\n"), Contains("dots in one line"));
    std::string quoted = "\"a,b\"";
    for (int k = 0; k < 100000; ++k)
        quoted += ".\",\"";
    CHECK_THAT(error_of(quoted + " = 1\n"), Contains("dots in one line"));
}

TEST_CASE("surface file: faults of a quadric are reported with file and line") {
    expect_refusals(
        {
            {"", {"s.toml: there is no surface"}},
            {"[domain]\nx = [0, 1]\n", {"there is no surface"}},
            {"quadric = 3\n", {"s.toml:1:11: `quadric` is 3, an integer; write [quadric]"}},
            {"[quadrics]\n", {"s.toml:1:", "unknown table `quadrics`; did you mean `quadric`?"}},
            {"[quadric\n", {"s.toml:1:", "not TOML"}},
            {quadric("shape = \"sphere\"\nradius = 1\n[bezier]\nheights = [[0, 1], [2, 3]]\n"),
             {"s.toml:4:", "both [quadric] and [bezier] are given"}},
            {quadric(""), {"s.toml:1:1: [quadric] has no `shape`"}},
            {quadric("shape = \"spere\""), {"s.toml:2:9:", "did you mean \"sphere\"?"}},
            {quadric("shape = 1"), {"`shape` is 1, an integer"}},
            {quadric("shape = \"sphere\""), {"[quadric] has no `radius`"}},
            {quadric("shape = \"sphere\"\nradius = -1"),
             {"s.toml:3:10: -1, an integer in `radius`; expected a number, 1e-06 .. 1e+06"}},
            {quadric("shape = \"sphere\"\nradius = 1\nsemi_axes = [1, 1, 1]"), {"s.toml:4:1: unknown key `semi_axes`"}},
            {quadric("shape = \"ellipsoid\"\nradius = 1\nsemi_axes = [1, 1, 1]"),
             {"s.toml:3:10: `radius` and `semi_axes`"}},
            {quadric("shape = \"ellipsoid\"\nsemi_axes = [1, -1, 1]"), {"s.toml:3:17: -1.0 in `semi_axes`"}},
            {quadric("shape = \"paraboloid\"\nsemi_axes = [1, -1, 1]"), {"-1.0 in `semi_axes`"}},
            {quadric("shape = \"paraboloid\"\nsemi_axes = [1, 1, 0]"), {"0.0 in `semi_axes`", "negative"}},
            {quadric("shape = \"ellipsoid\"\nsemi_axes = [1, 1]"), {"an array of 2; expected a list of 3"}},
            {quadric("shape = \"sphere\"\nradius = 1\ncentre = [0, 0, 1e7]"), {"`centre`"}},
            {quadric("shape = \"sphere\"\nradius = 1\ncenter = [0, 0, 1]"), {"s.toml:4:1:", "did you mean `centre`?"}},
            {quadric("shape = \"cone\"\nradius = 1\naxis = \"w\""), {"expected one of x, y, z"}},
            {quadric("shape = \"hyperboloid\"\nradius = 1"), {"has no `sheets`"}},
            {quadric("shape = \"hyperboloid\"\nradius = 1\nsheets = 3"), {"an integer, 1 .. 2"}},
            {quadric("shape = \"general\"\ncoefficients = [1, 2, 3]"), {"a list of 10"}},
            {quadric("shape = \"general\"\ncoefficients = [0, 0, 0, 0, 0, 0, 0, 0, 0, 1]"),
             {"s.toml:3:", "all 0 except the last"}},
            {"[domain]\nx = [1, -1]\n", {"s.toml:2:5: `x` goes from 1.0 to -1.0"}},
            {"[domain]\ny = [1, 1]\n", {"`y` goes from"}},
            {"[domain]\nz = [1, 2]\n", {"unknown key `z` of [domain]"}},
            {std::string(2000000, '#'), {"over 1048576 bytes"}},
        },
        error_of);
    for (const std::string bad : {"0", "nan", "inf", "1e7", "\"one\"", "[1]"})
        CHECK_THAT(error_of(quadric("shape = \"sphere\"\nradius = " + bad)),
                   Contains("s.toml:3:10:") && Contains("`radius`"));
    CHECK_THROWS_WITH(read_surface("nowhere.toml"), Equals("nowhere.toml: no such surface file"));
    CHECK_THROWS_WITH(read_surface("."), Contains("is a folder"));
}

TEST_CASE("surface file: faults of a NURBS patch are reported with file and line") {
    expect_refusals(
        {
            {nurbs("degree_u", ""), {"s.toml:1:1: [nurbs] has no `degree_u`"}},
            {nurbs("degree_u", "degree_u = 0"), {"s.toml:2:12:", "1 .. 32"}},
            {nurbs("degree_u", "degree_u = 33"), {"33, an integer"}},
            {nurbs("degree_u", "degree_u = 4"), {"s.toml:6:11: `heights` has 4 column(s) and `degree_u` = 4 needs 5"}},
            {nurbs("degree_v", "degree_v = 2"), {"`heights` has 2 row(s)"}},
            {nurbs("knots_u", "knots_u = [0, 0, 0, 1, 1, 1]"), {"s.toml:4:11: `knots_u` has 6 knot(s); expected 7"}},
            {nurbs("knots_u", "knots_u = [0, 0, 0, 2, 1, 2, 2]"), {"s.toml:4:24: `knots_u` falls from 2.0 to 1.0"}},
            {nurbs("knots_u", "knots_u = [0, 0, 0, 0, 2, 2, 2]"), {"more than 3 times"}},
            {nurbs("knots_u", "knots_u = [0, 0, 0, 1e-12, 2, 2, 2]"), {"make them the same, or more different"}},
            {nurbs("knots_v", "knots_v = [0, 1, 1, 2]"), {"`knots_v` leaves no range"}},
            {nurbs("knots_u", "knots_u = [0, 0, 0, nan, 2, 2, 2]"), {"s.toml:4:21:"}},
            {nurbs("heights", "heights = []"), {"`heights` is an array of 0"}},
            {nurbs("heights", "heights = [1, 2]"), {"row 1 of `heights` is 1, an integer"}},
            {nurbs("heights", "heights = [[1, 2], [1]]"), {"row 2 of `heights` has 1 number(s) and the first has 2"}},
            {nurbs("heights", "heights = [[0, 1, 2, inf], [4, 5, 6, 7]]"), {"`heights`; expected a number"}},
            {nurbs("weights", "weights = [[1, 1, 1, 1]]"), {"s.toml:7:11: `weights` has 1 row(s) of 4"}},
            {nurbs("weights", "wieghts = [[1]]"), {"did you mean `weights`?"}},
            {"[bezier]\nheights = [[0], [1]]\n", {"s.toml:2:11: `heights` of a Bezier patch has 1 columns"}},
            {"[bezier]\nheights = [[0, 1]]\n", {"has 1 rows"}},
            {"[bezier]\nheights = [[0, 1], [0, 1]]\ndegree_u = 1\n", {"unknown key `degree_u` of [bezier]"}},
        },
        error_of);
    for (const std::string bad : {"0", "-1", "nan", "1e10", "1e-10"})
        CHECK_THAT(error_of(nurbs("weights", "weights = [[1, 1, 1, 1], [1, " + bad + ", 1, 1]]")),
                   Contains("s.toml:7:30:") && Contains("`weights`"));
    // An inner knot may be repeated `degree` times, which gives a crease. Once more would split the surface.
    CHECK(error_of("[nurbs]\ndegree_u = 1\ndegree_v = 1\nknots_u = [0, 0, 1, 2, 2]\nknots_v = [0, 0, 1, "
                   "1]\nheights = [[0, 1, 2], [0, 1, 2]]\n")
              .empty());
    CHECK_THAT(error_of("[nurbs]\ndegree_u = 1\ndegree_v = 1\nknots_u = [0, 0, 1, 1, 2, 2]\nknots_v = [0, 0, 1, 1]\n"
                        "heights = [[0, 1, 2, 3], [0, 1, 2, 3]]\n"),
               Contains("`knots_u` has the knot 1.0 more than 1 times") && Contains("tear"));
}

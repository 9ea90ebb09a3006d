#include "testbench/bake/surface_file.h"

#include <fmt/format.h>

#include "testbench/bake/toml_fields.h"
#include "testbench/common/error.h"
#include "testbench/job/toml_text.h"

namespace tessera {
namespace {

using Range = TomlFields::Range;

constexpr Range coordinate{-largest_displacement, largest_displacement};
constexpr Range length{1e-6, 1e6};
constexpr Range coefficient{-1e12, 1e12};
constexpr Range weight{1e-9, 1e9};
constexpr Range knot{-1e9, 1e9};
constexpr std::int64_t largest_degree = 32;
constexpr double least_span = 1e-9;  // between distinct knots, relative to their whole range

glm::dvec3 vector(const std::vector<double>& numbers) {
    return {numbers[0], numbers[1], numbers[2]};
}

Quadric general_quadric(TomlFields& fields) {
    const std::vector<double> c = fields.numbers("coefficients", 10, coefficient);
    Quadric quadric;
    quadric.form = glm::dmat3(c[0], c[3] / 2, c[4] / 2,  //
                              c[3] / 2, c[1], c[5] / 2,  //
                              c[4] / 2, c[5] / 2, c[2]);
    quadric.linear = {c[6], c[7], c[8]};
    quadric.constant = c[9];
    bool any = false;
    for (std::size_t k = 0; k < 9; ++k)
        any = any || c[k] != 0;
    if (!any)
        fields.fail("coefficients", "`coefficients` are all 0 except the last: no surface has this equation");
    return quadric;
}

/// A radius, or three semi-axes.
glm::dvec3 semi_axes(TomlFields& fields, bool round, int may_be_negative) {
    const bool axes = !round && fields.has("semi_axes");
    if (axes && fields.has("radius"))
        fields.fail("radius", "`radius` and `semi_axes` are both given: remove one");
    if (!axes)
        return glm::dvec3(fields.number("radius", length));
    const glm::dvec3 given = vector(fields.numbers("semi_axes", 3, {-length.high, length.high}));
    for (int k = 0; k < 3; ++k) {
        const double size = k == may_be_negative ? std::abs(given[k]) : given[k];
        if (!(size >= length.low))
            fields.fail(
                "semi_axes", static_cast<std::size_t>(k),
                fmt::format("{} in `semi_axes`; expected a length, {:g} .. {:g}{}", toml_number(given[k]), length.low,
                            length.high, k == may_be_negative ? ", or negative, to open the other way" : ""));
    }
    return given;
}

Quadric named_quadric(TomlFields& fields, const std::string& name) {
    const bool has_axis = name != "sphere" && name != "ellipsoid";
    int axis = 2;
    if (has_axis && fields.has("axis"))
        axis = fields.choice("axis", {"x", "y", "z"})[0] - 'x';
    const glm::dvec3 centre = fields.has("centre") ? vector(fields.numbers("centre", 3, coordinate)) : glm::dvec3(0);
    const glm::dvec3 axes = semi_axes(fields, name == "sphere", name == "paraboloid" ? axis : -1);
    const auto sheets = name == "hyperboloid" ? static_cast<int>(fields.integer("sheets", 1, 2)) : 0;
    const QuadricShape shape = name == "paraboloid"    ? QuadricShape::paraboloid
                               : name == "cone"        ? QuadricShape::cone
                               : name == "cylinder"    ? QuadricShape::cylinder
                               : name == "hyperboloid" ? QuadricShape::hyperboloid
                                                       : QuadricShape::ellipsoid;
    return make_quadric(shape, centre, axes, axis, sheets);
}

QuadricSurface read_quadric(TomlFields& fields) {
    QuadricSurface surface;
    surface.where = fields.where();
    const std::string shape =
        fields.choice("shape", {"sphere", "ellipsoid", "paraboloid", "cone", "cylinder", "hyperboloid", "general"});
    surface.quadric = shape == "general" ? general_quadric(fields) : named_quadric(fields, shape);
    if (fields.has("root")) {
        const std::string root = fields.choice("root", {"highest", "lowest", "nearest"});
        surface.root = root == "highest" ? Root::highest : root == "lowest" ? Root::lowest : Root::nearest;
    }
    if (fields.has("floor"))
        surface.floor = fields.number("floor", coordinate);
    return surface;
}

void check_knots(TomlFields& fields, const char* key, const std::vector<double>& knots, std::size_t degree,
                 std::size_t count, const char* of) {
    if (knots.size() != count + degree + 1)
        fields.fail(key, fmt::format("`{}` has {} knot(s); expected {}: {} {} of heights, degree {}, and 1", key,
                                     knots.size(), count + degree + 1, count, of, degree));
    std::size_t alike = 1;
    const double range = knots.back() - knots.front();
    for (std::size_t k = 1; k < knots.size(); ++k) {
        const double span = knots[k] - knots[k - 1];
        if (span < 0)
            fields.fail(key, k,
                        fmt::format("`{}` falls from {} to {}: knots must not decrease", key, toml_number(knots[k - 1]),
                                    toml_number(knots[k])));
        if (span > 0 && span < least_span * range)
            fields.fail(key, k,
                        fmt::format("`{}` rises from {} to {}, by less than {:g} of its range: make them the "
                                    "same, or more different",
                                    key, toml_number(knots[k - 1]), toml_number(knots[k]), least_span));
        alike = span == 0 ? alike + 1 : 1;
        // At an end degree + 1 equal knots are allowed; in between they would make the patch discontinuous.
        const bool end = knots[k] <= knots[degree] || knots[k] >= knots[count];
        const std::size_t most = end ? degree + 1 : degree;
        if (alike > most)
            fields.fail(
                key, k,
                fmt::format("`{}` has the knot {} more than {} times, {}", key, toml_number(knots[k]), most,
                            end ? "degree + 1, the most at an end" : "the degree; more inside would tear the surface"));
    }
    if (!(knots[degree] < knots[count]))
        fields.fail(key, fmt::format("`{}` leaves no range: its knots {} and {}, {} and {}, must differ", key,
                                     degree + 1, count + 1, toml_number(knots[degree]), toml_number(knots[count])));
}

void read_control_points(TomlFields& fields, NurbsPatch& patch) {
    TomlFields::Rows heights = fields.rows("heights", coordinate);
    patch.columns = heights.columns;
    patch.rows = heights.rows;
    patch.heights = std::move(heights.values);
    patch.weights.assign(patch.heights.size(), 1.0);
    if (!fields.has("weights"))
        return;
    TomlFields::Rows weights = fields.rows("weights", weight);
    if (weights.columns != patch.columns || weights.rows != patch.rows)
        fields.fail("weights", fmt::format("`weights` has {} row(s) of {} and `heights` {} of {}: every height has a "
                                           "weight",
                                           weights.rows, weights.columns, patch.rows, patch.columns));
    patch.weights = std::move(weights.values);
}

NurbsPatch read_nurbs(TomlFields& fields) {
    NurbsPatch patch;
    read_control_points(fields, patch);
    const auto direction = [&](const char* degree_key, const char* knots_key, std::size_t count, const char* of,
                               std::size_t& degree, std::vector<double>& knots) {
        degree = static_cast<std::size_t>(fields.integer(degree_key, 1, largest_degree));
        if (count < degree + 1)
            fields.fail("heights", fmt::format("`heights` has {} {} and `{}` = {} needs {} or more", count, of,
                                               degree_key, degree, degree + 1));
        knots = fields.numbers(knots_key, 0, knot);
        check_knots(fields, knots_key, knots, degree, count, of);
    };
    direction("degree_u", "knots_u", patch.columns, "column(s)", patch.degree_u, patch.knots_u);
    direction("degree_v", "knots_v", patch.rows, "row(s)", patch.degree_v, patch.knots_v);
    return patch;
}

NurbsPatch read_bezier(TomlFields& fields) {
    NurbsPatch patch;
    read_control_points(fields, patch);
    constexpr std::size_t most = largest_degree + 1;
    for (const auto& [count, of] : {std::pair{patch.columns, "columns"}, {patch.rows, "rows"}})
        if (count < 2 || count > most)
            fields.fail("heights",
                        fmt::format("`heights` of a Bezier patch has {} {}; expected 2 .. {}", count, of, most));
    patch.degree_u = patch.columns - 1;
    patch.degree_v = patch.rows - 1;
    patch.knots_u = bezier_knots(patch.degree_u);
    patch.knots_v = bezier_knots(patch.degree_v);
    return patch;
}

void read_domain(TomlFields& fields, Surface& surface) {
    surface.has_domain = true;
    for (const int k : {0, 1}) {
        const char* const key = k == 0 ? "x" : "y";
        if (!fields.has(key))
            continue;
        const std::vector<double> ends = fields.numbers(key, 2, coordinate);
        if (!(ends[1] - ends[0] >= length.low && ends[1] - ends[0] <= length.high))
            fields.fail(key, fmt::format("`{}` goes from {} to {}; expected two ends, the lower first, {:g} .. {:g} "
                                         "apart",
                                         key, toml_number(ends[0]), toml_number(ends[1]), length.low, length.high));
        surface.low[k] = ends[0];
        surface.high[k] = ends[1];
    }
}

}  // namespace

Surface parse_surface(std::string_view text, const std::string& name) {
    const toml::table document = parse_toml(text, name, "a surface file");
    TomlFields top(document, "", name);
    Surface surface;
    std::string shape;
    for (const char* const table : {"domain", "quadric", "nurbs", "bezier"}) {
        if (!top.has(table))
            continue;
        const toml::table* const keys = document.get(table)->as_table();
        if (keys == nullptr)
            top.fail(table,
                     fmt::format("`{0}` is {1}; write [{0}], then its keys", table, found_text(*document.get(table))));
        const std::string label = table;
        TomlFields fields(*keys, label, name);
        if (label == "domain")
            read_domain(fields, surface);
        else if (!shape.empty())
            top.fail(table, fmt::format("both [{}] and [{}] are given: a file describes one surface", shape, label));
        else if (label == "quadric")
            surface.shape = read_quadric(fields);
        else if (label == "nurbs")
            surface.shape = read_nurbs(fields);
        else
            surface.shape = read_bezier(fields);
        if (label != "domain")
            shape = label;
        fields.finish();
    }
    top.finish();
    if (shape.empty())
        throw InputError(fmt::format("{}: there is no surface: write a table [quadric], [nurbs] or [bezier]", name));
    return surface;
}

Surface read_surface(const std::filesystem::path& path) {
    return parse_surface(read_toml_text(path, "surface file"), path.string());
}

}  // namespace tessera

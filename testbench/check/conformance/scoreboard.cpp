#include "testbench/check/conformance/scoreboard.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/triangulate.h"
#include "testbench/check/conformance/mismatch_text.h"

namespace tessera {
namespace {

struct ValueName {
    const char* name;
    const char* unit;
    const char* description;
};
constexpr ValueName value_names[] = {
    {"P_ij", "position LSB", "midpoint of an edge on the base surface"},
    {"(N_i+N_j)/2", "normal LSB", "mean of the ends' normals, before normalising"},
    {"t_ij", "texture LSB", "texture coordinate of the midpoint"},
    {"N_ij", "normal LSB", "base surface's normal at the midpoint"},
    {"T_ij", "normal LSB", "base surface's tangent at the midpoint"},
    {"N'_ij", "normal LSB", "displaced surface's normal at the midpoint"},
    {"P'_ij", "position LSB", "displaced midpoint"},
    {"P's_ij", "screen LSB", "displaced midpoint on the screen, x and y"},
    {"w_ij", "view distance LSB", "displaced midpoint's distance along the view direction"},
    {"P'", "position LSB", "displaced position of a base vertex"},
    {"N'", "normal LSB", "displaced surface's normal at a base vertex"},
    {"P's", "screen LSB", "base vertex on the screen, x and y"},
    {"w", "view distance LSB", "base vertex's distance along the view direction"},
    {"D_ij", "view distance LSB", "displaced midpoint's distance from the eye"},
    {"D", "view distance LSB", "base vertex's distance from the eye"},
};

struct DecisionName {
    const char* name;
    const char* description;
};
constexpr DecisionName decision_names[] = {
    {"NT", "Normal Test"},
    {"SHT", "Summed Height Test or its replacement"},
    {"VT", "View Test"},
    {"TCT", "Tex Coord Test"},
    {"GT", "Generation Test"},
    {"HT", "Highlight Test"},
    {"split", "whether the edge is split"},
    {"cut", "with greatest_rank: which of the edges that request a split is split"},
    {"diagonal", "diagonal of the quadrilateral left by two split edges"},
    {"in_front", "whether a vertex lies in front of the near plane"},
};

bool asks_to_split(const datapath::EdgeTests& edge) {
    return datapath::split_decision(edge.tests);
}

double lsb_per_unit(const datapath::Format& format) {
    return std::ldexp(1.0, format.fraction);
}

}  // namespace

Scoreboard::Scoreboard(const datapath::Registers& registers, const GoldenInputs& inputs)
    : registers_(registers),
      inputs_(inputs),
      dequantise_(registers.formats),
      bounds_(registers.formats),
      per_position_(lsb_per_unit(registers.formats.position)),
      per_normal_(lsb_per_unit(registers.formats.normal)),
      per_texture_(lsb_per_unit(registers.formats.texture)),
      per_screen_(lsb_per_unit(registers.formats.screen)),
      per_view_distance_(lsb_per_unit(registers.formats.view_distance)) {
    static_assert(std::size(value_names) == value_count && std::size(decision_names) == decision_count);
}

void Scoreboard::write(const datapath::TrianglePass& pass) {
    passes_ += pass.told != datapath::Told::midpoints ? 1u : 0u;
    const auto& v = pass.triangle.vertices;
    const std::array<golden::Vertex, 3> given = {dequantise_.vertex(v[0]), dequantise_.vertex(v[1]),
                                                 dequantise_.vertex(v[2])};
    for (int k = 0; k < 3; ++k)
        if ((pass.new_vertices >> k & 1) != 0)
            compare_base_vertex(pass, k, given[static_cast<std::size_t>(k)]);
    for (int k = 0; k < 3; ++k)
        if (pass.told != datapath::Told::midpoints || (pass.split >> k & 1) != 0)
            compare_edge(pass, k, given[static_cast<std::size_t>(k)], given[static_cast<std::size_t>((k + 1) % 3)]);
    if (pass.told != datapath::Told::midpoints && cuts_one_edge())
        compare_cut(pass, given);
    if (pass.told != datapath::Told::tests && (pass.split == 3 || pass.split == 5 || pass.split == 6))
        compare_diagonal(pass, given);
}

void Scoreboard::compare_base_vertex(const datapath::TrianglePass& pass, int k, const golden::Vertex& given) {
    ++base_vertices_;
    const datapath::Vertex& hardware = pass.triangle.vertices[static_cast<std::size_t>(k)];
    const golden::Vertex golden = golden::complete_base_vertex(given, inputs_.map, inputs_.parameters);
    const Context context{&pass, -1, k, nullptr, &golden};

    const MapValue<glm::dvec3> map_normal = map_normal_at(given.texture);
    const golden::Normalised bumped = golden::bump(given.normal, given.tangent, given.handedness, map_normal.value);
    const glm::dvec3 exact(0);
    compare_vector(base_displaced_normal, hardware.displaced_normal, golden.displaced_normal,
                   bounds_.displaced_normal(given.normal, exact, given.tangent, exact, map_normal.value,
                                            map_normal.error, bumped.direction, bumped.length),
                   context);

    const glm::dvec3 bound =
        displaced_bound(given.position, given.texture, given.normal, exact, golden.displaced_position);
    compare_displaced(base_displaced, base_screen, base_w, base_distance, hardware.displaced, hardware.screen, golden,
                      bound, context);
}

void Scoreboard::compare_edge(const datapath::TrianglePass& pass, int k, const golden::Vertex& i,
                              const golden::Vertex& j) {
    const datapath::NewVertex& made = pass.new_vertex[static_cast<std::size_t>(k)];
    const datapath::EdgeTests& tested = pass.edges[static_cast<std::size_t>(k)];
    const golden::EdgeEvaluation golden = golden::evaluate_edge(i, j, inputs_.map, inputs_.parameters);
    const golden::Insertion& inserted = golden.inserted;
    const golden::Vertex& m = inserted.vertex;
    const Context context{&pass, k, -1, &golden, &m};
    const datapath::Formats& formats = registers_.formats;

    const glm::dvec3 mean_normal = (i.normal + j.normal) / 2.0;
    const glm::dvec3 n_bound = bounds_.inserted_direction(mean_normal, m.normal, inserted.mean_normal_length);
    const glm::dvec3 t_bound =
        bounds_.inserted_direction((i.tangent + j.tangent) / 2.0, m.tangent, inserted.mean_tangent_length);
    const MapValue<glm::dvec3> map_normal = map_normal_at(m.texture);
    const glm::dvec3 bumped_bound =
        bounds_.displaced_normal(m.normal, n_bound, m.tangent, t_bound, map_normal.value, map_normal.error,
                                 m.displaced_normal, inserted.bump_length);
    // Each of the six differences has N'_ij's error, plus the rounding of the subtraction in double precision.
    const double leeway = std::max({bumped_bound.x, bumped_bound.y, bumped_bound.z}) + 0x1p-50;
    const bool near_threshold = inputs_.parameters.enabled.normal &&
                                std::abs(golden.normal_difference - inputs_.parameters.normal_threshold) <= leeway;
    const bool split = (pass.split >> k & 1) != 0;  // with greatest_rank, one of the edges that request it
    const bool tests_told = pass.told != datapath::Told::midpoints, midpoint_told = pass.told != datapath::Told::tests;
    if (tests_told && (pass.triangle.final_edges >> k & 1) != 0) {
        // Tested with the parent, from the same ends. Would golden split it without the tests that may flip?
        const bool asked = (golden.normal_test && !near_threshold) || golden.summed_height_test ||
                           (golden.highlight_test && !highlight_may_flip(golden, bumped_bound, leeway));
        decide(split_decision, split, golden.split, !asked, context);
        return;
    }
    edges_ += tests_told && (pass.shared >> k & 1) == 0 ? 1u : 0u;

    const auto midpoint = [&](std::int64_t hardware, double value, char component) {
        compare(inserted_position, hardware, value, bounds_.position_midpoint(), formats.position, per_position_,
                component, context);
    };
    if (midpoint_told) {
        midpoint(made.position.x, m.position.x, 'x');
        midpoint(made.position.y, m.position.y, 'y');
        midpoint(made.position.z, m.position.z, 'z');
    }
    const auto mean = [&](std::int64_t hardware, double value, char component) {
        compare(inserted_mean_normal, hardware, value, bounds_.direction_midpoint(), formats.normal, per_normal_,
                component, context);
    };
    if (pass.told == datapath::Told::all) {
        mean(made.mean_normal.x, mean_normal.x, 'x');
        mean(made.mean_normal.y, mean_normal.y, 'y');
        mean(made.mean_normal.z, mean_normal.z, 'z');
    }
    const auto texture = [&](const datapath::TexCoord& t) {
        compare(inserted_texture, t.u, m.texture.x, bounds_.texture_midpoint(), formats.texture, per_texture_, 'u',
                context);
        compare(inserted_texture, t.v, m.texture.y, bounds_.texture_midpoint(), formats.texture, per_texture_, 'v',
                context);
    };
    // Both branches calculate t_ij.
    if (midpoint_told)
        texture(made.texture);
    if (tests_told)
        texture(tested.texture);

    const auto evaluated = [&](datapath::TestBits bit) { return (tested.evaluated & bit) != 0; };
    if (evaluated(datapath::normal_bit) || split) {
        compare_vector(inserted_normal, tested.normal, m.normal, n_bound, context);
        compare_vector(inserted_tangent, tested.tangent, m.tangent, t_bound, context);
        compare_vector(inserted_displaced_normal, tested.displaced_normal, m.displaced_normal, bumped_bound, context);
    }

    bool flipped = midpoint_told &&
                   compare_displaced(
                       inserted_displaced, inserted_screen, inserted_w, inserted_distance, made.displaced, made.screen,
                       m, displaced_bound(m.position, m.texture, m.normal, n_bound, m.displaced_position), context);
    if (!tests_told) {
        flipped_edges_ += flipped ? 1 : 0;
        return;
    }

    const auto says = [&](datapath::TestBits bit) { return (tested.tests & bit) != 0; };
    const bool normal_flipped = evaluated(datapath::normal_bit) && decide(normal_decision, says(datapath::normal_bit),
                                                                          golden.normal_test, near_threshold, context);
    const bool highlight_flipped = evaluated(datapath::highlight_bit) && inputs_.parameters.enabled.highlight &&
                                   decide(highlight_decision, says(datapath::highlight_bit), golden.highlight_test,
                                          highlight_may_flip(golden, bumped_bound, leeway), context);
    flipped = flipped || normal_flipped || highlight_flipped;
    if (evaluated(datapath::summed_height_bit))
        decide(summed_height_decision, says(datapath::summed_height_bit), golden.summed_height_test, false, context);
    decide(view_decision, says(datapath::view_bit), golden.view_test, false, context);
    decide(tex_coord_decision, says(datapath::tex_coord_bit), golden.tex_coord_test, false, context);
    decide(generation_decision, says(datapath::generation_bit), golden.generation_test, false, context);

    // If NT or HT flipped, the decision that follows from the hardware's result; it may equal golden's.
    const bool asked =
        golden.normal_test != normal_flipped || golden.summed_height_test || golden.highlight_test != highlight_flipped;
    const bool follows = asked && golden.view_test && golden.tex_coord_test && golden.generation_test;
    const bool asks = cuts_one_edge() ? asks_to_split(tested) : split;
    decide(split_decision, asks, asks == follows ? golden.split : follows, asks == follows, context);
    flipped_edges_ += flipped ? 1 : 0;
}

glm::dvec3 Scoreboard::displaced_bound(const glm::dvec3& p, const glm::dvec2& t, const glm::dvec3& n,
                                       const glm::dvec3& n_error, const glm::dvec3& displaced) const {
    const golden::Parameters& parameters = inputs_.parameters;
    const golden::Filter filter = parameters.filter;
    MapValue<double> code{inputs_.map.code(t, filter)};
    if (filter != golden::Filter::nearest)
        code.error = bounds_.code(code.value, inputs_.map.code(bounds_.read_at(t), filter));
    return bounds_.displaced_position(p, parameters.scale * code.value + parameters.bias,
                                      std::abs(parameters.scale) * code.error, n, n_error, displaced);
}

Scoreboard::MapValue<glm::dvec3> Scoreboard::map_normal_at(const glm::dvec2& t) const {
    const golden::Filter filter = inputs_.parameters.filter;
    MapValue<glm::dvec3> normal{inputs_.map.normal(t, filter)};
    if (filter != golden::Filter::nearest)
        normal.error = bounds_.map_normal(normal.value, inputs_.map.normal(bounds_.read_at(t), filter));
    return normal;
}

bool Scoreboard::highlight_may_flip(const golden::EdgeEvaluation& golden, const glm::dvec3& normal_bound,
                                    double difference_leeway) const {
    const golden::Parameters& parameters = inputs_.parameters;
    const double leeway = bounds_.cosine(golden.inserted.vertex.displaced_normal, normal_bound, parameters.half_vector);
    // `must`: true even for the least values within the error bounds; `may`: true for the greatest.
    const auto in_highlight = [&](double midpoint_cosine) {
        return std::max(golden.end_cosine, midpoint_cosine) > parameters.highlight_cosine;
    };
    const auto differ = [&](double difference) { return difference > parameters.highlight_normal_threshold; };
    const bool must =
        in_highlight(golden.midpoint_cosine - leeway) && differ(golden.normal_difference - difference_leeway);
    const bool may =
        in_highlight(golden.midpoint_cosine + leeway) && differ(golden.normal_difference + difference_leeway);
    return may && !must;
}

void Scoreboard::compare_cut(const datapath::TrianglePass& pass, const std::array<golden::Vertex, 3>& given) {
    std::array<bool, 3> asks{}, cut{};
    std::array<int, 3> order{};
    for (std::size_t k = 0; k < 3; ++k) {
        asks[k] = (pass.triangle.final_edges >> k & 1) == 0 && asks_to_split(pass.edges[k]);
        cut[k] = (pass.split >> k & 1) != 0;
        order[k] = golden::evaluate_edge(given[k], given[(k + 1) % 3], inputs_.map, inputs_.parameters).order;
    }
    const bool same = cut == golden::edge_to_cut(asks, given, order);
    decide(cut_decision, true, same, false, Context{&pass, -1, -1, nullptr, nullptr});
}

void Scoreboard::compare_diagonal(const datapath::TrianglePass& pass, const std::array<golden::Vertex, 3>& given) {
    const auto hardware_corner = [&](std::uint8_t index) -> const datapath::Position& {
        return index < 3 ? pass.triangle.vertices[index].displaced : pass.new_vertex[index - 3u].displaced;
    };
    const bool second = datapath::choose_second_diagonal(pass.split, registers_.triangulation, hardware_corner);
    const datapath::ChildIndices hardware = datapath::triangulate(pass.split, second);

    std::array<golden::Vertex, 6> corners;
    std::array<bool, 3> split{};
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = given[k];
        corners[3 + k].displaced_position = dequantise_.position(pass.new_vertex[k].displaced);
        split[k] = (pass.split >> k & 1) != 0;
    }
    const golden::Subdivision golden = golden::subdivide(split, corners, inputs_.parameters.diagonal);

    // Both list the cut-off corner first, then the quadrilateral's halves; a triangle may start at any corner.
    const auto same_triangle = [](const std::array<std::uint8_t, 3>& a, const std::array<int, 3>& b) {
        for (std::size_t turn = 0; turn < 3; ++turn)
            if (a[0] == b[turn] && a[1] == b[(turn + 1) % 3] && a[2] == b[(turn + 2) % 3])
                return true;
        return false;
    };
    bool same = hardware.count == golden.count;
    for (std::size_t k = 0; same && k < static_cast<std::size_t>(golden.count); ++k)
        same = same_triangle(hardware.children[k], golden.children[k]);
    decide(diagonal_decision, second, same ? second : !second, false, Context{&pass, -1, -1, nullptr, nullptr});
}

bool Scoreboard::compare_displaced(Value position, Value screen, Value w, Value distance,
                                   const datapath::Position& displaced, const datapath::ScreenPosition& on_screen,
                                   const golden::Vertex& golden, const glm::dvec3& position_bound,
                                   const Context& context) {
    const datapath::Formats& formats = registers_.formats;
    const auto compare_position = [&](std::int64_t hardware, double value, double bound, char component) {
        compare(position, hardware, value, Interval::within(bound), formats.position, per_position_, component,
                context);
    };
    compare_position(displaced.x, golden.displaced_position.x, position_bound.x, 'x');
    compare_position(displaced.y, golden.displaced_position.y, position_bound.y, 'y');
    compare_position(displaced.z, golden.displaced_position.z, position_bound.z, 'z');

    // If P' does not fit its format the hardware saturates it; so does golden.
    const glm::dvec3 lowest(static_cast<double>(formats.position.lowest) / per_position_);
    const glm::dvec3 highest(static_cast<double>(formats.position.highest) / per_position_);
    golden::Vertex fitting;
    const golden::Vertex* seen = &golden;
    if (glm::any(glm::lessThan(golden.displaced_position, lowest)) ||
        glm::any(glm::greaterThan(golden.displaced_position, highest))) {
        fitting.position = glm::clamp(golden.displaced_position, lowest, highest);
        fitting = golden::complete_base_vertex(fitting, inputs_.map, inputs_.parameters);  // N = 0: P' = P
        seen = &fitting;
    }

    const ErrorBounds::Screen bound =
        bounds_.screen(inputs_.parameters, seen->displaced_position, position_bound, seen->w, seen->screen);
    compare(w, on_screen.w, seen->w, Interval::within(bound.w), formats.view_distance, per_view_distance_, 'w',
            context);
    if (formats.distances)
        compare(distance, on_screen.distance, seen->distance, bounds_.distance(position_bound, seen->distance),
                datapath::Format::make_unsigned(formats.view_distance.bits, formats.view_distance.fraction),
                per_view_distance_, 'D', context);
    const bool near_plane_in_reach = std::abs(seen->w - inputs_.parameters.near_plane) <= bound.near_plane;
    const bool flipped = decide(in_front_decision, on_screen.in_front, seen->in_front, near_plane_in_reach, context);
    if (!on_screen.in_front) {
        if (on_screen.x != 0 || on_screen.y != 0)
            mismatch(fmt::format("{}: a vertex not in front of the near plane has the screen position {}, {}",
                                 value_names[screen].name, on_screen.x, on_screen.y),
                     context);
    } else if (seen->in_front) {
        compare(screen, on_screen.x, seen->screen.x, Interval::within(bound.x), formats.screen, per_screen_, 'x',
                context);
        compare(screen, on_screen.y, seen->screen.y, Interval::within(bound.y), formats.screen, per_screen_, 'y',
                context);
    }
    return flipped;
}

void Scoreboard::compare_vector(Value value, const datapath::Direction& hardware, const glm::dvec3& golden,
                                const glm::dvec3& bound, const Context& context) {
    const datapath::Format& format = registers_.formats.normal;
    compare(value, hardware.x, golden.x, Interval::within(bound.x), format, per_normal_, 'x', context);
    compare(value, hardware.y, golden.y, Interval::within(bound.y), format, per_normal_, 'y', context);
    compare(value, hardware.z, golden.z, Interval::within(bound.z), format, per_normal_, 'z', context);
}

void Scoreboard::compare(Value value, std::int64_t hardware, double golden, const Interval& bound,
                         const datapath::Format& format, double per_unit, char component, const Context& context) {
    const auto lowest = static_cast<double>(format.lowest), highest = static_cast<double>(format.highest);
    const double fitting = std::clamp(golden * per_unit, lowest, highest);
    const double error = static_cast<double>(hardware) - fitting;
    // No error exceeds the format's range; keeps bounds finite at the near plane.
    const double range = highest - lowest;
    const double low = std::max(bound.low * per_unit, -range);
    const double high = std::min(bound.high * per_unit, range);
    const double size = std::abs(error);
    const double limit = error < 0 ? -low : high;

    ValueStatistics& statistics = values_[value];
    ++statistics.count;
    statistics.squares += error * error;
    statistics.max_error = std::max(statistics.max_error, size);
    statistics.max_bound = std::max({statistics.max_bound, -low, high});
    if (size <= limit) {  // false for a golden value that is not a number
        if (size > statistics.worst_ratio * limit)
            statistics.worst_ratio = size / limit;
        return;
    }
    statistics.worst_ratio = std::max(statistics.worst_ratio, limit > 0 ? size / limit : size);
    ++statistics.outside;
    mismatch(fmt::format("{}.{}: hardware {}, golden {:.6f} (saturated {:.6f}), difference {:.6f}, allowed {:.6f} "
                         "to {:.6f} {}",
                         value_names[value].name, component, hardware, golden * per_unit, fitting, error, low, high,
                         value_names[value].unit),
             context);
}

bool Scoreboard::decide(Decision decision, bool hardware, bool golden, bool flip_allowed, const Context& context) {
    DecisionStatistics& statistics = decisions_[decision];
    ++statistics.compared;
    if (hardware == golden) {
        ++statistics.agreed;
        return false;
    }
    if (flip_allowed) {
        ++statistics.allowed_flips;
        return true;
    }
    ++statistics.mismatches;
    mismatch(fmt::format("{} ({}): hardware {}, golden {}", decision_names[decision].name,
                         decision_names[decision].description, hardware, golden),
             context);
    return false;
}

void Scoreboard::mismatch(const std::string& what, const Context& context) {
    ++mismatches_;
    if (first_mismatch_.empty())
        first_mismatch_ = mismatch_text(what, registers_, inputs_.parameters, *context.pass, context.edge,
                                        context.vertex, context.evaluation, context.completed);
}

ConformanceResult Scoreboard::result() const {
    ConformanceResult result;
    for (std::size_t k = 0; k < value_count; ++k) {
        if ((k == inserted_distance || k == base_distance) && !registers_.formats.distances)
            continue;
        const ValueStatistics& s = values_[k];
        const double rms = s.count == 0 ? 0 : std::sqrt(s.squares / static_cast<double>(s.count));
        result.quantities.push_back({value_names[k].name, value_names[k].unit, value_names[k].description, s.count,
                                     s.outside, s.max_error, rms, s.max_bound, s.worst_ratio});
    }
    for (std::size_t k = 0; k < decision_count; ++k) {
        if ((k == highlight_decision && !inputs_.parameters.enabled.highlight) ||
            (k == cut_decision && !cuts_one_edge()))
            continue;
        const DecisionStatistics& s = decisions_[k];
        result.tests.push_back({decision_names[k].name, decision_names[k].description, s.compared, s.agreed,
                                s.allowed_flips, s.mismatches});
    }
    result.passes = passes_;
    result.edges = edges_;
    result.base_vertices = base_vertices_;
    result.flipped_edges = flipped_edges_;
    result.mismatches = mismatches_;
    result.first_mismatch = first_mismatch_;
    return result;
}

}  // namespace tessera

#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "modules/datapath/intermediate.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/multiplications.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/rectangle.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// Bits of the Summed Height Test's threshold: at most 2^50, with `area` 2^18.
inline constexpr int summed_height_threshold_bits = 51, area_threshold_bits = 19;

struct EdgeTestWidths : Intermediates {
    using Intermediates::Intermediates;
    Width normal{"NT, HT: a difference of components", f.normal.bits};
    Width sums{"SHT: S_i + S_j, 2 S_ij and their difference", f.summed_height.bits + 1};
    Width area{"SHT: width * height", RectangleWidths{f}.width.bits + RectangleWidths{f}.height.bits};
    Width limit{"SHT: threshold * area", wider(summed_height_threshold_bits, area.bits + 17)};
    Width screen{"VT: abs(dx), abs(dy)", f.screen.bits};
    Width length{"VT: abs(dx) + abs(dy)", screen.bits + 1};
    Width index{"TCT: compared parts", f.texture.bits - f.texture.fraction + f.tex_coord_fraction};
    Width product{"HT: N'.x * H.x", 2 * f.normal.bits};
    Width cosine{"HT: N' . H", product.bits + 1};
    constexpr auto all() const { return std::array{normal, sums, area, limit, screen, length, index, product, cosine}; }
};
static_assert(fits_every_format<EdgeTestWidths>());

/// Absolute difference of two integers of up to 62 bits.
constexpr std::uint64_t absolute_difference(std::int64_t a, std::int64_t b) {
    return static_cast<std::uint64_t>(a > b ? a - b : b - a);
}

/// The largest of the six component differences of N'_ij from N'_i and N'_j.
constexpr std::uint64_t largest_difference(const Direction& i, const Direction& j, const Direction& ij) {
    const std::uint64_t x = std::max(absolute_difference(ij.x, i.x), absolute_difference(ij.x, j.x));
    const std::uint64_t y = std::max(absolute_difference(ij.y, i.y), absolute_difference(ij.y, j.y));
    const std::uint64_t z = std::max(absolute_difference(ij.z, i.z), absolute_difference(ij.z, j.z));
    return std::max({x, y, z});
}

/// Whether any component of N'_ij differs from N'_i's or N'_j's by more than the threshold (normal's format).
constexpr bool normals_differ(const Direction& i, const Direction& j, const Direction& ij, std::uint64_t threshold) {
    return absolute_difference(ij.x, i.x) > threshold || absolute_difference(ij.y, i.y) > threshold ||
           absolute_difference(ij.z, i.z) > threshold || absolute_difference(ij.x, j.x) > threshold ||
           absolute_difference(ij.y, j.y) > threshold || absolute_difference(ij.z, j.z) > threshold;
}

/// NT (paper 2.2): six absolute differences, six compares, one OR.
constexpr bool normal_test(const Direction& i, const Direction& j, const Direction& ij,
                           const TestParameters& parameters) {
    return normals_differ(i, j, ij, parameters.normal_threshold);
}

/// Whether a displaced normal lies in the Phong highlight: N' . H above the cosine. Three products, two sums, one
/// compare, exact: sum and register have twice the normal's fraction bits.
constexpr bool in_highlight(const Direction& n, const TestParameters& parameters) {
    const auto& h = parameters.half_vector;
    const std::int64_t cosine = std::int64_t{n.x} * h[0] + std::int64_t{n.y} * h[1] + std::int64_t{n.z} * h[2];
    return cosine > parameters.highlight_cosine;
}

/// HT (paper 5.1, golden/ALGORITHM.md 4.6): one of the edge's three displaced normals lies in the highlight, and they
/// differ by more than a threshold finer than NT's. Uses NT's six differences; adds six compares, three dot products.
/// All edges of a vertex agree on whether its N' lies in the highlight.
/// (Decision: the paper gives no formula. Without the difference every edge in the highlight would split down to the
/// map's texels, also of a flat patch, which its corners light correctly. A highlight between the three points is
/// missed.)
constexpr bool highlight_test(const Direction& i, const Direction& j, const Direction& ij,
                              const TestParameters& parameters) {
    return normals_differ(i, j, ij, parameters.highlight_normal_threshold) &&
           (in_highlight(i, parameters) || in_highlight(j, parameters) || in_highlight(ij, parameters));
}

/// SHT's left operand: | 2 S_ij - (S_i + S_j) |.
constexpr std::uint64_t summed_height_difference(std::uint64_t sum_i, std::uint64_t sum_j, std::uint64_t sum_ij) {
    const auto ends = static_cast<std::int64_t>(sum_i + sum_j);
    return absolute_difference(static_cast<std::int64_t>(2 * sum_ij), ends);
}

/// SHT's right operand: the threshold; with `area` the threshold is a height and is multiplied by width * height.
constexpr std::uint64_t summed_height_limit(const RectangleSize& size, const TestParameters& parameters) {
    return parameters.summed_height_unit == SummedHeightUnit::sum
               ? parameters.height_threshold()
               : parameters.height_threshold() * size.width * size.height;
}

/// SHT (paper 2.3): | S_ij / 2 - (S_i + S_j) / 4 | > threshold. Both sides are multiplied by 4, which is only wiring
/// and avoids the rounding of the divisions.
constexpr bool summed_height_test(std::uint64_t sum_i, std::uint64_t sum_j, std::uint64_t sum_ij,
                                  const RectangleSize& size, const TestParameters& parameters) {
    return summed_height_difference(sum_i, sum_j, sum_ij) > summed_height_limit(size, parameters);
}

/// Manhattan length on the screen, in the screen's format, of an edge whose ends both have a screen position.
constexpr std::uint64_t screen_length(const ScreenPosition& i, const ScreenPosition& j) {
    return absolute_difference(i.x, j.x) + absolute_difference(i.y, j.y);
}

/// VT (paper 2.4): Manhattan length in pixels. A vertex on or behind the near plane has no screen position: an edge
/// with one such end counts as long, with two such ends as invisible (golden/ALGORITHM.md 4.3).
constexpr bool view_test(const ScreenPosition& i, const ScreenPosition& j, const TestParameters& parameters) {
    if (i.in_front && j.in_front)
        return screen_length(i, j) > parameters.view_threshold;
    return i.in_front || j.in_front;
}

/// TCT (paper 2.5): false if t_ij lies in the same texel as t_i or t_j, so that the map's resolution is reached; with
/// tex_coord_fraction bits in the same half or quarter of a texel, on both axes. A bit slice.
constexpr bool tex_coord_test(const TexCoord& i, const TexCoord& j, const TexCoord& ij, const Formats& formats) {
    const int shift = formats.texture.fraction - formats.tex_coord_fraction;
    const auto same = [shift](const TexCoord& a, const TexCoord& b) {
        return a.u >> shift == b.u >> shift && a.v >> shift == b.v >> shift;
    };
    return !(same(ij, i) || same(ij, j));
}

/// Generation of a vertex inserted on (i, j): the greater of the ends' plus one, at most 255 (reached only with GT
/// switched off, an experiment in which nothing depends on generations): wider than its wires.
constexpr std::uint8_t inserted_generation(std::uint8_t generation_i, std::uint8_t generation_j) {
    const std::uint8_t oldest = generation_i > generation_j ? generation_i : generation_j;
    return oldest == 255 ? oldest : static_cast<std::uint8_t>(oldest + 1);
}

/// GT (golden/ALGORITHM.md 4.5): the inserted vertex does not exceed the generation limit. Depends on the edge alone;
/// terminates the recursion.
constexpr bool generation_test(std::uint8_t generation_i, std::uint8_t generation_j, const TestParameters& parameters) {
    return inserted_generation(generation_i, generation_j) <= parameters.generation_limit;
}

/// split(i, j) = (NT or SHT or HT) and VT and TCT and GT (paper 2.6, plus HT and GT). `tests`: TestBits.
constexpr bool split_decision(std::uint8_t tests) {
    return (tests & requesting_tests) != 0 && (tests & gating_tests) == gating_tests;
}

inline Multiplications highlight_test_multiplications(const Formats& f) {
    return Multiplications().add(9, f.normal.bits, f.normal.bits);
}

/// With the area threshold; the sum threshold needs none.
inline Multiplications summed_height_limit_multiplications(const Formats& f) {
    const RectangleWidths r{f};
    return Multiplications()
        .add(1, r.width.bits, r.height.bits)
        .add(1, area_threshold_bits, EdgeTestWidths{f}.area.bits);
}

}  // namespace tessera::datapath

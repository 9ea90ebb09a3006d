#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/height_test.h"
#include "modules/datapath/intermediate.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/multiplications.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// The Curvature Table's entry for a square with sides of 2^l texels, l its level: how far the midpoint of an edge of
/// 2^l texels deviates from the chord, (xx u u + xy u v + yy v v) for the edge (u, v) * 2^l, and how far the map
/// deviates from that quadratic on average. In units of 2^(exponent - curvature_fraction) codes.
struct CurvatureEntry {
    std::uint8_t exponent = 0;            ///< 4 bits
    std::int32_t xx = 0, xy = 0, yy = 0;  ///< signed 8 bits each
    std::uint32_t rest = 0;               ///< 8 bits: root of the mean squared error of the quadratic
};

/// Exponent 0 stands for 1/8 of a code, exponent 15 for 2^12 codes: 127 units are then more than any map can have.
inline constexpr int curvature_fraction = 3;
inline constexpr int largest_curvature_exponent = 15;
inline constexpr int curvature_entry_bits = 36;
/// Levels of tables. Edges of at most two texels, level 1, read none.
inline constexpr int least_curvature_level = 2;

/// Packed, the exponent lowest, then xx, xy, yy, rest.
constexpr std::uint64_t pack_curvature(const CurvatureEntry& entry) {
    const auto byte = [](std::int32_t value) { return static_cast<std::uint64_t>(value) & 0xff; };
    return entry.exponent | byte(entry.xx) << 4 | byte(entry.xy) << 12 | byte(entry.yy) << 20 |
           std::uint64_t{entry.rest} << 28;
}
constexpr CurvatureEntry unpack_curvature(std::uint64_t packed) {
    const auto at = [&](int place) { return static_cast<std::uint8_t>(packed >> place); };
    const auto signed_at = [&](int place) { return std::int32_t{at(place)} - (at(place) >= 128 ? 256 : 0); };
    return {static_cast<std::uint8_t>(packed & 15), signed_at(4), signed_at(12), signed_at(20), at(28)};
}

struct CurvatureWidths : Intermediates {
    using Intermediates::Intermediates;
    int longest = f.texture.bits - f.texture.fraction;  // the highest level an edge may have
    Width difference{"abs(du), abs(dv)", f.texture.bits};
    Width eighths{"8 abs(du)", f.texture.bits + 3};
    Width step{"u, v: 8 abs(du) / 2^level", 4};
    Width product{"u u, u v, v v", 7};
    Width bend{"xx u u + xy u v + yy v v", 8 + 7 + 1};
    Width deviation{"abs of that / 64, combined with the rest", 9};
    Width measure{"that * 2^(exponent + level)", deviation.bits + largest_curvature_exponent + longest};
    Width codes{"8 abs(2 d_ij - d_i - d_j)", f.displacement.bits + 1 + curvature_fraction};
    constexpr auto all() const {
        return std::array{difference, eighths, step, product, bend, deviation, measure, codes};
    }
};
static_assert(fits_every_format<CurvatureWidths>());

/// Bits of the Curvature Test's threshold: those of the measure it is compared with.
constexpr int curvature_threshold_bits(const Formats& formats) {
    return CurvatureWidths{formats}.measure.bits;
}

/// Level of an edge: the least l >= 1 such that neither |du| nor |dv| exceeds 2^l texels. Rounded up: a square of 2^l
/// texels about its midpoint then holds the edge.
constexpr int curvature_level(const TexCoord& i, const TexCoord& j, const Formats& formats) {
    const std::uint64_t length = std::max(absolute_difference(i.u, j.u), absolute_difference(i.v, j.v));
    int level = 1;
    while (length > std::uint64_t{1} << (level + formats.texture.fraction))
        ++level;
    return level;
}

/// The highest level of a table: the least at which 2^l texels hold all that it covers. Longer edges read this level.
/// covered: the map, or more texels if it clamps and the base mesh extends beyond it.
constexpr int highest_curvature_level(const MapGeometry& covered) {
    int level = least_curvature_level;
    while (std::max(covered.width, covered.height) > std::uint32_t{1} << level)
        ++level;
    return level;
}

/// Cells of one level: one every 2^(l - 1) texels, the first about texel 0, to the one nearest to the last texel.
struct CurvatureCells {
    std::uint32_t columns = 0, rows = 0;
    std::uint64_t first_entry = 0;  ///< entries of the lower levels, which lie before these
};

/// The number of the cell nearest to a texel; of two equally near the higher.
constexpr std::uint32_t curvature_cell(std::uint32_t texel, int level) {
    return (texel + (std::uint32_t{1} << (level - 2))) >> (level - 1);
}

constexpr CurvatureCells curvature_cells(int level, const MapGeometry& covered) {
    CurvatureCells cells;
    for (int l = least_curvature_level;; ++l) {
        cells.columns = curvature_cell(covered.width - 1, l) + 1;
        cells.rows = curvature_cell(covered.height - 1, l) + 1;
        if (l == level)
            return cells;
        cells.first_entry += std::uint64_t{cells.columns} * cells.rows;
    }
}

/// The number of entries of all levels.
constexpr std::uint64_t curvature_entries(const MapGeometry& covered) {
    const CurvatureCells last = curvature_cells(highest_curvature_level(covered), covered);
    return last.first_entry + std::uint64_t{last.columns} * last.rows;
}

/// Byte address of the entry for an edge with midpoint t_ij, level >= 2: that of the cell nearest to the midpoint's
/// texel. base: that of the table. The cells of each level are constants of the table.
constexpr std::uint64_t curvature_address(const TexCoord& ij, int level, std::uint64_t base, const MapGeometry& covered,
                                          const Formats& formats) {
    const int read = std::min(level, highest_curvature_level(covered));
    const CurvatureCells cells = curvature_cells(read, covered);
    const auto cell = [&](std::uint32_t coordinate, std::uint32_t size, AddressMode mode) {
        return curvature_cell(texel_index(integer_part(coordinate, formats), size, mode), read);
    };
    const std::uint64_t row = cell(ij.v, covered.height, covered.address_v);
    const std::uint64_t entry = cells.first_entry + row * cells.columns + cell(ij.u, covered.width, covered.address_u);
    return base + entry * entry_bytes(curvature_entry_bits);
}

/// The Curvature Test's left operand, level >= 2, in 1/8 codes times 2^level (the level weights by length, as a sum of
/// heights would). deviation: of the quadratic and of the rest, as the longer side of a right triangle plus half the
/// shorter. Three products of 4 x 4 bits, three of 8 x 7; absolute values and the product of signs make it symmetric.
constexpr std::uint64_t curvature_measure(const CurvatureEntry& entry, const TexCoord& i, const TexCoord& j, int level,
                                          const Formats& formats) {
    const auto step = [&](std::uint32_t a, std::uint32_t b) {
        return static_cast<std::int32_t>(absolute_difference(a, b) << 3 >> (level + formats.texture.fraction));
    };
    const std::int32_t u = step(i.u, j.u), v = step(i.v, j.v);
    const std::int32_t xy = (i.u < j.u) == (i.v < j.v) ? entry.xy : -entry.xy;
    const std::int32_t bend = entry.xx * (u * u) + xy * (u * v) + entry.yy * (v * v);
    const std::uint64_t bent = static_cast<std::uint64_t>(bend < 0 ? -bend : bend) >> 6;
    const std::uint64_t deviation =
        std::max<std::uint64_t>(bent, entry.rest) + (std::min<std::uint64_t>(bent, entry.rest) >> 1);
    return deviation << (entry.exponent + level);
}

/// The left operand at level 1, from the codes of the edge's three vertices: |2 d_ij - d_i - d_j| in 1/8 codes.
constexpr std::uint64_t curvature_measure_of_codes(std::uint32_t i, std::uint32_t j, std::uint32_t ij) {
    return absolute_difference(2 * std::int64_t{ij}, std::int64_t{i} + j) << curvature_fraction;
}

/// Whether the test reads the three codes instead of the table.
constexpr bool curvature_by_codes(const TexCoord& i, const TexCoord& j, const Formats& formats) {
    return curvature_level(i, j, formats) < least_curvature_level;
}

/// The addresses read for an edge: those of three codes, or of one entry.
template <class Visit>
constexpr void curvature_reads(const TexCoord& i, const TexCoord& j, const TexCoord& ij, const Registers& r,
                               Visit&& visit) {
    const int level = curvature_level(i, j, r.formats);
    if (level < least_curvature_level)
        for (const TexCoord& t : {i, j, ij})
            visit(texel_address(t, r.displacement_map, r.map, r.formats));
    else
        visit(curvature_address(ij, level, r.height_table.base, covered_texels(r), r.formats));
}

/// The measure, from the entries read.
constexpr std::uint64_t curvature_of_entries(const TexCoord& i, const TexCoord& j, const Entries& read,
                                             const Formats& formats) {
    const int level = curvature_level(i, j, formats);
    const auto code = [&](std::size_t k) { return static_cast<std::uint32_t>(read[k]); };
    return level < least_curvature_level ? curvature_measure_of_codes(code(0), code(1), code(2))
                                         : curvature_measure(unpack_curvature(read[0]), i, j, level, formats);
}

/// CT: the measure is above the threshold.
constexpr bool curvature_test(std::uint64_t measure, const TestParameters& parameters) {
    return measure > parameters.height_threshold();
}

inline Multiplications curvature_measure_multiplications(const Formats& f) {
    const CurvatureWidths w{f};
    constexpr int coefficient = 8;
    return Multiplications().add(3, w.step.bits, w.step.bits).add(3, coefficient, w.product.bits);
}

/// Curvature Test, in place of the Summed Height Test: how far does the map deviate from the edge's chord? The host has
/// fitted a quadratic to the map around each cell of a pyramid; an entry also holds what the fit leaves over.
/// (Decision: a feature narrower than an edge can lie beside all of the Summed Height Test's rectangles. A fit detects
/// it, with one read instead of twelve.) Unlike ranks, cells know of no lattice: the Tex Coord and Generation Tests end
/// the recursion, and all edges that request a split are cut at once.
///
/// Memory: one entry of the Curvature Table per edge, from the level that matches the edge's length. For an edge of at
///         most two texels the displacement map instead: the codes of its ends and of its midpoint, which is not yet
///         displaced in any design, in one request, through the map's second side (table_memory.h), which has the ports
///         and banks of the first, or, if the map has a cache, through Displace Vertex's cache.
/// Arithmetic: a count of leading zeros and shifts for the level; three products of 4 x 4 bits, three of 8 x 7, their
///         sum, a shift, a compare.
/// Timing: with one port a short edge's codes take three cycles.
class CurvatureTest : public HeightTestFunctions {
  public:
    constexpr CurvatureTest() : HeightTestFunctions("curvature", 1) {
        work = "one read, or three codes of the displacement map, through its own ports";
        arithmetic = "multiply, add, compare";
        latency = 4;  // products, sum, shift, compare
        feature = 6;
        codes = 3;
        second_side = true;
        covers_more = true;
        values = {{{"level", 4}, {"measure", 40}}};
        compared = 1;
    }

    int entry_bits(const Formats&) const override { return curvature_entry_bits; }
    /// Cells of all levels, in one row.
    void shape(const Registers& r, TableLayout& table) const override {
        table.columns = r.covered.columns == 0 ? 0 : static_cast<std::uint32_t>(curvature_entries(covered_texels(r)));
        table.rows = 1;
    }
    template <class Visit>
    static constexpr void visit_intermediates(const Formats& f, const Visit& visit) {
        visit("curvature_measure", CurvatureWidths{f});
    }
    Multiplications multiplications(const Registers& r) const override {
        return curvature_measure_multiplications(r.formats);
    }
    std::array<Threshold, 2> thresholds(const Formats& f) const override {
        return {{{"curvature_threshold", curvature_threshold_bits(f), false, "codes times texels, 3 fraction bits"}}};
    }
    std::uint64_t limit(std::uint64_t, const TestParameters& tests) const override { return tests.height_threshold(); }

    void reads(const HeightEdge& edge, const Registers& r, Reads& reads) const override {
        reads.through(curvature_by_codes(edge.t_i, edge.t_j, r.formats) ? 1 : 0);
        reads.add_request();
        curvature_reads(edge.t_i, edge.t_j, edge.t_ij, r, [&](std::uint64_t address) { reads.add_entry(address); });
    }
    void decide(const HeightEdge& edge, const Entries& entries, const Registers& r,
                HeightDecision& decision) const override {
        decision.values[0] = static_cast<unsigned>(curvature_level(edge.t_i, edge.t_j, r.formats));
        decision.values[1] = curvature_of_entries(edge.t_i, edge.t_j, entries, r.formats);
        decision.asks = curvature_test(decision.values[1], r.tests);
    }
};

}  // namespace tessera::datapath

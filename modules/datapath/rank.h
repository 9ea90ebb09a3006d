#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/datapath/intermediate.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

struct RankWidths : Intermediates {
    using Intermediates::Intermediates;
    Width difference{"RT: abs(du), abs(dv)", f.texture.bits};
    Width length{"RT: abs(du) + abs(dv)", f.texture.bits + 1};
    Width entry{"RT: rank, bound and radius",
                FormatLimits::rank_bits.most + FormatLimits::bound_bits.most + radius_bits};
    constexpr auto all() const { return std::array{difference, length, entry}; }
};
static_assert(fits_every_format<RankWidths>());

/// Manhattan length of an edge in the map, in the texture's format.
constexpr std::uint32_t texture_length(const TexCoord& i, const TexCoord& j) {
    return (i.u > j.u ? i.u - j.u : j.u - i.u) + (i.v > j.v ? i.v - j.v : j.v - i.v);
}

/// Whether the edge's midpoint is a point of the lattice its ends lie on: |du| and |dv| are even numbers of texels.
/// Ends the recursion, since an edge of odd length is never split.
constexpr bool has_lattice_midpoint(const TexCoord& i, const TexCoord& j, const Formats& formats) {
    const std::uint32_t below_two_texels = (2u << formats.texture.fraction) - 1;
    return (((i.u - j.u) | (i.v - j.v)) & below_two_texels) == 0 && !(i == j);
}

/// Byte address of a midpoint's entry, of which there is one per texel. Beyond the table addressed as beyond the map.
constexpr std::uint64_t rank_address(const TexCoord& t_ij, const TableLayout& table, const MapGeometry& map,
                                     const Formats& formats) {
    return table.address(texel_index(integer_part(t_ij.u, formats), table.columns, map.address_u),
                         texel_index(integer_part(t_ij.v, formats), table.rows, map.address_v));
}

/// The error caused by omitting a midpoint, on logarithmic scales that the host chooses.
struct RankEntry {
    std::uint32_t rank = 0;    ///< squared error
    std::uint32_t bound = 0;   ///< largest error
    std::uint32_t radius = 0;  ///< of the sphere that holds the surface which the error concerns (rank_view.h)
};

/// Bits of an entry of the Rank Table.
constexpr int rank_entry_bits(const Formats& formats) {
    return formats.rank_bits + formats.bound_bits + (formats.distances && formats.bound_bits > 0 ? radius_bits : 0);
}

/// An entry's fields: the rank in its lowest bits, the bound above, then the radius.
constexpr RankEntry rank_entry(std::uint64_t bits, const Formats& formats) {
    const auto field = [&](int from, int width) {
        return static_cast<std::uint32_t>(bits >> from & ((std::uint64_t{1} << width) - 1));
    };
    const int above = formats.rank_bits + formats.bound_bits;
    return {field(0, formats.rank_bits), field(formats.rank_bits, formats.bound_bits),
            field(above, rank_entry_bits(formats) - above)};
}

/// Of the Rank Test's thresholds in TestParameters::height_thresholds.
inline constexpr std::size_t rank_number = 0, bound_number = 1;

/// RT: the rank or the bound is above its threshold. A field that a design's entries lack is 0 and never above it.
constexpr bool rank_test(const RankEntry& entry, const TestParameters& parameters) {
    const std::int64_t rank = entry.rank, bound = entry.bound;
    return rank > parameters.height_thresholds[rank_number] || bound > parameters.height_thresholds[bound_number];
}

/// The number by which the edges of a triangle are compared.
constexpr std::uint16_t ordering_rank(const RankEntry& entry, const Formats& formats) {
    return static_cast<std::uint16_t>(formats.rank_bits > 0 ? entry.rank : entry.bound);
}

/// The `greatest_rank` cut: of the edges that request a split (bit k: edge k) the one of greatest rank; of equal ones
/// the longer, then the first. The others stay whole, and are tested again as edges of a child. ranks: those of the
/// edges' midpoints. lengths: texture_length. All cut at once, the error would be two to three times as large, and no
/// bound would hold.
constexpr unsigned edge_of_greatest_rank(unsigned asked, const std::array<std::uint16_t, 3>& ranks,
                                         const std::array<std::uint32_t, 3>& lengths) {
    unsigned cut = 0;
    std::size_t best = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if ((asked >> k & 1u) == 0)
            continue;
        if (cut == 0 || ranks[k] > ranks[best] || (ranks[k] == ranks[best] && lengths[k] > lengths[best])) {
            best = k;
            cut = 1u << k;
        }
    }
    return cut;
}

/// The edges of a pass that are split: those that request it, or with `greatest_rank` one of them.
template <class Pass>
constexpr unsigned edges_to_split(unsigned asked, Triangulation choice, const Pass& pass) {
    if (choice != Triangulation::greatest_rank)
        return asked;
    const auto& v = pass.triangle.vertices;
    return edge_of_greatest_rank(
        asked, {pass.edges[0].rank, pass.edges[1].rank, pass.edges[2].rank},
        {texture_length(v[0].texture, v[1].texture), texture_length(v[1].texture, v[2].texture),
         texture_length(v[2].texture, v[0].texture)});
}

}  // namespace tessera::datapath

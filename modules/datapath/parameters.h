#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/format.h"

namespace tessera::datapath {

enum class AddressMode : std::uint8_t { clamp, repeat };

/// Layout of a table in memory: rows of `columns` entries, bottom row first, packed, little endian.
struct TableLayout {
    std::uint64_t base = 0;  ///< byte address of entry (0, 0)
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::uint32_t entry_bytes = 0;

    constexpr std::uint64_t address(std::uint32_t column, std::uint32_t row) const {
        return base + (std::uint64_t{row} * columns + column) * entry_bytes;
    }
    constexpr std::uint64_t bytes() const { return std::uint64_t{rows} * columns * entry_bytes; }
    constexpr bool operator==(const TableLayout& other) const {
        return base == other.base && columns == other.columns && rows == other.rows && entry_bytes == other.entry_bytes;
    }
};

/// The texels that a table covers, from (0, 0) on: the map, or more if it clamps and the base mesh extends beyond it.
struct CoveredTexels {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
};

/// The map's size in texels and its addressing per axis.
struct MapGeometry {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    AddressMode address_u = AddressMode::clamp;
    AddressMode address_v = AddressMode::clamp;
};

enum class SummedHeightUnit : std::uint8_t { sum, area };

/// The thresholds and switches of the edge tests, set by the mesh's author (paper 2.2 to 2.4).
struct TestParameters {
    bool normal_test = true;         ///< if switched off, NT, SHT, HT count as false; VT, TCT, GT as true
    bool summed_height_test = true;  ///< or the test in its place (Formats::height_test)
    bool view_test = true;
    bool tex_coord_test = true;
    bool generation_test = true;
    std::uint32_t normal_threshold = 0;               ///< normal's format
    std::array<std::int64_t, 2> height_thresholds{};  ///< of the height test: HeightTestFunctions::thresholds
    SummedHeightUnit summed_height_unit = SummedHeightUnit::sum;
    bool rank_per_pixel = false;       ///< with Formats::distances: errors count per pixel, not per point
    std::uint32_t view_threshold = 0;  ///< screen's format
    std::uint32_t generation_limit = 12;

    bool highlight_test = false;  ///< HT: three more dot products and their compares, in designs that have it
    /// H, the half vector between the directions to the light and to the viewer, both infinitely far: unit length,
    /// world space, normal's format. Zero: no normal lies in the highlight.
    std::array<std::int32_t, 3> half_vector{};
    std::int64_t highlight_cosine = 0;             ///< N'.H at the highlight's border, twice the normal's fraction bits
    std::uint32_t highlight_normal_threshold = 0;  ///< normal's format

    /// Of a height test that has a single one, which is not negative.
    constexpr std::uint64_t height_threshold() const { return static_cast<std::uint64_t>(height_thresholds[0]); }
};

/// P' = P + (S * d + bias) * N. Both in the position's format; d = code / 2^bits.
struct DisplacementParameters {
    std::int32_t scale = 0;
    std::int32_t bias = 0;
};

/// World to screen, viewport included:
///     screen_x = 2^exponent * (row_x . P') / (row_w . P'), in pixels; screen_y likewise; w = row_w . P'.
/// Entries 0 to 2 have `matrix_fraction` fraction bits and lie in -1..1; entry 3 has the position's in addition.
struct TransformParameters {
    static constexpr int matrix_fraction = 24;
    std::array<std::int64_t, 4> row_x{};
    std::array<std::int64_t, 4> row_y{};
    std::array<std::int64_t, 4> row_w{};
    int exponent = 0;
    std::int64_t near_plane = 0;        ///< w in the products' format: position + matrix fraction bits
    std::array<std::int64_t, 3> eye{};  ///< the viewer, in the position's format, with Formats::distances
    std::array<std::array<std::int32_t, 3>, 3> normal_rows{};  ///< world to view rotation, normal's format
};

/// The triangulation of a triangle whose edges split: all of them are cut, and a quadrilateral that remains along the
/// given diagonal; or, with a Rank Test, only the edge of greatest rank is cut (rank.h).
enum class Triangulation : std::uint8_t { shorter, first, second, greatest_rank };

/// Direction towards the light in screen space (normal's format), and ambient light, 0..256.
struct LightParameters {
    std::array<std::int32_t, 3> direction{};
    std::int32_t ambient = 51;
};

/// The machine's registers, written by the host before a run.
struct Registers {
    Formats formats;
    MapGeometry map;
    TableLayout displacement_map;
    TableLayout normal_map;
    TableLayout height_table;  ///< of the height test: the Summed Height Table, unless Formats say otherwise
    CoveredTexels covered;     ///< by a height test's table that may extend beyond the map
    TestParameters tests;
    DisplacementParameters displacement;
    TransformParameters transform;
    Triangulation triangulation = Triangulation::shorter;
    bool back_face_culling = false;
    LightParameters light;
};

/// The texels that the height test's table covers, addressed like the map.
constexpr MapGeometry covered_texels(const Registers& r) {
    return {r.covered.columns, r.covered.rows, r.map.address_u, r.map.address_v};
}

}  // namespace tessera::datapath

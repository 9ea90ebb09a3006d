#pragma once
#include <cstdint>
#include <iterator>

namespace tessera::datapath {

/// A fixed-point format: `bits` in all, the lowest `fraction` of them after the binary point.
///
/// The model holds values in wider integers; `lowest` and `highest` are the limits of the wires. Widths are run-time
/// configuration, so that they can be explored.
struct Format {
    int bits = 0;
    int fraction = 0;
    std::int64_t lowest = 0;
    std::int64_t highest = 0;

    static constexpr Format make_signed(int bits, int fraction) {
        return {bits, fraction, -(std::int64_t{1} << (bits - 1)), (std::int64_t{1} << (bits - 1)) - 1};
    }
    static constexpr Format make_unsigned(int bits, int fraction) {
        return {bits, fraction, 0, (std::int64_t{1} << bits) - 1};
    }
};

/// The least bits that number this many values, at least 1.
constexpr int bits_for(std::uint64_t values) {
    int bits = 1;
    while (bits < 63 && std::uint64_t{1} << bits < values)
        ++bits;
    return bits;
}

/// The height test of a design, which has its own table: its number in height_tests(). Named here are the paper's, and the
/// one that the `greatest_rank` cut needs.
enum class HeightTest : std::uint8_t { summed_height, rank };

/// How the displacement map and the normal map are read at t (bilinear.h).
enum class MapFilter : std::uint8_t {
    nearest,   ///< the paper's: the texel under t
    bilinear,  ///< between the four texels around t
};

/// The formats of one design.
struct Formats {
    Format position = Format::make_signed(32, 16);  ///< P, P', scale, bias
    /// w, the distance from the eye, which may be much larger than the mesh: as wide as a position. The host places its
    /// binary point so that the farthest vertex fits.
    Format view_distance = Format::make_signed(32, 16);
    Format normal = Format::make_signed(16, 14);  ///< N, T, N', N's, normal map
    /// t in texels, 0 to 2^integer inclusive: the last border of a map of 4096 texels is u = 4096.0, so the wires are
    /// one bit wider than integer + fraction.
    Format texture = Format::make_unsigned(12 + 12 + 1, 12);
    Format displacement = Format::make_unsigned(16, 16);  ///< d, a fraction of full scale
    Format summed_height = Format::make_unsigned(32, 0);  ///< SAT entry, modulo 2^bits, in displacement codes
    Format screen = Format::make_signed(24, 8);           ///< P's in pixels
    int generation_bits = 4;
    bool highlight_tag = false;  ///< with a Highlight Test: only then split_by in a queue entry has a bit for it
    bool final_edges = false;    ///< a queue entry marks its final edges
    bool codes = false;          ///< a vertex carries its displacement code
    HeightTest height_test = HeightTest::summed_height;
    int rank_bits = 8;       ///< of an entry of the Rank Table; 0: none
    int bound_bits = 0;      ///< likewise; the bound lies above the rank
    bool distances = false;  ///< view-dependent Rank Test: a vertex carries its distance from the eye
    bool families = false;   ///< family design: a queue entry has its split edges, and N, T, N' of their midpoints
    MapFilter filter = MapFilter::nearest;
    int tex_coord_fraction = 0;  ///< fraction bits of t that the Tex Coord Test compares, at most the texture's
};

/// Bits of a midpoint's radius, beside a bound that depends on distance (rank_view.h).
inline constexpr int radius_bits = 8;

/// Bits of the number by which the `greatest_rank` cut compares edges: the rank or, without ranks, the bound.
constexpr int ordering_bits(const Formats& formats) {
    return formats.rank_bits > 0 ? formats.rank_bits : formats.bound_bits;
}

/// Ranges of the widths that a job may set. The functions of this folder are asserted to work within them. A fraction
/// has fewer bits than its format, a normal's at least 2 fewer.
struct FormatLimits {
    struct Range {
        int least, most;
    };
    static constexpr Range position_bits{8, 32}, position_fraction{0, 31};
    static constexpr Range normal_bits{6, 18}, normal_fraction{0, 16};
    static constexpr Range texture_integer{1, 12}, texture_fraction{0, 12};
    static constexpr Range tex_coord_fraction{0, 2};
    static constexpr Range displacement_bits{1, 16};
    static constexpr Range summed_height_bits{8, 48};
    static constexpr Range screen_bits{8, 31}, screen_fraction{0, 30};
    static constexpr Range generation_bits{1, 4};
    static constexpr Range rank_bits{6, 16}, bound_bits{6, 16};  ///< or 0, one of them
    /// Fraction bits that w has less than the position. 31 fit the farthest eye, 2^37 LSB of the position, into 8 bits.
    static constexpr Range view_distance_shift{0, 31};
};

/// Number of saturated results per quantity: no overflow is silent, and a spilled triangle fits its queue entry.
/// Normals, with two integer bits, N's, and w, whose binary point fits the farthest corner, cannot saturate; they are
/// counted all the same.
struct Saturations {
    std::uint64_t displaced_position = 0;
    std::uint64_t normal = 0;
    std::uint64_t screen_position = 0;
    std::uint64_t view_distance = 0;  ///< w
    std::uint64_t screen_normal = 0;
    std::uint64_t degenerate_normal = 0;  ///< normalisations of a zero vector, which stays zero
    std::uint64_t generation = 0;         ///< only with the Generation Test off, since the limit fits the field
    std::uint64_t intensity = 0;          ///< vertices that face the light fully: 256 of 256

    static constexpr std::uint64_t Saturations::*every[] = {
        &Saturations::displaced_position, &Saturations::normal,        &Saturations::screen_position,
        &Saturations::view_distance,      &Saturations::screen_normal, &Saturations::degenerate_normal,
        &Saturations::generation,         &Saturations::intensity};

    constexpr Saturations& operator+=(const Saturations& other) {
        for (const auto count : every)
            this->*count += other.*count;
        return *this;
    }
    constexpr std::uint64_t total() const {
        std::uint64_t sum = 0;
        for (const auto count : every)
            sum += this->*count;
        return sum;
    }
};
static_assert(sizeof(Saturations) == std::size(Saturations::every) * sizeof(std::uint64_t), "list every count");

/// Clamps a value to the format's range; counts it if it did not fit.
constexpr std::int64_t saturate(std::int64_t value, const Format& format, std::uint64_t& count) {
    if (value < format.lowest) {
        ++count;
        return format.lowest;
    }
    if (value > format.highest) {
        ++count;
        return format.highest;
    }
    return value;
}

/// Arithmetic shift right, rounded to nearest, ties upwards. shift >= 0; |value| + half must fit 64 bits.
constexpr std::int64_t round_shift(std::int64_t value, int shift) {
    return shift == 0 ? value : (value + (std::int64_t{1} << (shift - 1))) >> shift;
}

}  // namespace tessera::datapath

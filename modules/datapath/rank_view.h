#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "modules/datapath/intermediate.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/rank.h"
#include "modules/datapath/reciprocal.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// Fraction bits of a distance's logarithm.
inline constexpr int level_fraction = 12;
/// Bits of the eye's coordinates, which may be far beyond the position's range, and of the thresholds at distance 1.
inline constexpr int eye_bits = 40, rank_limit_bits = 19, bound_limit_bits = 18;

struct RankViewWidths : Intermediates {
    using Intermediates::Intermediates;
    Width away{"abs(x - eye.x)", eye_bits};
    Width pair{"sum of two of these", away.bits + 1};
    Width three{"sum of three", away.bits + 1};
    Width times_11{"11 * the greatest sum of two", pair.bits + 3};
    Width times_9{"9 * the sum of three", three.bits + 3};
    Width ends{"D_i + D_j", f.view_distance.bits + 1};
    Width radius{"radius of a midpoint's sphere", 4 + 31};
    Width deepest{"w_i + w_j + radius", wider(ends.bits, radius.bits + 1) + 1};
    Width level{"logarithm of a distance", 6 + level_fraction};
    Width rank{"rank, on the 16-bit scale", FormatLimits::rank_bits.most};
    Width limit{"threshold + logarithm", rank_limit_bits + 1};
    constexpr auto all() const {
        return std::array{away, pair, three, times_11, times_9, ends, radius, deepest, level, rank, limit};
    }
};
static_assert(fits_every_format<RankViewWidths>());

/// The distance of P' from the eye, in the view distance's format, rounded down: the norm
///     max(|x|, |y|, |z|, 11/16 of the greatest sum of two of them, 9/16 of their sum),
/// 0.873 to 1 times the Euclidean length, without a multiplier. Saturates at the greatest distance, not counted.
/// (Decision: not w, with which everything beside the viewer counts as near: a strip across the map is split down to
/// single texels. The mesh does not change when the camera turns, except for bounds of regions behind it.)
constexpr std::uint32_t eye_distance(const Position& p, const TransformParameters& parameters, const Formats& formats) {
    const auto away = [](std::int64_t a, std::int64_t b) { return static_cast<std::uint64_t>(a > b ? a - b : b - a); };
    const std::uint64_t x = away(p.x, parameters.eye[0]), y = away(p.y, parameters.eye[1]);
    const std::uint64_t z = away(p.z, parameters.eye[2]);
    const std::uint64_t one = std::max({x, y, z}), two = std::max({x + y, y + z, z + x}), three = x + y + z;
    const std::uint64_t norm = std::max({one, 11 * two >> 4, 9 * three >> 4});
    const int down = formats.position.fraction - formats.view_distance.fraction;
    const std::uint64_t farthest = (std::uint64_t{1} << formats.view_distance.bits) - 1;
    return static_cast<std::uint32_t>(std::min(norm >> down, farthest));
}

/// log2 of a distance with 12 fraction bits, linear between powers of two and rounded down: at most 0.0864 too small.
/// 0 counts as 1. A leading-zero count and the 12 bits after the leading one.
constexpr std::uint32_t distance_level(std::uint64_t distance) {
    if (distance == 0)
        return 0;
    const auto octave = static_cast<std::uint32_t>(63 - leading_zeros(distance));
    const std::uint64_t behind = distance << (63 - octave) << 1;  // the bits after the leading one, at the top
    return octave << level_fraction | static_cast<std::uint32_t>(behind >> (64 - level_fraction));
}

/// The view of an edge for the Rank Test: the sums of its ends' distances and depths.
struct EdgeInView {
    std::uint64_t distance = 0;  ///< D_i + D_j
    std::int64_t depth = 0;      ///< w_i + w_j
};

constexpr EdgeInView edge_in_view(const ScreenPosition& i, const ScreenPosition& j) {
    return {std::uint64_t{i.distance} + j.distance, std::int64_t{i.w} + j.w};
}

/// The radius encoded in a table entry: 3 bits after a leading one, and above them the exponent. In LSB of D_i + D_j.
constexpr std::uint64_t midpoint_radius(std::uint32_t code) {
    return std::uint64_t{8 + (code & 7)} << (code >> 3);
}

/// View-dependent RT: both thresholds rise with the distance of the edge's ends, D_i + D_j. A rank is a squared error;
/// its threshold rises by two octaves per octave of distance, or by four if errors are weighted per covered pixel
/// instead of per point. The threshold of a bound rises by one, with the least distance in the midpoint's sphere: if
/// the eye is in the sphere the edge requests a split; if all of the sphere is behind the viewer it does not. Both
/// sides are on scales of 16 bits for any entry width: a rank has 10 bits after the point, a bound 11. An entry of 0
/// never requests a split. There is no test against the sides of the picture, with which a bound would still hold: it
/// would save triangles outside the picture.
constexpr bool rank_test_in_view(const RankEntry& entry, const EdgeInView& ends, const TestParameters& parameters,
                                 const Formats& formats) {
    const auto level = static_cast<std::int64_t>(distance_level(ends.distance));
    const std::int64_t rank = std::int64_t{entry.rank} << (FormatLimits::rank_bits.most - formats.rank_bits);
    if (rank != 0 &&
        rank > parameters.height_thresholds[rank_number] + (parameters.rank_per_pixel ? level : level >> 1))
        return true;
    const std::uint64_t radius = midpoint_radius(entry.radius);
    if (entry.bound == 0 || ends.depth + static_cast<std::int64_t>(radius) < 0)
        return false;
    if (ends.distance <= radius)
        return true;
    const auto nearest = static_cast<std::int64_t>(distance_level(ends.distance - radius) >> 1);
    const std::int64_t bound = std::int64_t{entry.bound} << (FormatLimits::bound_bits.most - formats.bound_bits);
    return bound > parameters.height_thresholds[bound_number] + nearest;
}

/// RT, view-dependent or not.
constexpr bool asks_by_rank(const RankEntry& entry, const EdgeInView& ends, const TestParameters& parameters,
                            const Formats& formats) {
    return formats.distances ? rank_test_in_view(entry, ends, parameters, formats) : rank_test(entry, parameters);
}

}  // namespace tessera::datapath

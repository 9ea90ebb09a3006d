#pragma once
#include <cstdint>

#include "modules/datapath/normalise.h"

namespace tessera::datapath {

/// Fraction bits kept beyond the normal's between the three products' sum and normalising.
inline constexpr int bump_guard_bits = 2;

/// Handedness of a vertex inserted on (i, j): that of both, else -1. Commutative.
constexpr std::int8_t inserted_handedness(const Vertex& i, const Vertex& j) {
    return i.handedness < j.handedness ? i.handedness : j.handedness;
}

/// N' = bump(N, N_d): the base surface's normal perturbed by the displacement map's normal, which is given in the
/// tangent frame (T, B, N), B = handedness * (N x T)  (golden/ALGORITHM.md 3; the paper's existing bump unit).
/// Rounding: B to nearest in the normal's format; the sum of the three products to nearest with two more fraction
/// bits; then normalise.
constexpr Direction bump(const Direction& n, const Direction& t, int handedness, const Direction& map_normal,
                         const Formats& formats, Saturations& saturations) {
    const int fraction = formats.normal.fraction;
    const auto cross = [&](std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
        return handedness * round_shift(a * b - c * d, fraction);
    };
    const std::int64_t bx = cross(n.y, t.z, n.z, t.y);
    const std::int64_t by = cross(n.z, t.x, n.x, t.z);
    const std::int64_t bz = cross(n.x, t.y, n.y, t.x);
    const int down = fraction > bump_guard_bits ? fraction - bump_guard_bits : 0;  // fewer bits: all are kept
    const auto combine = [&](std::int64_t tangent, std::int64_t bitangent, std::int64_t normal) {
        return round_shift(map_normal.x * tangent + map_normal.y * bitangent + map_normal.z * normal, down);
    };
    return normalise(combine(t.x, bx, n.x), combine(t.y, by, n.y), combine(t.z, bz, n.z), formats,
                     saturations);
}

}  // namespace tessera::datapath

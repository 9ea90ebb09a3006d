#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/multiplications.h"
#include "modules/datapath/normalise.h"

namespace tessera::datapath {

/// Guard bits: the sum of the three products has this many fraction bits more than a normal when it is normalised.
inline constexpr int bump_guard_bits = 2;

/// Right shift of that sum, in bits; 0 if the normal has fewer fraction bits than the guard.
constexpr int bump_shift(const Formats& f) {
    return f.normal.fraction > bump_guard_bits ? f.normal.fraction - bump_guard_bits : 0;
}

/// Handedness of a vertex inserted on (i, j): that of the ends if they agree, else -1 (a choice, for meshes that mirror
/// their map). Commutative.
constexpr std::int8_t inserted_handedness(std::int8_t handedness_i, std::int8_t handedness_j) {
    return handedness_i < handedness_j ? handedness_i : handedness_j;
}

/// Operands are unit vectors from the host or normalise(): no component exceeds 1.0 in magnitude.
struct BumpWidths : Intermediates {
    using Intermediates::Intermediates;
    int one = f.normal.fraction;  // 1.0 is 2^one
    Width cross{"N x T", signed_bits(2 * one + 1)};
    Width bitangent{"B", signed_bits(one + 1)};
    Width product{"N_d.y * B", signed_bits(2 * one + 1)};
    Width sum{"N_d.x * T + N_d.y * B + N_d.z * N", signed_bits(2 * one + 2)};
    Width combined{"the same, rounded", signed_bits(2 * one + 2 - bump_shift(f)), largest_component_bits};
    constexpr auto all() const { return std::array{cross, bitangent, product, sum, combined}; }
};
static_assert(fits_every_format<BumpWidths>());

/// N' = bump(N, N_d): the base surface's normal perturbed by the normal map's N_d, given in the tangent frame
/// (T, B, N), B = handedness * (N x T)  (golden/ALGORITHM.md 3; the paper's existing bump unit).
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
    const int down = bump_shift(formats);
    const auto combine = [&](std::int64_t tangent, std::int64_t bitangent, std::int64_t normal) {
        return round_shift(map_normal.x * tangent + map_normal.y * bitangent + map_normal.z * normal, down);
    };
    return normalise(combine(t.x, bx, n.x), combine(t.y, by, n.y), combine(t.z, bz, n.z), formats, saturations);
}

/// With those of its normalise.
inline Multiplications bump_multiplications(const Formats& f) {
    const BumpWidths w{f};
    const int n = f.normal.bits;
    return Multiplications()
        .add(6, n, n)  // N x T
        .add(6, n, n)  // N_d.x T, N_d.z N
        .add(3, n, w.bitangent.bits)
        .add(normalise_multiplications(f, w.combined.bits));
}

}  // namespace tessera::datapath

#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/intermediate.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

struct MidpointWidths : Intermediates {
    using Intermediates::Intermediates;
    Width position{"P_i + P_j", f.position.bits + 1};
    Width direction{"N_i + N_j", f.normal.bits + 1};
    Width texture{"t_i + t_j", f.texture.bits + 1};
    constexpr auto all() const { return std::array{position, direction, texture}; }
};
static_assert(fits_every_format<MidpointWidths>());

/// Add, arithmetic shift right by 1 (paper 3): rounded towards minus infinity, error -1/2..0 LSB.
/// Commutative. The result lies between the operands, so it cannot overflow their format. (Decision: t is rounded down,
/// too, for an adder and a shift. A midpoint on a texel's border may then fall into the texel before, if the format
/// cannot represent the base coordinates (testbench/tune/README.md). The golden model's own run rounds t
/// likewise, so that the meshes agree: +0.07 % triangles at 256 x 256.)
constexpr std::int32_t midpoint(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>((std::int64_t{a} + std::int64_t{b}) >> 1);
}
constexpr std::uint32_t midpoint(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint32_t>((std::uint64_t{a} + std::uint64_t{b}) >> 1);
}
constexpr Position midpoint(const Position& a, const Position& b) {
    return {midpoint(a.x, b.x), midpoint(a.y, b.y), midpoint(a.z, b.z)};
}
/// The mean of two directions, not yet of unit length.
constexpr Direction midpoint(const Direction& a, const Direction& b) {
    return {midpoint(a.x, b.x), midpoint(a.y, b.y), midpoint(a.z, b.z)};
}
constexpr TexCoord midpoint(const TexCoord& a, const TexCoord& b) {
    return {midpoint(a.u, b.u), midpoint(a.v, b.v)};
}

}  // namespace tessera::datapath

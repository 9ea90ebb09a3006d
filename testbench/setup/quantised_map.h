#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"
#include "testbench/setup/height_map.h"

namespace tessera {

/// The displacement map in the hardware's format: unsigned codes of `bits` bits, bottom row first. Code 0 represents
/// the height map's range_low, code 2^bits - 1 its range_high.
struct QuantisedMap {
    datapath::MapGeometry geometry;
    int bits = 16;
    std::vector<std::uint16_t> codes;
    double rounding = 0;  ///< the largest difference of a value and its code, in codes

    std::uint16_t code(std::uint32_t x, std::uint32_t y) const { return codes[std::size_t{y} * geometry.width + x]; }
    std::uint32_t highest_code() const { return (std::uint32_t{1} << bits) - 1; }
};

/// Rounds to nearest. bits: 1 to 16.
QuantisedMap quantise_map(const HeightMap& map, int bits, datapath::AddressMode address_u,
                          datapath::AddressMode address_v);

/// The heights' rise per texel along u and v, by the differences of map_normal. In the unit of height_per_code.
std::array<double, 2> map_rise(const QuantisedMap& map, std::uint32_t x, std::uint32_t y, double height_per_code);

/// N_d at a texel (golden/ALGORITHM.md 2): normalise(-dh/du, -dh/dv, 1) by central differences of the heights,
/// one-sided at a clamped border, periodic where the map repeats; rounded to the normal's format.
/// height_per_code and texel_size are in the same world unit.
datapath::Direction map_normal(const QuantisedMap& map, std::uint32_t x, std::uint32_t y, double height_per_code,
                               const std::array<double, 2>& texel_size, const datapath::Format& format);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <vector>

#include "modules/datapath/mipmap.h"
#include "testbench/setup/quantised_map.h"

namespace tessera {

/// What a block of texels has for its height: the mean, rounded to nearest, halves up, or the maximum. The paper names
/// both without more detail (2.3.1): "mipmapping ... but with a maximal filter".
enum class MipmapFilter : std::uint8_t { mean, maximum };

/// The Mipmap Test's table: a pyramid of blocks (modules/datapath/mipmap.h).
struct MipmapTable {
    struct Level {
        std::uint32_t columns = 0, rows = 0;
        std::uint64_t first_entry = 0;
    };
    std::vector<Level> levels;
    std::vector<std::uint16_t> entries;  ///< codes; level after level, row by row, bottom row first
};

MipmapTable make_mipmap_table(const QuantisedMap& map, MipmapFilter filter);

/// The Mipmap Test's register for a height in codes, rounded down.
std::uint32_t mipmap_threshold(double height, const datapath::Formats& formats);

}  // namespace tessera

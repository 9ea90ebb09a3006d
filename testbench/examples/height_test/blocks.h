#pragma once
#include <algorithm>
#include <cstdint>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/parameters.h"

namespace range_test {

/// Blocks of 2^level x 2^level texels, the last ones cut off by the map's border; level 0 is the map.
struct Blocks {
    std::uint32_t columns, rows;
    std::uint64_t first_entry;  ///< in the table, which has one level after another
};

constexpr Blocks blocks_of(int level, const tessera::datapath::MapGeometry& map) {
    Blocks blocks{map.width, map.height, 0};
    for (int l = 1; l <= level; ++l) {
        blocks.first_entry += std::uint64_t{blocks.columns} * blocks.rows;
        blocks.columns = (blocks.columns + 1) / 2;
        blocks.rows = (blocks.rows + 1) / 2;
    }
    return blocks;
}

/// That of a single block.
constexpr int highest_level(const tessera::datapath::MapGeometry& map) {
    int level = 0;
    while (std::max(map.width, map.height) > std::uint32_t{1} << level)
        ++level;
    return level;
}

}  // namespace range_test

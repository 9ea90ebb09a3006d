#pragma once
#include <cstdint>
#include <vector>

#include "modules/datapath/mipmap.h"
#include "testbench/setup/quantised_map.h"
#include "testbench/setup/scene_settings.h"

namespace tessera {

/// The Mipmap Test's table: a pyramid of blocks (modules/datapath/mipmap.h).
struct MipmapTable {
    MipmapFilter filter = MipmapFilter::mean;
    std::vector<std::uint16_t> entries;  ///< codes; level after level, row by row, bottom row first
};

MipmapTable make_mipmap_table(const QuantisedMap& map, MipmapFilter filter);

}  // namespace tessera

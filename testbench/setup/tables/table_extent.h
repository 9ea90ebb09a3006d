#pragma once
#include <algorithm>
#include <vector>

#include "modules/datapath/map_address.h"
#include "testbench/setup/tables/grid_points.h"

namespace tessera {

/// The texels covered by a table for a map and a base mesh: the map's or, if it clamps and the base mesh extends beyond
/// it, correspondingly more.
inline datapath::MapGeometry table_extent(const datapath::MapGeometry& map, const std::vector<TextureTriangle>& base,
                                          const datapath::Formats& formats) {
    datapath::MapGeometry extent = map;
    const auto reach = [&](std::uint32_t& side, datapath::AddressMode mode, std::uint32_t coordinate) {
        if (mode == datapath::AddressMode::clamp)
            side = std::max(side, datapath::integer_part(coordinate, formats) + 1);
    };
    for (const TextureTriangle& triangle : base) {
        for (const datapath::TexCoord& corner : triangle) {
            reach(extent.width, map.address_u, corner.u);
            reach(extent.height, map.address_v, corner.v);
        }
    }
    return extent;
}

}  // namespace tessera

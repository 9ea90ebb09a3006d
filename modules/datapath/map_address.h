#pragma once
#include <cstdint>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// Integer part of a texture coordinate: a bit slice.
constexpr std::uint32_t integer_part(std::uint32_t coordinate, const Formats& formats) {
    return coordinate >> formats.texture.fraction;
}

/// Applies the address mode to a texel index. Beyond the border clamp reads the border texel, repeat periodically.
/// A vertex on the last border (u = width) thus reads the last texel or the first (golden/ALGORITHM.md 2).
constexpr std::uint32_t texel_index(std::uint32_t index, std::uint32_t size, AddressMode mode) {
    if (index < size)
        return index;
    return mode == AddressMode::clamp ? size - 1 : index % size;
}

/// Byte address of the texel under t in a table of one entry per texel (displacement map, normal map).
constexpr std::uint64_t texel_address(const TexCoord& t, const TableLayout& table, const MapGeometry& map,
                                      const Formats& formats) {
    return table.address(texel_index(integer_part(t.u, formats), map.width, map.address_u),
                         texel_index(integer_part(t.v, formats), map.height, map.address_v));
}

}  // namespace tessera::datapath

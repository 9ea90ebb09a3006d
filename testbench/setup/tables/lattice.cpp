#include "testbench/setup/tables/lattice.h"

#include <algorithm>

namespace tessera {

namespace {

std::uint32_t quads_along(std::uint32_t side, datapath::AddressMode mode, std::uint32_t spacing) {
    const std::uint32_t texels =
        mode == datapath::AddressMode::repeat ? side : side - 1;  // between first and last vertex
    return std::max<std::uint32_t>((texels + spacing - 1) / spacing, 1);
}

}  // namespace

Lattice lattice_over(const datapath::MapGeometry& map, std::uint32_t spacing) {
    return {spacing, quads_along(map.width, map.address_u, spacing), quads_along(map.height, map.address_v, spacing)};
}

std::vector<TextureTriangle> lattice_triangles(const Lattice& lattice, const datapath::Formats& formats) {
    const std::uint32_t centre = (std::uint32_t{1} << formats.texture.fraction) >> 1;
    const auto at = [&](std::uint32_t column, std::uint32_t row) {
        const auto place = [&](std::uint32_t line) {
            return (line * lattice.spacing << formats.texture.fraction) + centre;
        };
        return datapath::TexCoord{place(column), place(row)};
    };
    std::vector<TextureTriangle> triangles;
    for (std::uint32_t row = 0; row < lattice.rows; ++row) {
        for (std::uint32_t column = 0; column < lattice.columns; ++column) {
            const auto a = at(column, row), b = at(column + 1, row), c = at(column + 1, row + 1),
                       d = at(column, row + 1);
            const bool from_second = (column + row) % 2 == 1;
            triangles.push_back(from_second ? TextureTriangle{a, b, d} : TextureTriangle{a, b, c});
            triangles.push_back(from_second ? TextureTriangle{b, c, d} : TextureTriangle{a, c, d});
        }
    }
    return triangles;
}

}  // namespace tessera

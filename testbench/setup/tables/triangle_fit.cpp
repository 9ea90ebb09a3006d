#include "testbench/setup/tables/triangle_fit.h"

#include <algorithm>
#include <cmath>

namespace tessera {

std::uint16_t code_under(const QuantisedMap& map, const datapath::TexCoord& t, const datapath::Formats& formats) {
    const datapath::MapGeometry& g = map.geometry;
    return map.code(datapath::texel_index(datapath::integer_part(t.u, formats), g.width, g.address_u),
                    datapath::texel_index(datapath::integer_part(t.v, formats), g.height, g.address_v));
}

TriangleFit fit_triangle(const QuantisedMap& map, const TextureTriangle& triangle,
                         const std::array<std::uint16_t, 3>& codes, const datapath::Formats& formats) {
    TriangleFit fit;
    for (const std::uint32_t code : codes) {
        fit.lowest = std::min(fit.lowest, code);
        fit.highest = std::max(fit.highest, code);
    }
    const GridPoints points(triangle, map.geometry, formats);
    const double scale = 1 / static_cast<double>(points.whole());
    points.for_each([&](const GridPoint& point) {
        std::array<double, 3> at{};
        for (std::size_t k = 0; k < 3; ++k)
            at[k] = static_cast<double>(point.part[k]) * scale;
        const std::uint32_t code = map.code(point.column, point.row);
        fit.lowest = std::min(fit.lowest, code);
        fit.highest = std::max(fit.highest, code);
        const double error = code - (at[0] * codes[0] + at[1] * codes[1] + at[2] * codes[2]);
        const double share = point.is_on_an_edge() ? 0.5 : 1;
        fit.squared += share * error * error;
        fit.largest = std::max(fit.largest, std::abs(error));
        for (std::size_t k = 0; k < 3; ++k) {
            const double rise = 2 * std::min(at[k], at[(k + 1) % 3]);  // if the midpoint of edge k rises by 1
            fit.lean[k] += share * error * rise;
            fit.weight[k] += share * rise * rise;
        }
    });
    return fit;
}

}  // namespace tessera

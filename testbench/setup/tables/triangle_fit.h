#pragma once
#include <array>
#include <cstdint>

#include "testbench/setup/quantised_map.h"
#include "testbench/setup/tables/grid_points.h"

namespace tessera {

/// The code that the hardware reads under t.
std::uint16_t code_under(const QuantisedMap& map, const datapath::TexCoord& t, const datapath::Formats& formats);

/// How well a triangle, flat between the codes of its corners, fits the map's codes at the grid points it covers.
///
/// A grid point on an edge counts half, since the neighbour counts it too. If edge k is bisected and its midpoint lies
/// z above the edge, the squared error is squared - 2 z lean[k] + z^2 weight[k].
struct TriangleFit {
    double squared = 0;                          ///< sum of squared errors
    double largest = 0;                          ///< largest error
    std::uint32_t lowest = 0xffff, highest = 0;  ///< codes at corners and grid points
    std::array<double, 3> lean{}, weight{};
};

TriangleFit fit_triangle(const QuantisedMap& map, const TextureTriangle& triangle,
                         const std::array<std::uint16_t, 3>& codes, const datapath::Formats& formats);

}  // namespace tessera

#include "testbench/compare/reference_lattice.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

/// The longest edge along u or v in texels, at least 1.
double extent(const DisplacedSurface::Corners& corners) {
    double longest = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 edge = glm::abs(corners.texel[(k + 1) % 3] - corners.texel[k]);
        longest = std::max({longest, edge.x, edge.y});
    }
    return longest;
}

std::uint32_t subdivision_for(double samples) {
    constexpr double most = 16 * 65536 - 1;  // limit of a tile's column and row
    return static_cast<std::uint32_t>(std::clamp(std::ceil(samples - 1e-9), 1.0, most));
}

std::uint64_t lattice_points(std::uint64_t n) {
    return (n + 1) * (n + 2) / 2;
}

using Place = std::array<std::size_t, 2>;
/// The corners of a cell's two facets, from its own point.
constexpr std::array<std::array<Place, 3>, 2> facet_corners{{{{{0, 0}, {1, 0}, {0, 1}}}, {{{1, 0}, {1, 1}, {0, 1}}}}};

}  // namespace

ReferenceLattice::ReferenceLattice(const DisplacedSurface& surface, std::uint64_t most_samples) : surface_(surface) {
    std::vector<float> extents(surface.triangles());
    for (std::size_t k = 0; k < extents.size(); ++k)
        extents[k] = static_cast<float>(extent(surface.corners(k)));
    const auto count = [&](double factor) {
        std::uint64_t sum = 0;
        for (const float size : extents)
            sum += lattice_points(subdivision_for(samples_per_texel * factor * static_cast<double>(size)));
        return sum;
    };
    double factor = 1;
    if (count(1) > most_samples) {
        double fits = 0, too_many = 1;
        for (int step = 0; step < 30; ++step) {
            const double middle = (fits + too_many) / 2;
            (count(middle) > most_samples ? too_many : fits) = middle;
        }
        factor = fits;
        // At least one facet per base triangle: no coarser than the longest edge.
        density_ = std::max(samples_per_texel * factor,
                            1.0 / static_cast<double>(*std::max_element(extents.begin(), extents.end())));
    }
    samples_ = count(factor);
    subdivisions_.reserve(extents.size());
    for (std::size_t k = 0; k < extents.size(); ++k) {
        const std::uint32_t n = subdivision_for(samples_per_texel * factor * static_cast<double>(extents[k]));
        subdivisions_.push_back(n);
        for (std::uint32_t row = 0; row * tile_cells < n; ++row)
            for (std::uint32_t column = 0; (column + row) * tile_cells < n; ++column)
                tiles_.push_back({static_cast<std::uint32_t>(k), static_cast<std::uint16_t>(column),
                                  static_cast<std::uint16_t>(row)});
    }
}

ReferenceLattice::Cell ReferenceLattice::Points::cell(std::size_t a, std::size_t b) const {
    Cell cell;
    if (a >= tile_cells || b >= tile_cells || a + b + 1 > limit)
        return cell;
    cell.facets = a + b + 2 > limit ? 1 : 2;
    for (std::size_t k = 0; k < cell.facets; ++k)
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t at = number(a + facet_corners[k][c][0], b + facet_corners[k][c][1]);
            cell.corners[k][c] = std::size_t{static_cast<std::uint8_t>(below[k][c] & steps[at])} * count + at;
        }
    return cell;
}

glm::dvec3 ReferenceLattice::barycentric(const Tile& tile, std::size_t a, std::size_t b) const {
    const std::size_t n = subdivisions_[tile.triangle];
    const std::size_t i = tile.column * tile_cells + a, j = tile.row * tile_cells + b;
    return glm::dvec3(n - i - j, i, j) / static_cast<double>(n);
}

void ReferenceLattice::evaluate(const Tile& tile, Sampling sampling, Points& points) const {
    const std::size_t first = (tile.column + std::size_t{tile.row}) * tile_cells;
    points.limit = subdivisions_[tile.triangle] - first;
    const DisplacedSurface::Corners corners = surface_.corners(tile.triangle);
    for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t c = 0; c < 3; ++c) {
            const auto texels = [&](std::size_t corner) {
                const auto& [i, j] = facet_corners[k][corner % 3];
                return static_cast<double>(i) * (corners.texel[1] - corners.texel[0]) +
                       static_cast<double>(j) * (corners.texel[2] - corners.texel[0]);
            };
            constexpr double rounding = 1e-9;
            const glm::dvec2 inwards = texels(c + 1) + texels(c + 2) - 2.0 * texels(c);
            points.below[k][c] = axes(inwards.x < -rounding, inwards.y < -rounding);
            const glm::dvec2 edge = glm::abs(texels(c + 1) - texels(c));
            points.across[k][c] = axes(edge.x < rounding, edge.y < rounding);
        }
    for (std::size_t b = 0; b < Points::side && b <= points.limit; ++b)
        for (std::size_t a = 0; points.has(a, b); ++a) {
            const glm::dvec3 at = barycentric(tile, a, b);
            points.steps[Points::number(a, b)] = sampling == Sampling::nearest_texel
                                                     ? surface_.steps_at(DisplacedSurface::texel(corners, at))
                                                     : std::uint8_t{0};
            for (unsigned below = 0; below < 4; ++below)
                if (points.has(a, b, below))
                    points.point[Points::number(a, b, below)] = surface_.point(corners, at, sampling, below);
        }
}

}  // namespace tessera

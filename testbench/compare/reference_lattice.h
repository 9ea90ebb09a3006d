#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "testbench/bake/displaced_surface.h"

namespace tessera {

/// The dense samples of the displaced surface. A base triangle is subdivided into n * n congruent triangles, "facets",
/// with displaced points (i, j), i + j <= n, at barycentric coordinates (n - i - j, i, j) / n. n is the least for which
/// no edge of a facet is longer than a quarter of a texel along u or v, and at least 4, since a base surface with few
/// texels may be curved.
///
/// Beyond `most_samples` the density is lowered by one factor for all base triangles, but not below one facet each;
/// density() gives the result.
/// The reference is flat between samples, bilinear interpolation is not: where its slope along an axis changes by a
/// height of s per texel at a texel centre, a facet's edge cuts off a corner of at most s / 16.
/// With nearest_texel a point on a texel's edge has a height for each of the texels there. A facet takes those of the
/// texel that it lies in; at its edges on a texel's edge walls join the heights. Only where facets cross texels' edges,
/// which they do if the base mesh's are not on them, are they slopes.
///
/// Not stored, but evaluated in tiles of 16 by 16 cells of two facets each.
class ReferenceLattice {
  public:
    static constexpr double samples_per_texel = 4;
    static constexpr std::size_t tile_cells = 16;

    ReferenceLattice(const DisplacedSurface& surface, std::uint64_t most_samples);

    std::uint64_t samples() const { return samples_; }  ///< points; on a shared edge once per base triangle
    double density() const { return density_; }         ///< minimum samples per texel along an axis

    struct Tile {
        std::uint32_t triangle;
        std::uint16_t column, row;  ///< its first cell is (16 column, 16 row)
    };
    const std::vector<Tile>& tiles() const { return tiles_; }
    std::uint32_t subdivision(std::size_t triangle) const { return subdivisions_[triangle]; }

    /// Facets of a cell (a, b) of a tile as places of points; the second is missing on the triangle's third edge.
    struct Cell {
        std::size_t facets = 0;
        std::array<std::array<std::size_t, 3>, 2> corners{};
    };

    /// A tile's displaced points, local; (a, b) is relative to the tile's first cell.
    struct Points {
        static constexpr std::size_t side = tile_cells + 1, count = side * side;
        /// A point's place: its number and, on a step of nearest_texel, the side from which it is seen, of Below.
        static constexpr std::size_t number(std::size_t a, std::size_t b, std::size_t below = 0) {
            return below * count + b * side + a;
        }

        std::size_t limit = 0;  ///< points with a + b <= limit exist
        std::array<glm::dvec3, 4 * count> point;
        std::array<std::uint8_t, count> steps;  ///< by number: DisplacedSurface::steps_at(); 0 for interpolated
        /// For each corner of the two facets of a cell: the axes along which the facet lies below it, and those that the
        /// edge to the next corner is perpendicular to.
        std::array<std::array<std::uint8_t, 3>, 2> below, across;

        bool has(std::size_t a, std::size_t b) const { return a < side && b < side && a + b <= limit; }
        bool has(std::size_t a, std::size_t b, std::size_t seen_from) const {
            return has(a, b) && (seen_from & ~std::size_t{steps[number(a, b)]}) == 0;
        }
        Cell cell(std::size_t a, std::size_t b) const;

        /// Calls at(triangle) for the two triangles of each wall at a facet's edges; the facet below the step has it.
        template <class At>
        void for_each_wall(const Cell& cell, At&& at) const {
            for (std::size_t k = 0; k < cell.facets; ++k)
                for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t p = cell.corners[k][c], q = cell.corners[k][(c + 1) % 3];
                    for (const std::size_t axis : {below_u, below_v})
                        if ((p / count & q / count & across[k][c] & axis) != 0) {
                            at(std::array{point[p], point[q], point[q - axis * count]});
                            at(std::array{point[p], point[q - axis * count], point[p - axis * count]});
                        }
                }
        }
    };
    void evaluate(const Tile& tile, Sampling sampling, Points& points) const;

    /// Barycentric coordinates of a tile's point in its base triangle.
    glm::dvec3 barycentric(const Tile& tile, std::size_t a, std::size_t b) const;

    const DisplacedSurface& surface() const { return surface_; }

  private:
    const DisplacedSurface& surface_;
    std::uint64_t samples_ = 0;
    double density_ = samples_per_texel;
    std::vector<std::uint32_t> subdivisions_;
    std::vector<Tile> tiles_;
};

}  // namespace tessera

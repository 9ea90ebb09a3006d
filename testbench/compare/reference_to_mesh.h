#pragma once
#include <vector>

#include "testbench/compare/reference_lattice.h"
#include "testbench/geometry/nearest_triangle.h"

namespace tessera {

/// Distance from every sample of a reference lattice to the nearest point of a mesh, tile by tile. One per thread.
///
/// Samples are so dense that a look-up for each would take minutes. Only the centre of a block of samples is looked up:
/// if its distance from the mesh is d and the block's radius is r, no sample's nearest triangle is farther than
/// d + 2 r from the centre. Samples are compared with these triangles only, nearest first. A block with too many is
/// divided into four.
class ReferenceToMesh {
  public:
    struct Sample {
        glm::dvec3 position{0};    ///< local
        glm::dvec2 texture{0};     ///< 0..1 spans the map
        double squared = 0;        ///< distance to the mesh, local
        std::size_t triangle = 0;  ///< nearest; the first of equally near ones
        double weight = 0;         ///< its share of the base surface's area in this tile
    };

    /// Lattice, soup and the search through it must outlive this. With an empty soup and no search, tiles are evaluated
    /// but nothing is measured.
    ReferenceToMesh(const ReferenceLattice& lattice, Sampling sampling, const TriangleSoup& soup,
                    const NearestTriangle* nearest);

    /// Calls take(sample) for all points of a tile, in a fixed order; points on a border are part of both tiles, and a
    /// point on a step is one sample for each height that a facet has there. Returns the box about the tile's points.
    template <class Take>
    BoxHierarchy::Box measure(std::size_t tile, Take&& take) {
        const BoxHierarchy::Box box = start(tile);
        if (nearest_) {
            measure_blocks();
            constexpr std::size_t side = ReferenceLattice::Points::side;
            for_each_corner(0, 0, side, side,
                            [&](std::size_t a, std::size_t b, std::size_t at) { take(sample(tile, a, b, at)); });
        }
        return box;
    }

  private:
    /// Calls at(a, b, place) for the places that facets have, of points from (first_a, first_b) to before the end.
    template <class At>
    void for_each_corner(std::size_t first_a, std::size_t first_b, std::size_t end_a, std::size_t end_b,
                         At&& at) const {
        for (std::size_t b = first_b; b < end_b; ++b)
            for (std::size_t a = first_a; a < end_a && points_.has(a, b); ++a)
                for (std::size_t below = 0; below < 4; ++below)
                    if (const std::size_t place = ReferenceLattice::Points::number(a, b, below); facets_[place] > 0)
                        at(a, b, place);
    }

    BoxHierarchy::Box start(std::size_t tile);
    void measure_blocks();
    void measure_block(std::size_t a, std::size_t b, std::size_t size);
    NearestTriangle::Found nearest_candidate(const glm::dvec3& p, double from_centre) const;
    Sample sample(std::size_t tile, std::size_t a, std::size_t b, std::size_t place) const;

    struct Candidate {
        std::size_t triangle;
        double from_centre;  // distance from the block's centre
        BoxHierarchy::Box box;
    };

    const ReferenceLattice& lattice_;
    Sampling sampling_;
    const TriangleSoup& soup_;
    const NearestTriangle* nearest_;
    NearestTriangle::Guess guess_;

    ReferenceLattice::Points points_;
    DisplacedSurface::Corners corners_;
    double facet_area_ = 0;                                                   // on the base surface
    std::array<std::uint8_t, 4 * ReferenceLattice::Points::count> facets_{};  // at each place
    std::array<NearestTriangle::Found, 4 * ReferenceLattice::Points::count> found_;
    std::size_t block_ = ReferenceLattice::Points::side;  // initial samples along a block's side
    std::size_t blocks_cut_ = 0, blocks_whole_ = 0, tiles_ = 0;
    std::vector<NearestTriangle::Found> within_;
    std::vector<Candidate> candidates_;
};

}  // namespace tessera

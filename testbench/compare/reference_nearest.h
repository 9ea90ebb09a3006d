#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "testbench/compare/reference_lattice.h"
#include "testbench/geometry/box_hierarchy.h"

namespace tessera {

/// Distance from a point to the facets of the reference lattice, walls included. Tiles are found by their boxes and
/// evaluated on demand; 512 (16 MB) are cached. The result depends on the lattice alone. Fast if successive points are
/// neighbours in space.
class ReferenceNearest {
  public:
    /// `boxes`: the boxes of the lattice's tiles, in order. Both must outlive this.
    ReferenceNearest(const ReferenceLattice& lattice, Sampling sampling, const std::vector<BoxHierarchy::Box>& boxes);

    /// In local units.
    double squared_distance(const glm::dvec3& p);

  private:
    using Box = BoxHierarchy::Box;

    /// A tile with a hierarchy of boxes: 8 x 8 of 2 x 2 cells, 4 x 4 of 4 x 4, 2 x 2 of 8 x 8.
    struct Kept {
        std::size_t tile = SIZE_MAX;
        ReferenceLattice::Points points;
        std::array<Box, 64 + 16 + 4> boxes;
    };
    const Kept& fetch(std::size_t tile);
    void look_at_tile(std::size_t tile);
    void look_at_boxes(const Kept& kept, std::size_t level, std::size_t x, std::size_t y);
    void look_at_cell(const Kept& kept, std::size_t a, std::size_t b);
    void look_at(const std::array<glm::dvec3, 3>& facet);

    const ReferenceLattice& lattice_;
    Sampling sampling_;
    const std::vector<Box>& boxes_;
    BoxHierarchy hierarchy_;
    std::vector<Kept> kept_;

    glm::dvec3 point_{0};
    double nearest_squared_ = 0;
    std::array<glm::dvec3, 3> nearest_facet_{};
    bool any_facet_ = false;
};

}  // namespace tessera

#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/meshes/mesh_limits.h"

namespace tessera {

/// Cuts polygons into triangles that keep the polygon's winding, every corner used.
///
/// Strictly convex: a fan from the first corner; of more than 8, every second corner is cut off first, round by
/// round. Otherwise ear clipping in the plane's projection along its largest normal component (Meisters 1975),
/// with these additions: an ear has positive area and no corner on its border, so that corners on a straight
/// edge give no triangle without area and no T-junction; where no ear is left (the outline crosses itself), the
/// rest is cut as a fan. Quadratic in the corners at worst; the work of all calls together is limited.
class PolygonCutter {
  public:
    struct Cut {
        std::vector<std::array<std::uint32_t, 3>> triangles;  ///< corner numbers; may hold flat ones
        bool crosses_itself = false;  ///< found always up to 256 corners, beyond that where ears run out
        bool nonplanar = false;       ///< a corner is off the mean plane by more than 1/20 of the size
        bool out_of_work = false;     ///< the limit was reached; triangles are incomplete
    };

    explicit PolygonCutter(std::uint64_t work_limit = largest_cutting_work) : work_left_(work_limit) {}

    /// Three corners or more.
    Cut cut(std::vector<glm::dvec3> const& corners);

  private:
    bool spend(std::uint64_t work);
    void clip_ears(std::vector<glm::dvec2> const& points, Cut& result);
    bool crosses_itself(std::vector<glm::dvec2> const& points);

    std::uint64_t work_left_;
};

}  // namespace tessera

#pragma once
#include <array>
#include <glm/glm.hpp>

namespace tessera {

/// A triangle's edges in an image: computes a pixel's coverage by a line.
class Wireframe {
  public:
    /// Corners as returned by View::project(); they may be behind the eye. Lines are `width` pixels wide at any
    /// distance, half on either side of the edge. An edge fades if its triangle is less than about 4 widths high above
    /// it, so that a dense mesh appears as a tone, not as a black area or a moire pattern.
    Wireframe() = default;
    Wireframe(const std::array<glm::dvec3, 3>& corners, double width);

    /// 0: no line at this image point; 1: fully covered.
    double coverage(double x, double y) const;

  private:
    struct Edge {
        glm::dvec3 line{0};   ///< dot with (x, y, 1): distance in pixels
        double strength = 0;  ///< 0: invisible
    };
    std::array<Edge, 3> edges_;
    double width_ = 1;
};

}  // namespace tessera

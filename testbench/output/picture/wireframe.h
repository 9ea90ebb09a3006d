#pragma once
#include <array>
#include <glm/glm.hpp>

namespace tessera {

/// A triangle's edges in an image: how much of a line covers a pixel.
class Wireframe {
  public:
    /// Corners as View::project() gives them; they may lie behind the eye. Lines are `width` pixels wide at any
    /// distance, half of it on either side of the edge; an edge fades where its triangle is less than some 4 widths
    /// high above it: a dense mesh gets a tone, not a black area or a pattern of its own.
    Wireframe() = default;
    Wireframe(const std::array<glm::dvec3, 3>& corners, double width);

    /// 0: no line at this image point, 1: fully on one.
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

#pragma once
#include <array>
#include <glm/glm.hpp>

namespace tessera {

/// A triangle's edges in an image: how much of a line covers a pixel.
class Wireframe {
  public:
    /// Corners as View::project() gives them; they may lie behind the eye.
    Wireframe() = default;
    explicit Wireframe(const std::array<glm::dvec3, 3>& corners);

    /// 0: no line at this image point, 1: fully on one. Lines have `width` pixels whatever their distance,
    /// half of it on either side of the edge; an edge fades where its triangle is less than some 3 pixels
    /// high above it.
    double coverage(double x, double y, double width) const;

  private:
    struct Edge {
        glm::dvec3 line{0};   ///< dot with (x, y, 1): distance in pixels
        double strength = 0;  ///< 0: invisible
    };
    std::array<Edge, 3> edges_;
};

}  // namespace tessera

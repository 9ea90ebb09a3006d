#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/geometry/box_hierarchy.h"

namespace tessera {

/// Triangles as bare positions.
using TriangleSoup = std::vector<std::array<glm::dvec3, 3>>;

/// The point of a triangle nearest to p. A collapsed triangle is the segment or point it collapsed to. The
/// distance is right within 1e-8 of the triangle's longest edge and the distance itself, however thin the triangle.
glm::dvec3 closest_point(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& p);

inline double squared_distance(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& p) {
    const glm::dvec3 away = closest_point(triangle, p) - p;
    return glm::dot(away, away);
}

/// What rounding may make of a squared distance: two ways to compute it agree within this factor. Who leaves something
/// out by a bound leaves out only what is farther than this, and the answer does not depend on the order of looking.
inline constexpr double rounding_slack = 1 + 1e-12;

/// Looks up the triangle nearest to a point. Of triangles equally near the first in the soup is it, so the answer
/// depends on the soup alone. Long thin triangles are sorted by boxes about parts of them: a box about a
/// whole one holds mostly what is far from it. Several threads may ask at once, each with a guess of its own.
class NearestTriangle {
  public:
    struct Found {
        std::size_t triangle = 0;
        double squared = std::numeric_limits<double>::infinity();  ///< of the distance

        bool is_beaten_by(double other_squared, std::size_t other_triangle) const {
            return other_squared < squared || (other_squared == squared && other_triangle < triangle);
        }
    };

    /// `soup` must outlive this and not be empty.
    explicit NearestTriangle(const TriangleSoup& soup);

    /// What was found last: where to begin. Quick if points come in an order in which neighbours are
    /// neighbours in space.
    struct Guess {
        std::size_t triangle = 0;
        double distance = std::numeric_limits<double>::infinity();
    };
    Found nearest(const glm::dvec3& p, Guess& guess) const;

    /// How many boxes p lies in: what nearest(p) looks at, at least.
    std::size_t boxes_around(const glm::dvec3& p) const;

    /// Every triangle within `radius` of p, each once, by its place in the soup; false, and not all of them,
    /// if there are more than `most`.
    bool within(const glm::dvec3& p, double radius, std::size_t most, std::vector<Found>& found) const;

  private:
    struct Part {
        std::uint32_t triangle, path;  // how it was cut out of the triangle
    };
    static std::vector<Part> cut(const TriangleSoup& soup);

    const TriangleSoup& soup_;
    std::vector<Part> parts_;  // by box
    BoxHierarchy boxes_;
};

}  // namespace tessera

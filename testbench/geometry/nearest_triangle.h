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

/// The point of a triangle nearest to p. A degenerate triangle is treated as a segment or point. The error of the
/// distance is within 1e-8 of the triangle's longest edge and the distance itself, however thin the triangle.
glm::dvec3 closest_point(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& p);

inline double squared_distance(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& p) {
    const glm::dvec3 away = closest_point(triangle, p) - p;
    return glm::dot(away, away);
}

/// Rounding of a squared distance: two ways to compute it agree within this factor. A search that excludes only
/// candidates farther than a bound times this factor gives the same result in any order.
inline constexpr double rounding_slack = 1 + 1e-12;

/// Finds the triangle nearest to a point; of equally near ones the first in the soup, so that the result depends on the
/// soup alone. Long thin triangles have several boxes, each about a part, since a box about the whole triangle would be
/// mostly empty. Queries are thread-safe if each thread has its own guess.
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

    /// The last result, where the next search begins. Fast if successive points are neighbours in space.
    struct Guess {
        std::size_t triangle = 0;
        double distance = std::numeric_limits<double>::infinity();
    };
    Found nearest(const glm::dvec3& p, Guess& guess) const;

    /// Number of boxes that contain p, a lower bound of those that nearest(p) visits.
    std::size_t boxes_around(const glm::dvec3& p) const;

    /// Every triangle within `radius` of p, each once, by its index in the soup. False, with an incomplete list, if
    /// there are more than `most`.
    bool within(const glm::dvec3& p, double radius, std::size_t most, std::vector<Found>& found) const;

  private:
    struct Part {
        std::uint32_t triangle, path;  // path: its halvings, as above
    };
    static std::vector<Part> cut(const TriangleSoup& soup);

    const TriangleSoup& soup_;
    std::vector<Part> parts_;  // by box
    BoxHierarchy boxes_;
};

}  // namespace tessera

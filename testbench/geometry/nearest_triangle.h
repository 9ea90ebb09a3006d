#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/common/distinct_table.h"
#include "testbench/geometry/box_hierarchy.h"

namespace tessera {

/// Triangles as bare positions; equal positions are stored once.
class TriangleSoup {
  public:
    using Corners = std::array<glm::dvec3, 3>;

    TriangleSoup() = default;
    TriangleSoup(const std::vector<Corners>& triangles) {
        for (const Corners& triangle : triangles)
            push_back(triangle);
    }

    void reserve(std::size_t triangles) { triangles_.reserve(triangles); }
    void push_back(const Corners& triangle) {
        push_back({vertex(triangle[0]), vertex(triangle[1]), vertex(triangle[2])});
    }
    /// The index of a position, which is added if it is new.
    std::uint32_t vertex(const glm::dvec3& p) {
        const std::uint32_t number = table_.number_of(
            point_hash(p), [&](std::uint32_t v) { return vertices_[v] == p; },
            [&](std::uint32_t v) { return point_hash(vertices_[v]); });
        if (number == vertices_.size())
            vertices_.push_back(p);
        return number;
    }
    void push_back(const std::array<std::uint32_t, 3>& vertices) { triangles_.push_back(vertices); }
    std::size_t size() const { return triangles_.size(); }
    bool empty() const { return triangles_.empty(); }
    Corners operator[](std::size_t k) const {
        const auto& [a, b, c] = triangles_[k];
        return {vertices_[a], vertices_[b], vertices_[c]};
    }
    /// In the order in which they were added.
    const std::vector<glm::dvec3>& vertices() const { return vertices_; }

  private:
    std::vector<glm::dvec3> vertices_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    DistinctTable table_;
};

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

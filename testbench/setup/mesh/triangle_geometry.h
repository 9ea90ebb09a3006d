#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace tessera {

/// A triangle this flat (approximately height over longest edge) counts as one without area. Doubles have 16 digits, so
/// rounding would determine the direction of a flatter one.
constexpr double flattest_triangle = 1e-12;

/// |a|, without intermediate overflow or underflow.
inline double safe_length(const glm::dvec3& a) {
    return std::hypot(a.x, a.y, a.z);
}

/// a / |a|; zero for the zero vector.
inline glm::dvec3 unit_or_zero(const glm::dvec3& a) {
    const double largest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
    if (!(largest > 0))
        return glm::dvec3(0);
    const glm::dvec3 scaled = a / largest;  // two steps: 1 / |a| may overflow
    return scaled / std::sqrt(glm::dot(scaled, scaled));
}

/// Unit normal of the triangle a, b, c by its winding; zero if it has no area (flattest_triangle).
inline glm::dvec3 triangle_normal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 ab = b - a, ac = c - a, bc = c - b;
    double largest = 0;
    for (int k = 0; k < 3; ++k)
        largest = std::max({largest, std::abs(ab[k]), std::abs(ac[k]), std::abs(bc[k])});
    if (!(largest > 0))
        return glm::dvec3(0);
    const glm::dvec3 twice_area = glm::cross(ab / largest, ac / largest);
    if (!(safe_length(twice_area) > flattest_triangle))
        return glm::dvec3(0);
    return unit_or_zero(twice_area);
}

inline double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(safe_length(glm::cross(a, b)), glm::dot(a, b)));
}

/// Area in square model units.
inline double triangle_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return safe_length(glm::cross(b - a, c - a)) / 2;
}

}  // namespace tessera

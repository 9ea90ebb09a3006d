#pragma once
#include <glm/glm.hpp>
#include <optional>

namespace tessera {

/// The points p with, for q = p - centre,
///
///     dot(q, form q) + dot(linear, q) + constant = 0        form: symmetric
struct Quadric {
    glm::dvec3 centre{0};
    glm::dmat3 form{0};
    glm::dvec3 linear{0};
    double constant = 0;
};

enum class QuadricShape { ellipsoid, paraboloid, cone, cylinder, hyperboloid };

/// With X, Y, Z = (p - centre) / semi_axes and Z along `axis` (0 x, 1 y, 2 z):
///
///     ellipsoid    X^2 + Y^2 + Z^2 = 1          (axis does not matter)
///     paraboloid   X^2 + Y^2 = -Z               the apex is the centre; a negative semi-axis Z opens it upwards
///     cone         X^2 + Y^2 = Z^2              both halves; the apex is the centre
///     cylinder     X^2 + Y^2 = 1                infinite
///     hyperboloid  X^2 + Y^2 - Z^2 = 1 or, with two sheets, -1
Quadric make_quadric(QuadricShape shape, const glm::dvec3& centre, const glm::dvec3& semi_axes, int axis, int sheets);

/// Which of a line's two intersections is used.
enum class Root { highest, lowest, nearest };

/// Intersections farther away are ignored, since no job can displace that far (model units, for a unit direction).
constexpr double largest_displacement = 1e6;

/// t of an intersection origin + t * direction with the quadric: the highest t, the lowest, or the nearest to 0, which
/// is the positive one if both are equally near within 1e-9. Nothing if the line misses the quadric. A line that
/// touches it within rounding (1e-14 of the discriminant's terms) counts as a hit.
std::optional<double> intersect(const Quadric& quadric, const glm::dvec3& origin, const glm::dvec3& direction,
                                Root root);

}  // namespace tessera

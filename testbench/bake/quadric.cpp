#include "testbench/bake/quadric.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera {

Quadric make_quadric(QuadricShape shape, const glm::dvec3& centre, const glm::dvec3& semi_axes, int axis, int sheets) {
    Quadric quadric;
    quadric.centre = centre;
    for (int k = 0; k < 3; ++k)
        quadric.form[k][k] = 1 / (semi_axes[k] * semi_axes[k]);
    double& along = quadric.form[axis][axis];
    switch (shape) {
        case QuadricShape::ellipsoid: quadric.constant = -1; break;
        case QuadricShape::paraboloid:
            along = 0;
            quadric.linear[axis] = 1 / semi_axes[axis];
            break;
        case QuadricShape::cone: along = -along; break;
        case QuadricShape::cylinder:
            along = 0;
            quadric.constant = -1;
            break;
        case QuadricShape::hyperboloid:
            along = -along;
            quadric.constant = sheets == 1 ? -1 : 1;
            break;
    }
    return quadric;
}

std::optional<double> intersect(const Quadric& quadric, const glm::dvec3& origin, const glm::dvec3& direction,
                                Root root) {
    // a t^2 + 2 b t + c = 0
    const glm::dvec3 from = origin - quadric.centre;
    const glm::dvec3 bent = quadric.form * direction;
    const double a = glm::dot(direction, bent);
    const double b = glm::dot(from, bent) + glm::dot(quadric.linear, direction) / 2;
    const double c = glm::dot(from, quadric.form * from) + glm::dot(quadric.linear, from) + quadric.constant;
    double discriminant = b * b - a * c;
    if (discriminant < 0) {
        if (discriminant < -1e-14 * (b * b + std::abs(a * c)))
            return std::nullopt;
        discriminant = 0;
    }
    // A sum of two numbers of equal sign, without cancellation. The roots are two quotients with it; if the line meets
    // the quadric only once, a is 0 and the first root infinite.
    const double sum = -(b + std::copysign(std::sqrt(discriminant), b));
    std::array<double, 2> roots{sum / a, c / sum};
    if (sum == 0)
        roots = {0, 0};  // b = 0 and a c = 0
    if (sum == 0 && c != 0)
        return std::nullopt;
    const auto counts = [](double t) { return std::abs(t) <= largest_displacement; };
    if (!counts(roots[0]))
        roots[0] = roots[1];
    if (!counts(roots[1]))
        roots[1] = roots[0];
    if (!counts(roots[0]))
        return std::nullopt;
    const auto [low, high] = std::minmax(roots[0], roots[1]);
    if (root == Root::lowest)
        return low;
    if (root == Root::highest)
        return high;
    return std::abs(low) < std::abs(high) * (1 - 1e-9) ? low : high;
}

}  // namespace tessera

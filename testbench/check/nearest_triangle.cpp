#include "testbench/check/nearest_triangle.h"

#include <algorithm>
#include <cmath>

namespace tessera {

// Ericson, Real-Time Collision Detection, 5.1.5: by the Voronoi region of corner, edge or face that p lies
// in.
glm::dvec3 closest_point(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& p) {
    const auto& [a, b, c] = triangle;
    const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0)
        return a;
    const glm::dvec3 bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3)
        return b;
    const glm::dvec3 cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6)
        return c;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3)
        return a + d1 / (d1 - d3) * ab;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6)
        return a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    const double to_c = d4 - d3, to_b = d5 - d6;
    if (va <= 0 && to_c >= 0 && to_b >= 0 && to_c + to_b > 0)
        return b + to_c / (to_c + to_b) * (c - b);
    const double sum = va + vb + vc;
    if (!(sum > 0))
        return a;
    return a + vb / sum * ab + vc / sum * ac;
}

NearestTriangle::NearestTriangle(const TriangleSoup& soup)
    : soup_(soup), boxes_(soup.size(), [&](std::size_t triangle) {
          BoxHierarchy::Box box;
          for (const glm::dvec3& corner : soup[triangle])
              box.add(corner);
          return box;
      }) {}

NearestTriangle::Found NearestTriangle::nearest(const glm::dvec3& p) {
    Found found{last_, squared_distance(soup_[last_], p)};
    double radius = std::sqrt(found.squared);
    boxes_.visit_near(p, radius, [&](std::size_t triangle) {
        const double squared = squared_distance(soup_[triangle], p);
        if (found.is_beaten_by(squared, triangle)) {
            found = {triangle, squared};
            radius = std::sqrt(squared);
        }
        return radius;
    });
    last_ = found.triangle;
    return found;
}

bool NearestTriangle::within(const glm::dvec3& p, double radius, std::size_t most,
                             std::vector<Found>& found) const {
    found.clear();
    const double largest = radius * radius * rounding_slack;
    bool all = true;
    boxes_.visit_near(p, radius, [&](std::size_t triangle) {
        if (!all)
            return 0.0;
        const double squared = squared_distance(soup_[triangle], p);
        if (squared > largest)
            return radius;
        all = found.size() < most;
        if (all)
            found.push_back({triangle, squared});
        return all ? radius : 0.0;
    });
    return all;
}

}  // namespace tessera

#include "testbench/check/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace tessera {
namespace {

std::vector<glm::dvec3> distinct_vertices(const TriangleSoup& soup) {
    std::vector<glm::dvec3> vertices;
    vertices.reserve(3 * soup.size());
    for (const auto& t : soup)
        vertices.insert(vertices.end(), t.begin(), t.end());
    std::sort(vertices.begin(), vertices.end(), [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    });
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

}  // namespace

SurfaceDistance distance_between(const TriangleSoup& from, const TriangleSoup& to) {
    SurfaceDistance result;
    if (from.empty())
        return result;
    if (to.empty()) {
        const double infinity = std::numeric_limits<double>::infinity();
        return {from.size(), infinity, infinity};
    }
    NearestTriangle nearest(to);
    double squares = 0;
    const auto measure = [&](const glm::dvec3& p) {
        const double distance = std::sqrt(nearest.nearest(p).squared);
        result.max = std::max(result.max, distance);
        squares += distance * distance;
        ++result.points;
    };
    for (const glm::dvec3& p : distinct_vertices(from))
        measure(p);
    for (const auto& t : from)
        measure((t[0] + t[1] + t[2]) / 3.0);
    result.rms = std::sqrt(squares / static_cast<double>(result.points));
    return result;
}

}  // namespace tessera

#include "testbench/render/wireframe.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// Triangle heights, in line widths, over which lines fade in, and the strength that remains below.
constexpr double fade_from = 1.4;
constexpr double fade_to = 4.5;
constexpr double faintest = 0.22;

double fade(double height, double width) {
    const double t = std::clamp((height / width - fade_from) / (fade_to - fade_from), 0.0, 1.0);
    return faintest + (1 - faintest) * t * t * (3 - 2 * t);
}

}  // namespace

Wireframe::Wireframe(const std::array<glm::dvec3, 3>& corners, double width) : width_(width) {
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 line = glm::cross(corners[k], corners[(k + 1) % 3]);
        const double length = std::sqrt(line.x * line.x + line.y * line.y);
        if (!(length > 0))
            continue;
        edges_[k].line = line / length;
        const glm::dvec3& opposite = corners[(k + 2) % 3];
        edges_[k].strength =
            opposite.z > 0 ? fade(std::abs(glm::dot(edges_[k].line, opposite)) / opposite.z, width) : 1;
    }
}

double Wireframe::coverage(double x, double y) const {
    double result = 0;
    for (const Edge& edge : edges_) {
        const double distance = std::abs(glm::dot(edge.line, glm::dvec3(x, y, 1)));
        result = std::max(result, edge.strength * std::clamp((width_ + 0.5) / 2 - distance + 0.25, 0.0, 1.0));
    }
    return result;
}

}  // namespace tessera

#include "testbench/compare/mesh_samples.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

std::uint32_t edge_parts(double parts) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(parts - 1e-3), 1.0, 1e6));  // s and t are floats
}

}  // namespace

MeshSamples::MeshSamples(const RecordedMesh& mesh, const glm::dvec2& map, double texel, std::uint64_t most) {
    std::vector<float> extents;
    extents.reserve(mesh.triangles.size());
    for (const RecordedMesh::Triangle& t : mesh.triangles) {
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t.vertices[k], b = t.vertices[(k + 1) % 3];
            const glm::dvec2 edge = glm::abs(mesh.textures[b] - mesh.textures[a]) * map;
            longest = std::max({longest, edge.x, edge.y});
            if (texel > 0)
                longest = std::max(longest, glm::length(mesh.positions[b] - mesh.positions[a]) / texel);
        }
        extents.push_back(static_cast<float>(std::min(longest, 1e9)));
    }
    const auto count = [&](double factor) {
        std::uint64_t sum = 0;
        for (const float extent : extents) {
            const std::uint64_t m = edge_parts(factor * static_cast<double>(extent));
            sum += m * m;
        }
        return sum;
    };
    if (count(1) > most) {
        double fits = 0, too_many = 1;
        for (int step = 0; step < 50; ++step) {
            const double middle = (fits + too_many) / 2;
            (count(middle) > most ? too_many : fits) = middle;
        }
        density_ = fits;
    }
    subdivisions_.reserve(extents.size());
    for (const float extent : extents)
        subdivisions_.push_back(edge_parts(density_ * static_cast<double>(extent)));
}

}  // namespace tessera

#include "testbench/bake/displaced_surface.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

/// Rounding must not select the side of a texel's edge: the hardware's coordinates are exact there.
bool on_edge(double t) {
    return std::abs(t - std::nearbyint(t)) < 1e-8;
}

}  // namespace

std::int64_t addressed(std::int64_t index, std::int64_t size, Addressing mode) {
    if (mode == Addressing::clamp)
        return std::clamp<std::int64_t>(index, 0, size - 1);
    if (index >= 0 && index < size)
        return index;
    const std::int64_t rest = index % size;
    return rest < 0 ? rest + size : rest;
}

glm::dvec2 texel_of(const BaseVertex& vertex, const BaseMesh& mesh, const HeightMap& map,
                    const DisplacementOf& displacement) {
    glm::dvec2 t = vertex.texture;
    if (mesh.beyond_map)
        return t * glm::dvec2(map.width, map.height);
    if (displacement.address_u == Addressing::clamp)
        t.x = std::clamp(t.x, 0.0, 1.0);
    if (displacement.address_v == Addressing::clamp)
        t.y = std::clamp(t.y, 0.0, 1.0);
    return t * glm::dvec2(map.width, map.height);
}

double texel_length(const BaseMesh& mesh, const HeightMap& map) {
    return (mesh.texture_scale.mean_u / map.width + mesh.texture_scale.mean_v / map.height) / 2;
}

DisplacedSurface::DisplacedSurface(const BaseMesh& mesh, const HeightMap& map, const DisplacementOf& displacement,
                                   const LocalFrame& frame)
    : mesh_(mesh), map_(map), displacement_(displacement), frame_(frame) {}

DisplacedSurface::Corners DisplacedSurface::corners(std::size_t triangle) const {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const BaseVertex& vertex = mesh_.vertices[mesh_.triangles[triangle][k]];
        corners.position[k] = frame_.to_local(vertex.position);
        corners.normal[k] = vertex.normal;
        corners.texel[k] = texel_of(vertex, mesh_, map_, displacement_);
    }
    corners.flat = corners.normal[0] == corners.normal[1] && corners.normal[1] == corners.normal[2];
    return corners;
}

double DisplacedSurface::value(const glm::dvec2& texel, Sampling sampling, unsigned below) const {
    const auto at = [&](std::int64_t x, std::int64_t y) {
        return static_cast<double>(map_.at(static_cast<int>(addressed(x, map_.width, displacement_.address_u)),
                                           static_cast<int>(addressed(y, map_.height, displacement_.address_v))));
    };
    if (sampling == Sampling::nearest_texel) {
        const auto index = [&](double t, Below side) {
            if (!on_edge(t))
                return static_cast<std::int64_t>(std::floor(t));
            return static_cast<std::int64_t>(std::nearbyint(t)) - ((below & side) != 0 ? 1 : 0);
        };
        return at(index(texel.x, below_u), index(texel.y, below_v));
    }
    const glm::dvec2 from_centre = texel - 0.5;
    const glm::dvec2 before = glm::floor(from_centre);
    const glm::dvec2 part = from_centre - before;
    const auto x = static_cast<std::int64_t>(before.x), y = static_cast<std::int64_t>(before.y);
    const double lower = (1 - part.x) * at(x, y) + part.x * at(x + 1, y);
    const double upper = (1 - part.x) * at(x, y + 1) + part.x * at(x + 1, y + 1);
    return (1 - part.y) * lower + part.y * upper;
}

std::uint8_t DisplacedSurface::steps_at(const glm::dvec2& texel) const {
    if (!on_edge(texel.x) && !on_edge(texel.y))
        return 0;
    const auto height = [&](unsigned below) { return value(texel, Sampling::nearest_texel, below); };
    const double here = height(0), left = height(below_u), down = height(below_v), both = height(below_u | below_v);
    return axes(left != here || both != down, down != here || both != left);
}

glm::dvec3 DisplacedSurface::point(const Corners& corners, const glm::dvec3& b, Sampling sampling,
                                   unsigned below) const {
    glm::dvec3 normal = corners.normal[0];
    if (!corners.flat) {
        normal = b.x * corners.normal[0] + b.y * corners.normal[1] + b.z * corners.normal[2];
        const double length = glm::length(normal);
        normal = length > 0 ? normal / length : glm::dvec3(0);
    }
    const glm::dvec3 base = b.x * corners.position[0] + b.y * corners.position[1] + b.z * corners.position[2];
    return base + displacement_.of(value(texel(corners, b), sampling, below)) * frame_.scale * normal;
}

}  // namespace tessera

#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>

#include "testbench/compare/measure_error.h"
#include "testbench/compare/mesh_samples.h"
#include "testbench/compare/reference_lattice.h"
#include "testbench/geometry/nearest_triangle.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

inline HeightMap make_map(int width, int height, const std::function<double(int, int)>& value) {
    HeightMap map;
    map.width = width;
    map.height = height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            map.values.push_back(static_cast<float>(value(x, y)));
    return map;
}

/// The base mesh as an emitted one, with its vertices moved by `moved`.
inline RecordedMesh emitted(const BaseMesh& base, const std::function<glm::dvec3(const BaseVertex&)>& moved) {
    RecordedMesh mesh;
    for (const BaseVertex& vertex : base.vertices) {
        mesh.positions.push_back(moved(vertex));
        mesh.normals.emplace_back(vertex.normal);
        mesh.textures.emplace_back(vertex.texture);
    }
    for (std::size_t k = 0; k < base.triangles.size(); ++k) {
        RecordedMesh::Triangle t;
        t.vertices = base.triangles[k];
        t.base = static_cast<std::uint32_t>(k);
        mesh.triangles.push_back(t);
    }
    return mesh;
}

inline RecordedMesh emitted(const BaseMesh& base) {
    return emitted(base, [](const BaseVertex& v) { return v.position; });
}

/// The figures of SurfaceError, computed by comparing everything with everything.
struct BruteForce {
    double reference_max = 0, reference_rms = 0, mesh_max = 0, mesh_rms = 0;
};

inline BruteForce brute_force(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                              const RecordedMesh& mesh, Sampling sampling, const MeasureLimits& limits = {}) {
    const DisplacedSurface surface(base, map, displacement, LocalFrame{});
    const ReferenceLattice lattice(surface, limits.reference_samples);
    const auto nearest = [](const std::vector<TriangleSoup::Corners>& soup, const glm::dvec3& p) {
        double squared = std::numeric_limits<double>::infinity();
        for (const auto& triangle : soup)
            squared = std::min(squared, squared_distance(triangle, p));
        return std::sqrt(squared);
    };
    std::vector<TriangleSoup::Corners> soup;
    for (const RecordedMesh::Triangle& t : mesh.triangles)
        soup.push_back(mesh.corners(t));

    BruteForce result;
    std::vector<TriangleSoup::Corners> facets;
    double squares = 0, weights = 0;
    // Goes through the lattice by points and facets, without its tiles.
    for (std::size_t k = 0; k < surface.triangles(); ++k) {
        const DisplacedSurface::Corners corners = surface.corners(k);
        const int n = static_cast<int>(lattice.subdivision(k));
        const auto& p = corners.position;
        const double area = glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / 2 / (n * n);
        // The point at b, with the map's value a millionth of the way towards `side`, in texels.
        const auto at = [&](const glm::dvec3& b, const glm::dvec2& side) {
            const auto &c = corners.position, &normals = corners.normal;
            const glm::dvec2 t = DisplacedSurface::texel(corners, b);
            const double value =
                surface.value(sampling == Sampling::interpolated ? t : t + 1e-6 * (side - t), sampling);
            const glm::dvec3 normal = glm::normalize(b.x * normals[0] + b.y * normals[1] + b.z * normals[2]);
            return b.x * c[0] + b.y * c[1] + b.z * c[2] + displacement.of(value) * normal;
        };
        const auto facet = [&](const std::array<std::array<int, 2>, 3>& places) {
            std::array<glm::dvec3, 3> b{}, f{};
            for (std::size_t c = 0; c < 3; ++c)
                b[c] = glm::dvec3(n - places[c][0] - places[c][1], places[c][0], places[c][1]) / static_cast<double>(n);
            const glm::dvec2 middle = DisplacedSurface::texel(corners, (b[0] + b[1] + b[2]) / 3.0);
            for (std::size_t c = 0; c < 3; ++c)
                f[c] = at(b[c], middle);
            facets.push_back(f);
            for (std::size_t c = 0; c < 3 && sampling == Sampling::nearest_texel; ++c)
                for (const int axis : {0, 1}) {
                    const std::size_t d = (c + 1) % 3;
                    const double line = std::round(DisplacedSurface::texel(corners, b[c])[axis]);
                    const auto off = [&](std::size_t e) { return DisplacedSurface::texel(corners, b[e])[axis] - line; };
                    if (std::max(std::abs(off(c)), std::abs(off(d))) > 1e-8 || middle[axis] > line)
                        continue;
                    glm::dvec2 beyond = middle;  // a wall from the facet below the line
                    beyond[axis] = 2 * line - middle[axis];
                    const std::array<glm::dvec3, 2> other{at(b[c], beyond), at(b[d], beyond)};
                    facets.push_back({f[c], f[d], other[1]});
                    facets.push_back({f[c], other[1], other[0]});
                }
            for (const glm::dvec3& point : f) {
                const double distance = nearest(soup, point);
                result.reference_max = std::max(result.reference_max, distance);
                squares += area / 3 * distance * distance;
                weights += area / 3;
            }
        };
        for (int j = 0; j < n; ++j)
            for (int i = 0; i + j < n; ++i) {
                facet({{{i, j}, {i + 1, j}, {i, j + 1}}});
                if (i + j + 1 < n)
                    facet({{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
            }
    }
    result.reference_rms = std::sqrt(squares / weights);

    const MeshSamples samples(mesh, glm::dvec2(map.width, map.height), texel_length(base, map), limits.mesh_samples);
    double mesh_squares = 0, areas = 0;
    for (std::size_t k = 0; k < soup.size(); ++k) {
        const auto& t = soup[k];
        const double area = glm::length(glm::cross(t[1] - t[0], t[2] - t[0])) / 2;
        const auto take = [&](const glm::dvec3& b) {
            const double distance = nearest(facets, b.x * t[0] + b.y * t[1] + b.z * t[2]);
            result.mesh_max = std::max(result.mesh_max, distance);
            return distance * distance;
        };
        for (const glm::dvec3& b : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1.0 / 3)})
            take(b);
        double sum = 0, count = 0;
        MeshSamples::for_each_part(samples.subdivision(k), [&](const glm::dvec3& b) {
            sum += take(b);
            ++count;
        });
        mesh_squares += area * sum / count;
        areas += area;
    }
    result.mesh_rms = std::sqrt(mesh_squares / areas);
    return result;
}

}  // namespace tessera

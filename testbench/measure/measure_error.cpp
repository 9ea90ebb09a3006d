#include "testbench/measure/measure_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "testbench/common/error.h"
#include "testbench/measure/mesh_samples.h"
#include "testbench/measure/reference_lattice.h"
#include "testbench/measure/reference_nearest.h"
#include "testbench/measure/reference_to_mesh.h"

namespace tessera {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// All positions, base and emitted, in about -1..1.
LocalFrame frame_about(const BaseMesh& base, const RecordedMesh& mesh) {
    BoxHierarchy::Box box;
    for (const BaseVertex& vertex : base.vertices)
        box.add(vertex.position);
    for (const glm::dvec3& position : mesh.positions)
        box.add(position);
    LocalFrame frame;
    if (base.vertices.empty() && mesh.positions.empty())
        return frame;
    frame.centre = box.low / 2.0 + box.high / 2.0;
    const glm::dvec3 half = box.high / 2.0 - box.low / 2.0;
    const double reach = std::max({half.x, half.y, half.z});
    if (reach > 0)
        frame.scale = std::ldexp(1.0, -std::ilogb(reach) - 1);
    return frame;
}

void check_base_numbers(const BaseMesh& base, const RecordedMesh& mesh) {
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
        if (mesh.triangles[k].base >= base.triangles.size())
            throw InputError(
                fmt::format("mesh.ply: triangle {} descends from base triangle {}, but the job's base mesh "
                            "has {}: the mesh is of "
                            "another job; run the job again",
                            k, mesh.triangles[k].base, base.triangles.size()));
}

/// What both ways to read the map share.
class Measurement {
  public:
    Measurement(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                const RecordedMesh& mesh, const MeasureLimits& limits)
        : mesh_(mesh),
          frame_(frame_about(base, mesh)),
          surface_(base, map, displacement, frame_),
          lattice_(surface_, limits.reference_samples),
          samples_(mesh, glm::dvec2(map.width, map.height), texel_length(base, map), limits.mesh_samples) {
        soup_.reserve(mesh.triangles.size());
        for (const RecordedMesh::Triangle& t : mesh.triangles) {
            const auto corners = mesh.corners(t);
            soup_.push_back(
                {frame_.to_local(corners[0]), frame_.to_local(corners[1]), frame_.to_local(corners[2])});
        }
    }

    double reference_density() const { return lattice_.density(); }
    double mesh_density() const { return samples_.density(); }

    SurfaceError measure(Sampling sampling) const {
        SurfaceError error;
        error.triangles.resize(mesh_.triangles.size());
        const std::vector<BoxHierarchy::Box> boxes = from_reference(sampling, error);
        from_mesh(sampling, boxes, error);
        return error;
    }

  private:
    WorstSpot spot(const glm::dvec3& local, const glm::dvec2& texture, std::size_t triangle) const {
        const RecordedMesh::Triangle& t = mesh_.triangles[triangle];
        return {frame_.to_model(local), texture, triangle, t.base, t.generation, t.split_by, t.stopped_by};
    }

    std::vector<BoxHierarchy::Box> from_reference(Sampling sampling, SurfaceError& error) const {
        DirectedError& result = error.reference_to_mesh;
        result.samples = lattice_.samples();
        if (soup_.empty() && surface_.triangles() > 0)
            result.max = result.rms = infinity;
        ReferenceToMesh walk(lattice_, sampling, soup_);
        std::vector<BoxHierarchy::Box> boxes;
        boxes.reserve(lattice_.tiles().size());
        double squares = 0, weights = 0, worst_squared = -1;
        ReferenceToMesh::Sample worst;
        for (std::size_t tile = 0; tile < lattice_.tiles().size(); ++tile) {
            double tile_squares = 0, tile_weights = 0;
            boxes.push_back(walk.measure(tile, [&](const ReferenceToMesh::Sample& sample) {
                tile_squares += sample.weight * sample.squared;
                tile_weights += sample.weight;
                float& triangle_max = error.triangles[sample.triangle].reference_max;
                triangle_max =
                    std::max(triangle_max, static_cast<float>(std::sqrt(sample.squared) / frame_.scale));
                if (sample.squared > worst_squared) {
                    worst_squared = sample.squared;
                    worst = sample;
                }
            }));
            squares += tile_squares;
            weights += tile_weights;
        }
        if (worst_squared >= 0) {
            result.max = std::sqrt(worst_squared) / frame_.scale;
            result.rms = weights > 0 ? std::sqrt(squares / weights) / frame_.scale : result.max;
            result.worst = spot(worst.position, worst.texture, worst.triangle);
        }
        return boxes;
    }

    void from_mesh(Sampling sampling, const std::vector<BoxHierarchy::Box>& boxes,
                   SurfaceError& error) const {
        DirectedError& result = error.mesh_to_reference;
        ReferenceNearest nearest(lattice_, sampling, boxes);
        double worst_squared = -1;
        const auto measure = [&](const glm::dvec3& local, const glm::dvec2& texture, std::size_t triangle) {
            const double squared = nearest.squared_distance(local);
            ++result.samples;
            if (squared > worst_squared) {
                worst_squared = squared;
                result.worst = spot(local, texture, triangle);
            }
            return squared;
        };
        error.vertices.assign(mesh_.positions.size(), -1);  // not yet measured
        double squares = 0, areas = 0;
        for (std::size_t k = 0; k < soup_.size(); ++k) {
            const RecordedMesh::Triangle& t = mesh_.triangles[k];
            const auto texture = [&](const glm::dvec3& b) {
                return b.x * mesh_.textures[t.vertices[0]] + b.y * mesh_.textures[t.vertices[1]] +
                       b.z * mesh_.textures[t.vertices[2]];
            };
            const auto position = [&](const glm::dvec3& b) {
                return b.x * soup_[k][0] + b.y * soup_[k][1] + b.z * soup_[k][2];
            };
            double largest = 0, triangle_squares = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                double& vertex = error.vertices[t.vertices[c]];
                if (vertex < 0)
                    vertex = std::sqrt(measure(soup_[k][c], mesh_.textures[t.vertices[c]], k)) / frame_.scale;
                largest = std::max(largest, vertex);
            }
            double largest_squared = 0;
            const std::uint32_t parts = samples_.subdivision(k);
            const auto take = [&](const glm::dvec3& b) {
                const double squared = measure(position(b), texture(b), k);
                largest_squared = std::max(largest_squared, squared);
                return squared;
            };
            if (parts % 3 == 0)  // else it is the centroid of a part
                take(glm::dvec3(1.0 / 3));
            MeshSamples::for_each_part(parts, [&](const glm::dvec3& b) { triangle_squares += take(b); });
            const double count = static_cast<double>(parts) * static_cast<double>(parts);
            const double area = glm::length(glm::cross(soup_[k][1] - soup_[k][0], soup_[k][2] - soup_[k][0]));
            squares += area * (triangle_squares / count);
            areas += area;
            largest = std::max(largest, std::sqrt(largest_squared) / frame_.scale);
            error.triangles[k].max = static_cast<float>(largest);
            error.triangles[k].rms = static_cast<float>(std::sqrt(triangle_squares / count) / frame_.scale);
        }
        for (double& vertex : error.vertices)
            vertex = std::max(vertex, 0.0);  // of no triangle
        if (worst_squared >= 0) {
            result.max = std::sqrt(worst_squared) / frame_.scale;
            // a mesh without area has no more weight in one place than in another: its worst
            result.rms = areas > 0 ? std::sqrt(squares / areas) / frame_.scale : result.max;
        }
    }

    const RecordedMesh& mesh_;
    LocalFrame frame_;
    DisplacedSurface surface_;
    ReferenceLattice lattice_;
    MeshSamples samples_;
    TriangleSoup soup_;
};

}  // namespace

SurfaceError measure_surface_error(const BaseMesh& base, const HeightMap& map,
                                   const DisplacementOf& displacement, const RecordedMesh& mesh,
                                   Sampling sampling, const MeasureLimits& limits) {
    check_base_numbers(base, mesh);
    return Measurement(base, map, displacement, mesh, limits).measure(sampling);
}

MeshError measure_error(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                        const RecordedMesh& mesh, const MeasureLimits& limits) {
    check_base_numbers(base, mesh);
    MeshError error;
    const Measurement measurement(base, map, displacement, mesh, limits);
    error.texel = texel_length(base, map);
    error.reference_density = measurement.reference_density();
    error.mesh_density = measurement.mesh_density();
    error.interpolated = measurement.measure(Sampling::interpolated);
    error.nearest_texel = measurement.measure(Sampling::nearest_texel);
    if (const auto field = find_height_field(base, map, displacement, error.no_vertical))
        error.vertical = measure_vertical_error(*field, base, map, displacement, mesh);
    return error;
}

}  // namespace tessera

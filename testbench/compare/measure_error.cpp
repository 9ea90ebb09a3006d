#include "testbench/compare/measure_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

#include "testbench/common/error.h"
#include "testbench/common/parallel.h"
#include "testbench/compare/mesh_samples.h"
#include "testbench/compare/reference_lattice.h"
#include "testbench/compare/reference_nearest.h"
#include "testbench/compare/reference_to_mesh.h"
#include "testbench/geometry/nearest_triangle.h"

namespace tessera {
namespace {

constexpr std::size_t chunk_tiles = 32, chunk_triangles = 256;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Maps all positions, base and emitted, to about -1..1.
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
                            "has {}: the mesh belongs to "
                            "another job; run the job again",
                            k, mesh.triangles[k].base, base.triangles.size()));
}

/// Data shared by both sampling methods.
class Measurement {
  public:
    Measurement(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                const RecordedMesh& mesh, const MeasureLimits& limits)
        : mesh_(mesh),
          limits_(limits),
          beyond_u_(base.beyond_map && displacement.address_u == Addressing::clamp),
          beyond_v_(base.beyond_map && displacement.address_v == Addressing::clamp),
          frame_(frame_about(base, mesh)),
          surface_(base, map, displacement, frame_),
          lattice_(surface_, limits.reference_samples),
          samples_(mesh, glm::dvec2(map.width, map.height), texel_length(base, map), limits.mesh_samples) {
        soup_.reserve(mesh.triangles.size());
        for (const RecordedMesh::Triangle& t : mesh.triangles) {
            const auto corners = mesh.corners(t);
            soup_.push_back({frame_.to_local(corners[0]), frame_.to_local(corners[1]), frame_.to_local(corners[2])});
        }
        if (!soup_.empty())
            nearest_.emplace(soup_);
    }

    double reference_density() const { return lattice_.density(); }
    double mesh_density() const { return samples_.density(); }
    std::uint64_t samples_beyond_map(const SurfaceError& measured) const {
        return lattice_.samples() - measured.reference_to_mesh.samples;
    }

    SurfaceError measure(Sampling sampling) {
        SurfaceError error;
        error.triangles.resize(mesh_.triangles.size());
        const std::vector<BoxHierarchy::Box> boxes = from_reference(sampling, error);
        ++walks_;
        from_mesh(sampling, boxes, error);
        ++walks_;
        return error;
    }

  private:
    /// Whether a sample counts: it lies on the map.
    bool on_map(const glm::dvec2& texture) const {
        constexpr double border = 1 + 1e-9;
        return !(beyond_u_ && texture.x > border) && !(beyond_v_ && texture.y > border);
    }

    std::uint64_t lattice_samples() const {
        if (!beyond_u_ && !beyond_v_)
            return lattice_.samples();
        std::uint64_t count = 0;
        for (std::size_t k = 0; k < surface_.triangles(); ++k) {
            const DisplacedSurface::Corners corners = surface_.corners(k);
            const std::uint32_t n = lattice_.subdivision(k);
            for (std::uint32_t j = 0; j <= n; ++j)
                for (std::uint32_t i = 0; i + j <= n; ++i)
                    if (on_map(surface_.texture(
                            DisplacedSurface::texel(corners, glm::dvec3(n - i - j, i, j) / static_cast<double>(n)))))
                        ++count;
        }
        return count;
    }

    /// The largest squared distance and where it is; the first of equal ones.
    struct Worst {
        double squared = -1;
        glm::dvec3 position{0};
        glm::dvec2 texture{0};
        std::size_t triangle = 0;

        void take(double other, const glm::dvec3& at, const glm::dvec2& t, std::size_t of) {
            if (other > squared)
                *this = {other, at, t, of};
        }
    };

    void conclude(DirectedError& result, const Worst& worst, double squares, double weights) const {
        if (worst.squared < 0)
            return;
        result.max = std::sqrt(worst.squared) / frame_.scale;
        // a mesh without area has no weights: its maximum
        result.rms = weights > 0 ? std::sqrt(squares / weights) / frame_.scale : result.max;
        const RecordedMesh::Triangle& t = mesh_.triangles[worst.triangle];
        result.worst = {frame_.to_model(worst.position),
                        worst.texture,
                        worst.triangle,
                        t.base,
                        t.generation,
                        t.split_by,
                        t.stopped_by};
    }

    struct ReferencePart {
        std::vector<double> squares, weights;  // by tile
        Worst worst;
    };

    std::vector<BoxHierarchy::Box> from_reference(Sampling sampling, SurfaceError& error) {
        DirectedError& result = error.reference_to_mesh;
        result.samples = lattice_samples();
        if (soup_.empty() && surface_.triangles() > 0)
            result.max = result.rms = infinity;
        const std::size_t tiles = lattice_.tiles().size();
        std::vector<BoxHierarchy::Box> boxes(tiles);
        std::vector<ReferencePart> parts((tiles + chunk_tiles - 1) / chunk_tiles);
        std::mutex merging;
        share_chunks(parts.size(), [&](const NextChunk& next) {
            ReferenceToMesh walk(lattice_, sampling, soup_, nearest_ ? &*nearest_ : nullptr);
            std::vector<float> largest(mesh_.triangles.size(), 0);
            for (std::size_t chunk; next(chunk); advance(chunk, parts.size())) {
                ReferencePart& part = parts[chunk];
                const std::size_t end = std::min(tiles, (chunk + 1) * chunk_tiles);
                for (std::size_t tile = chunk * chunk_tiles; tile < end; ++tile) {
                    double squares = 0, weights = 0;
                    boxes[tile] = walk.measure(tile, [&](const ReferenceToMesh::Sample& sample) {
                        float& of_triangle = largest[sample.triangle];
                        of_triangle =
                            std::max(of_triangle, static_cast<float>(std::sqrt(sample.squared) / frame_.scale));
                        if (!on_map(sample.texture))
                            return;
                        squares += sample.weight * sample.squared;
                        weights += sample.weight;
                        part.worst.take(sample.squared, sample.position, sample.texture, sample.triangle);
                    });
                    part.squares.push_back(squares);
                    part.weights.push_back(weights);
                }
            }
            const std::lock_guard<std::mutex> lock(merging);
            for (std::size_t k = 0; k < largest.size(); ++k)
                error.triangles[k].reference_max = std::max(error.triangles[k].reference_max, largest[k]);
        });
        double squares = 0, weights = 0;
        Worst worst;
        for (const ReferencePart& part : parts) {
            for (std::size_t k = 0; k < part.squares.size(); ++k) {
                squares += part.squares[k];
                weights += part.weights[k];
            }
            worst.take(part.worst.squared, part.worst.position, part.worst.texture, part.worst.triangle);
        }
        conclude(result, worst, squares, weights);
        return boxes;
    }

    struct MeshPart {
        double squares = 0, areas = 0;
        std::uint64_t samples = 0;
        Worst worst;
    };

    void from_mesh(Sampling sampling, const std::vector<BoxHierarchy::Box>& boxes, SurfaceError& error) {
        DirectedError& result = error.mesh_to_reference;
        error.vertices.assign(mesh_.positions.size(), 0);
        constexpr std::size_t nobody = SIZE_MAX;
        std::vector<std::size_t> first_user(mesh_.positions.size(),
                                            nobody);  // the triangle that measures each vertex
        for (std::size_t k = soup_.size(); k-- > 0;)
            for (const std::uint32_t vertex : mesh_.triangles[k].vertices)
                first_user[vertex] = k;
        std::vector<MeshPart> parts((soup_.size() + chunk_triangles - 1) / chunk_triangles);
        share_chunks(parts.size(), [&](const NextChunk& next) {
            ReferenceNearest nearest(lattice_, sampling, boxes);
            for (std::size_t chunk; next(chunk); advance(chunk, parts.size())) {
                const std::size_t end = std::min(soup_.size(), (chunk + 1) * chunk_triangles);
                for (std::size_t k = chunk * chunk_triangles; k < end; ++k)
                    measure_triangle(k, nearest, first_user, parts[chunk], error);
            }
        });
        double squares = 0, areas = 0;
        Worst worst;
        for (const MeshPart& part : parts) {
            squares += part.squares;
            areas += part.areas;
            result.samples += part.samples;
            worst.take(part.worst.squared, part.worst.position, part.worst.texture, part.worst.triangle);
        }
        for (std::size_t k = 0; k < soup_.size(); ++k)
            for (const std::uint32_t vertex : mesh_.triangles[k].vertices)
                error.triangles[k].max = std::max(error.triangles[k].max, static_cast<float>(error.vertices[vertex]));
        conclude(result, worst, squares, areas);
    }

    /// Measures the vertices that triangle k is the first to use, its centroid and its parts.
    void measure_triangle(std::size_t k, ReferenceNearest& nearest, const std::vector<std::size_t>& first_user,
                          MeshPart& part, SurfaceError& error) const {
        const RecordedMesh::Triangle& t = mesh_.triangles[k];
        const auto& corners = soup_[k];
        const auto measure = [&](const glm::dvec3& local, const glm::dvec2& texture) {
            const double squared = nearest.squared_distance(local);
            if (on_map(texture)) {
                ++part.samples;
                part.worst.take(squared, local, texture, k);
            }
            return squared;
        };
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t vertex = t.vertices[c];
            const bool earlier = std::find(t.vertices.begin(), t.vertices.begin() + c, vertex) !=
                                 t.vertices.begin() + c;  // a degenerate triangle may have a vertex twice
            if (first_user[vertex] == k && !earlier)
                error.vertices[vertex] = std::sqrt(measure(corners[c], mesh_.textures[vertex])) / frame_.scale;
        }
        double largest_squared = 0, squares = 0, squares_on_map = 0, count_on_map = 0;
        const auto texture = [&](const glm::dvec3& b) {
            return b.x * mesh_.textures[t.vertices[0]] + b.y * mesh_.textures[t.vertices[1]] +
                   b.z * mesh_.textures[t.vertices[2]];
        };
        const auto take = [&](const glm::dvec3& b) {
            const double squared = measure(b.x * corners[0] + b.y * corners[1] + b.z * corners[2], texture(b));
            largest_squared = std::max(largest_squared, squared);
            return squared;
        };
        const std::uint32_t sides = samples_.subdivision(k);
        if (sides % 3 == 0)  // otherwise it is the centroid of a part
            take(glm::dvec3(1.0 / 3));
        MeshSamples::for_each_part(sides, [&](const glm::dvec3& b) {
            const double squared = take(b);
            squares += squared;
            if (on_map(texture(b))) {
                squares_on_map += squared;
                ++count_on_map;
            }
        });
        const double count = static_cast<double>(sides) * static_cast<double>(sides);
        const double area = glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
        part.squares += area * (squares_on_map / count);
        part.areas += count_on_map == count ? area : area * (count_on_map / count);
        error.triangles[k].max = static_cast<float>(std::sqrt(largest_squared) / frame_.scale);
        error.triangles[k].rms = static_cast<float>(std::sqrt(squares / count) / frame_.scale);
    }

    /// Reports progress over four walks. Has an effect on the first thread only.
    void advance(std::size_t chunk, std::size_t chunks) const {
        if (limits_.progress && std::this_thread::get_id() == thread_)
            limits_.progress((walks_ + static_cast<double>(chunk + 1) / static_cast<double>(chunks)) / 4);
    }

    const RecordedMesh& mesh_;
    MeasureLimits limits_;
    bool beyond_u_, beyond_v_;  // the base mesh may extend beyond the map, which clamps
    LocalFrame frame_;
    DisplacedSurface surface_;
    ReferenceLattice lattice_;
    MeshSamples samples_;
    TriangleSoup soup_;
    std::optional<NearestTriangle> nearest_;  // if the mesh has triangles
    std::thread::id thread_ = std::this_thread::get_id();
    int walks_ = 0;  // done
};

}  // namespace

SurfaceError measure_surface_error(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                                   const RecordedMesh& mesh, Sampling sampling, const MeasureLimits& limits) {
    check_base_numbers(base, mesh);
    return Measurement(base, map, displacement, mesh, limits).measure(sampling);
}

MeshError measure_error(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                        const RecordedMesh& mesh, const MeasureLimits& limits) {
    check_base_numbers(base, mesh);
    MeshError error;
    Measurement measurement(base, map, displacement, mesh, limits);
    error.texel = texel_length(base, map);
    error.reference_density = measurement.reference_density();
    error.mesh_density = measurement.mesh_density();
    error.interpolated = measurement.measure(Sampling::interpolated);
    error.beyond_map = measurement.samples_beyond_map(error.interpolated);
    error.nearest_texel = measurement.measure(Sampling::nearest_texel);
    if (const auto field = find_height_field(base, map, displacement, error.no_vertical))
        error.vertical = measure_vertical_error(*field, base, map, displacement, mesh, limits.view);
    return error;
}

}  // namespace tessera

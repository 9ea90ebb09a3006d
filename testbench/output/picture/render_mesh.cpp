#include "testbench/output/picture/render_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "testbench/common/distinct_table.h"
#include "testbench/output/report/mesh_units.h"

namespace tessera {
namespace {

/// Finds a vertex among earlier ones.
class VertexIndex {
  public:
    explicit VertexIndex(RenderMesh& mesh) : mesh_(mesh) {}

    std::uint32_t index_of(const glm::vec3& position, const glm::vec3& normal) {
        const std::uint32_t index = table_.number_of(
            point_hash(position),
            [&](std::uint32_t v) { return mesh_.positions[v] == position && mesh_.normals[v] == normal; },
            [&](std::uint32_t v) { return point_hash(mesh_.positions[v]); });
        if (index == mesh_.positions.size()) {
            mesh_.positions.push_back(position);
            mesh_.normals.push_back(normal);
        }
        return index;
    }

  private:
    RenderMesh& mesh_;
    DistinctTable table_;
};

/// Takes triangles with corners of their own. The same numbers in the same order give the same mesh.
class MeshMaker {
  public:
    struct Corner {
        glm::dvec3 position;
        glm::vec3 normal;
    };

    /// `low`, `high`: the bounding box of all positions.
    MeshMaker(const glm::dvec3& low, const glm::dvec3& high, std::size_t triangles) : index_(mesh_) {
        // A multiple of the mesh's size, rounded: 0 for a mesh about 0, so that its numbers stay what they are.
        const glm::dvec3 size = high - low;
        const double largest = std::max({size.x, size.y, size.z});
        if (largest > 0) {
            const double step = std::ldexp(1.0, std::ilogb(largest) + 1);
            for (int k = 0; k < 3; ++k)
                mesh_.origin[k] = std::nearbyint((low[k] / 2 + high[k] / 2) / step) * step;
        } else {
            mesh_.origin = low;
        }
        mesh_.triangles.reserve(triangles);
        bases_.reserve(triangles);
    }

    void add(const std::array<Corner, 3>& corners, std::uint8_t generation, std::uint8_t split_by,
             std::uint8_t stopped_by, std::uint32_t base) {
        RenderMesh::Triangle triangle;
        for (std::size_t k = 0; k < 3; ++k)
            triangle.vertices[k] = index_.index_of(glm::vec3(corners[k].position - mesh_.origin), corners[k].normal);
        triangle.generation = generation;
        triangle.deciding_test = deciding_test_of(split_by);
        triangle.stopped_by = stopped_by;
        mesh_.triangles.push_back(triangle);
        bases_.push_back(base);
    }

    RenderMesh finish() {
        std::sort(bases_.begin(), bases_.end());
        mesh_.base_triangles = static_cast<std::uint64_t>(std::unique(bases_.begin(), bases_.end()) - bases_.begin());
        return std::move(mesh_);
    }

  private:
    RenderMesh mesh_;
    VertexIndex index_;
    std::vector<std::uint32_t> bases_;
};

class Bounds {
  public:
    void include(const glm::dvec3& position) {
        low = some_ ? glm::min(low, position) : position;
        high = some_ ? glm::max(high, position) : position;
        some_ = true;
    }

    glm::dvec3 low{0}, high{0};

  private:
    bool some_ = false;
};

}  // namespace

RenderMesh make_render_mesh(const EmittedMesh& mesh, const MachineSetup& setup) {
    const MeshUnits units{setup.registers.formats, setup.registers.map, setup.model_scale.scale,
                          setup.model_scale.centre};
    Bounds bounds;
    for (const EmittedTriangle& triangle : mesh.triangles)
        if (!triangle.culled)
            for (const EmittedTriangle::Corner& corner : triangle.corners)
                bounds.include(units.position(corner.displaced));
    MeshMaker maker(bounds.low, bounds.high, mesh.triangles.size());
    for (const EmittedTriangle& from : mesh.triangles) {
        if (from.culled)
            continue;
        std::array<MeshMaker::Corner, 3> corners;
        std::uint8_t generation = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const EmittedTriangle::Corner& corner = from.corners[k];
            corners[k] = {units.position(corner.displaced), units.normal(corner.displaced_normal)};
            generation = std::max(generation, corner.generation);
        }
        maker.add(corners, generation, from.split_by, from.stopped_by, from.base);
    }
    return maker.finish();
}

RenderMesh make_render_mesh(const RecordedMesh& mesh) {
    Bounds bounds;
    for (const RecordedMesh::Triangle& triangle : mesh.triangles)
        for (const glm::dvec3& position : mesh.corners(triangle))
            bounds.include(position);
    MeshMaker maker(bounds.low, bounds.high, mesh.triangles.size());
    for (const RecordedMesh::Triangle& from : mesh.triangles) {
        std::array<MeshMaker::Corner, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = {mesh.positions[from.vertices[k]], mesh.normals[from.vertices[k]]};
        maker.add(corners, from.generation, from.split_by, from.stopped_by, from.base);
    }
    return maker.finish();
}

}  // namespace tessera

#include "testbench/render/render_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tessera {
namespace {

glm::vec3 to_vector(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

/// Finds a vertex among those met before: open addressing, so that a million triangles take a few megabytes.
class VertexIndex {
  public:
    explicit VertexIndex(RenderMesh& mesh) : mesh_(mesh), slots_(1024, empty) {}

    std::uint32_t index_of(const glm::vec3& position, const glm::vec3& normal) {
        if (2 * mesh_.positions.size() >= slots_.size())
            grow();
        std::uint32_t& slot = find(position, normal);
        if (slot == empty) {
            slot = static_cast<std::uint32_t>(mesh_.positions.size());
            mesh_.positions.push_back(position);
            mesh_.normals.push_back(normal);
        }
        return slot;
    }

  private:
    static constexpr std::uint32_t empty = UINT32_MAX;

    static std::uint64_t hash(const glm::vec3& p) {
        std::uint64_t result = 0;
        for (int k = 0; k < 3; ++k)
            result = (result ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(std::ldexp(p[k], 20)))) *
                     0x9E3779B97F4A7C15u;
        return result ^ (result >> 32);
    }

    std::uint32_t& find(const glm::vec3& position, const glm::vec3& normal) {
        const std::size_t mask = slots_.size() - 1;
        std::size_t i = static_cast<std::size_t>(hash(position)) & mask;
        while (slots_[i] != empty &&
               !(mesh_.positions[slots_[i]] == position && mesh_.normals[slots_[i]] == normal))
            i = (i + 1) & mask;
        return slots_[i];
    }

    void grow() {
        slots_.assign(2 * slots_.size(), empty);
        for (std::uint32_t i = 0; i < mesh_.positions.size(); ++i)
            find(mesh_.positions[i], mesh_.normals[i]) = i;
    }

    RenderMesh& mesh_;
    std::vector<std::uint32_t> slots_;
};

}  // namespace

RenderMesh make_render_mesh(const EmittedMesh& mesh, const Setup& setup) {
    RenderMesh result;
    result.origin = setup.model_scale.centre;
    result.base_triangles = setup.base_triangles.size();
    result.triangles.reserve(mesh.triangles.size());
    const datapath::Formats& formats = setup.registers.formats;
    const double position_lsb = std::ldexp(1.0, -formats.position.fraction) / setup.model_scale.scale;
    const double normal_lsb = std::ldexp(1.0, -formats.normal.fraction);
    VertexIndex index(result);
    for (const EmittedTriangle& from : mesh.triangles) {
        RenderMesh::Triangle to;
        for (std::size_t k = 0; k < 3; ++k) {
            const EmittedTriangle::Corner& corner = from.corners[k];
            const datapath::Position& p = corner.displaced;
            const datapath::Direction& n = corner.displaced_normal;
            to.vertices[k] =
                index.index_of(to_vector(p.x * position_lsb, p.y * position_lsb, p.z * position_lsb),
                               to_vector(n.x * normal_lsb, n.y * normal_lsb, n.z * normal_lsb));
            to.generation = std::max(to.generation, corner.generation);
        }
        to.deciding_test = static_cast<DecidingTest>(from.split_by & 3);
        result.triangles.push_back(to);
    }
    return result;
}

}  // namespace tessera

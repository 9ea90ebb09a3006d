#include "testbench/setup/mesh/whole_periods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "testbench/setup/mesh/equal_groups.h"

namespace tessera {

namespace {

/// Disjoint sets of vertices.
class Charts {
  public:
    explicit Charts(const BaseMesh& mesh) : parent_(mesh.vertices.size()) {
        std::iota(parent_.begin(), parent_.end(), 0u);
        const std::vector<std::uint32_t> first = first_equal(mesh.vertices, [](const BaseVertex& v) {
            const PositionKey p = position_key(v.position);
            return std::array{p[0], p[1], p[2], alike_bits(v.texture.x), alike_bits(v.texture.y)};
        });
        for (std::uint32_t v = 0; v < first.size(); ++v)
            join(v, first[v]);
        for (const auto& triangle : mesh.triangles) {
            join(triangle[0], triangle[1]);
            join(triangle[1], triangle[2]);
        }
    }

    std::uint32_t of(std::uint32_t vertex) {
        while (parent_[vertex] != vertex)
            vertex = parent_[vertex] = parent_[parent_[vertex]];
        return vertex;
    }

  private:
    void join(std::uint32_t a, std::uint32_t b) {
        a = of(a);
        b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    std::vector<std::uint32_t> parent_;
};

struct Extent {
    glm::dvec2 low{0}, high{0};
    bool any = false;

    void add(const glm::dvec2& t) {
        low = any ? glm::min(low, t) : t;
        high = any ? glm::max(high, t) : t;
        any = true;
    }
};

/// The shift that brings the lowest coordinate into 0..1 on repeated axes.
glm::dvec2 shift_of(const Extent& extent, const glm::bvec2& repeats) {
    return {repeats.x ? -std::floor(extent.low.x) : 0.0, repeats.y ? -std::floor(extent.low.y) : 0.0};
}

}  // namespace

BaseMesh bring_down_texture(BaseMesh mesh, const glm::bvec2& repeats, const glm::dvec2& most) {
    if (!repeats.x && !repeats.y)
        return mesh;
    Charts charts(mesh);
    std::vector<Extent> extents(mesh.vertices.size());
    for (std::uint32_t v = 0; v < extents.size(); ++v)
        extents[charts.of(v)].add(mesh.vertices[v].texture);
    const auto fits = [&](const Extent& extent) {
        const glm::dvec2 high = extent.high + shift_of(extent, repeats);
        return (!repeats.x || high.x <= most.x) && (!repeats.y || high.y <= most.y);
    };

    // Triangles of charts that do not fit, before coordinates are changed.
    std::map<std::pair<std::uint32_t, std::array<double, 2>>, std::uint32_t> moved;
    const std::size_t whole = mesh.vertices.size();
    for (auto& triangle : mesh.triangles) {
        if (fits(extents[charts.of(triangle[0])]))
            continue;
        Extent extent;
        for (const std::uint32_t corner : triangle)
            extent.add(mesh.vertices[corner].texture);
        const glm::dvec2 shift = shift_of(extent, repeats);
        for (std::uint32_t& corner : triangle) {
            const auto [place, made] =
                moved.try_emplace({corner, {shift.x, shift.y}}, static_cast<std::uint32_t>(mesh.vertices.size()));
            if (made) {
                BaseVertex vertex = mesh.vertices[corner];
                vertex.texture += shift;
                mesh.vertices.push_back(vertex);
            }
            corner = place->second;
        }
    }
    for (std::uint32_t v = 0; v < whole; ++v) {
        Extent extent = extents[charts.of(v)];
        if (!fits(extent)) {  // no triangle uses this vertex any more
            extent = {};
            extent.add(mesh.vertices[v].texture);
        }
        mesh.vertices[v].texture += shift_of(extent, repeats);
    }
    return mesh;
}

}  // namespace tessera

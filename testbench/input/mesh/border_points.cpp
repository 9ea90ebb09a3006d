#include "testbench/input/mesh/border_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/setup/mesh/equal_groups.h"
#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera {

namespace {

constexpr double joined_within = 1e-6, near_within = 1e-4, shortest_edge = 8;

/// Finds the nearest of the points added so far.
class NearPoints {
  public:
    explicit NearPoints(double reach) : reach_(reach) {}

    void add(std::uint32_t point, const glm::dvec3& position) {
        cells_[hash_of(cell_of(position))].push_back({point, position});
    }

    /// `none` if none is nearer than the reach.
    std::uint32_t nearest(const glm::dvec3& position, double& distance) {
        std::uint32_t found = none;
        distance = reach_;
        const glm::dvec3 centre = cell_of(position);
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) {
                    const auto cell = cells_.find(hash_of(centre + glm::dvec3(x, y, z)));
                    if (cell == cells_.end())
                        continue;
                    steps_ += cell->second.size();
                    for (const Point& point : cell->second)
                        if (const double here = safe_length(point.position - position); here < distance) {
                            distance = here;
                            found = point.index;
                        }
                }
        return found;
    }

    std::uint64_t steps() const { return steps_; }

    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  private:
    struct Point {
        std::uint32_t index;
        glm::dvec3 position;
    };

    glm::dvec3 cell_of(const glm::dvec3& position) const { return glm::floor(position / reach_); }
    static std::uint64_t hash_of(const glm::dvec3& cell) {
        std::uint64_t hash = 0;
        for (const std::uint64_t word : position_key(cell))
            hash = mix_hash(hash, word);
        return hash;
    }

    double reach_;
    std::uint64_t steps_ = 0;
    std::unordered_map<std::uint64_t, std::vector<Point>> cells_;  // by the cell's hash
};

/// Of each point, the length of its shortest edge.
std::vector<double> shortest_edges(const BaseMesh& mesh, const std::vector<std::uint32_t>& points) {
    std::vector<double> shortest(mesh.vertices.size(), std::numeric_limits<double>::infinity());
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = points[t[k]], b = points[t[(k + 1) % 3]];
            const double length = safe_length(mesh.vertices[a].position - mesh.vertices[b].position);
            shortest[a] = std::min(shortest[a], length);
            shortest[b] = std::min(shortest[b], length);
        }
    return shortest;
}

}  // namespace

void join_border_points(BaseMesh& mesh, Surface& surface) {
    std::vector<std::uint32_t> border;
    for (const auto& edge : surface.border)
        border.insert(border.end(), edge.begin(), edge.end());
    std::sort(border.begin(), border.end());
    border.erase(std::unique(border.begin(), border.end()), border.end());
    const auto [low, high] = bounds_of(mesh.vertices);
    const glm::dvec3 sides = high - low;
    const double size = std::max({sides.x, sides.y, sides.z});
    const std::vector<double> shortest = shortest_edges(mesh, surface.points);
    std::vector<std::uint32_t> joined = surface.points;
    std::size_t joins = 0, near = 0;
    NearPoints kept(near_within * size);
    std::size_t searched = 0;
    for (; searched < border.size() && kept.steps() < largest_search; ++searched) {
        const std::uint32_t point = border[searched];
        if (shortest[point] < shortest_edge * joined_within * size)
            continue;
        const glm::dvec3 position = mesh.vertices[point].position - low;
        double distance = 0;
        const std::uint32_t other = kept.nearest(position, distance);
        if (other != NearPoints::none && distance <= joined_within * size) {
            joined[point] = other;
            ++joins;
            continue;
        }
        kept.add(point, position);
        if (other != NearPoints::none &&
            std::min(shortest[point], shortest[other]) >= shortest_edge * near_within * size)
            ++near;
    }
    if (joins > 0) {
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
            mesh.vertices[i].position = mesh.vertices[joined[surface.points[i]]].position;
        surface = surface_of(mesh);
        mesh.repairs.push_back(
            fmt::format("{} point(s) of the border lay within {:.3g} of another, and were joined to it.", joins,
                        joined_within * size));
    }
    if (near > 0)
        mesh.repairs.push_back(fmt::format(
            "{} point(s) of the border lie within {:.3g} of another: the displaced surface opens there. If they "
            "are one point, merge them by distance in the program that exported the mesh.",
            near, near_within * size));
    if (searched < border.size())
        mesh.repairs.push_back(
            fmt::format("The search for points near one another was stopped after {} of {} of the border.", searched,
                        border.size()));
}

}  // namespace tessera

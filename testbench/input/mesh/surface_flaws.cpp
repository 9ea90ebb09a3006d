#include "testbench/input/mesh/surface_flaws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "testbench/setup/mesh/equal_groups.h"
#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera {
namespace {

constexpr double same_normal = 1e-5;  // files often have six decimals; no format of normals distinguishes more
constexpr double on_edge = 1e-4;      // relative to the edge's length

struct BorderPoint {
    glm::dvec3 position;
    std::uint32_t index;
};

/// Finds points on a segment with a k-d tree.
class PointsOnSegments {
  public:
    explicit PointsOnSegments(std::vector<BorderPoint> points) : points_(std::move(points)) {
        build(0, points_.size(), 0);
    }

    /// Whether a point other than a and b lies on the segment between them.
    bool any_between(const BorderPoint& a, const BorderPoint& b) {
        const Segment segment{a, b, b.position - a.position, safe_length(b.position - a.position)};
        return segment.length > 0 && any(segment, 0, points_.size(), 0, 0, 1);
    }

    std::uint64_t steps() const { return steps_; }

  private:
    struct Segment {
        const BorderPoint &a, &b;
        glm::dvec3 along;
        double length;
    };

    void build(std::size_t low, std::size_t high, int axis) {
        if (high - low < 2)
            return;
        const std::size_t middle = low + (high - low) / 2;
        const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(low), at(middle), at(high), [axis](const BorderPoint& a, const BorderPoint& b) {
            return a.position[axis] < b.position[axis];
        });
        build(low, middle, (axis + 1) % 3);
        build(middle + 1, high, (axis + 1) % 3);
    }

    static bool is_on(const Segment& segment, const BorderPoint& point) {
        if (point.index == segment.a.index || point.index == segment.b.index)
            return false;
        const glm::dvec3 direction = segment.along / segment.length;
        const glm::dvec3 offset = (point.position - segment.a.position) / segment.length;
        const double t = glm::dot(offset, direction);
        return t > on_edge && t < 1 - on_edge && safe_length(offset - direction * t) <= on_edge;
    }

    /// Searches a cell that the segment crosses between parameters t0 and t1.
    bool any(const Segment& segment, std::size_t low, std::size_t high, int axis, double t0, double t1) {
        if (low >= high || t0 > t1)
            return false;
        ++steps_;
        const std::size_t middle = low + (high - low) / 2;
        if (is_on(segment, points_[middle]))
            return true;
        const double plane = points_[middle].position[axis] - segment.a.position[axis];
        const double speed = segment.along[axis], slack = on_edge * segment.length;
        double low_t0 = t0, low_t1 = t1, high_t0 = t0, high_t1 = t1;
        if (speed == 0) {
            low_t1 = plane >= -slack ? t1 : -1;
            high_t1 = plane <= slack ? t1 : -1;
        } else {
            const double reaches = (plane + slack) / speed, leaves = (plane - slack) / speed;
            if (speed > 0) {
                low_t1 = std::min(t1, reaches);
                high_t0 = std::max(t0, leaves);
            } else {
                low_t0 = std::max(t0, reaches);
                high_t1 = std::min(t1, leaves);
            }
        }
        const int next = (axis + 1) % 3;
        return any(segment, low, middle, next, low_t0, low_t1) ||
               any(segment, middle + 1, high, next, high_t0, high_t1);
    }

    std::vector<BorderPoint> points_;
    std::uint64_t steps_ = 0;
};

void find_t_junctions(const BaseMesh& mesh, const std::vector<std::array<std::uint32_t, 2>>& border,
                      std::uint64_t most_steps, std::vector<std::string>& flaws) {
    std::vector<std::uint32_t> indices;
    for (const auto& edge : border)
        indices.insert(indices.end(), edge.begin(), edge.end());
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
    std::vector<BorderPoint> points;
    points.reserve(indices.size());
    for (std::uint32_t index : indices)
        points.push_back({mesh.vertices[index].position, index});
    PointsOnSegments tree(std::move(points));
    std::size_t found = 0, searched = 0;
    while (searched < border.size() && tree.steps() < most_steps) {
        const auto& [a, b] = border[searched++];
        found += tree.any_between({mesh.vertices[a].position, a}, {mesh.vertices[b].position, b});
    }
    if (found > 0) {
        flaws.push_back(
            fmt::format("{} border edge(s) contain another vertex of the border (T-junction): the "
                        "displaced surface may open there.",
                        found));
    }
    if (searched < border.size()) {
        flaws.push_back(fmt::format("The search for T-junctions was stopped after {} of {} border edges.", searched,
                                    border.size()));
    }
}

void edge_flaws(const BaseMesh& mesh, const Surface& surface, std::uint64_t most_steps,
                std::vector<std::string>& flaws) {
    if (surface.crowded > 0)
        flaws.push_back(fmt::format("{} edge(s) belong to more than two triangles.", surface.crowded));
    if (surface.opposed > 0)
        flaws.push_back(fmt::format(
            "The winding changes across {} edge(s): neighbours face opposite ways. Turn the triangles so that all face "
            "outside; where this is not possible, separate them.",
            surface.opposed));
    find_t_junctions(mesh, surface.border, most_steps, flaws);
}

void normal_flaws(const BaseMesh& mesh, const std::vector<std::uint32_t>& points, std::string_view normals_remedy,
                  std::vector<std::string>& flaws) {
    std::vector<char> several(mesh.vertices.size(), 0);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        if (glm::distance(mesh.vertices[i].normal, mesh.vertices[points[i]].normal) > same_normal)
            several[points[i]] = 1;
    if (const auto count = std::count(several.begin(), several.end(), 1); count > 0) {
        flaws.push_back(fmt::format("{} point(s) have more than one normal: the displaced surface opens there.{}{}",
                                    count, normals_remedy.empty() ? "" : " ", normals_remedy));
    }
    std::size_t against = 0;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 facing =
            triangle_normal(mesh.vertices[t[0]].position, mesh.vertices[t[1]].position, mesh.vertices[t[2]].position);
        against += std::any_of(t.begin(), t.end(),
                               [&](std::uint32_t i) { return glm::dot(facing, mesh.vertices[i].normal) < 0; });
    }
    if (against > 0)
        flaws.push_back(fmt::format("{} triangle(s) have a normal that points against their winding.", against));
}

}  // namespace

Surface surface_of(const BaseMesh& mesh) {
    Surface surface;
    surface.points = first_at_position(mesh.vertices);
    // one number per edge and triangle: the lower vertex, the higher, the direction; sorting brings them
    // together
    std::vector<std::uint64_t> uses;
    uses.reserve(mesh.triangles.size() * 3);
    for (const auto& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t a = surface.points[t[k]], b = surface.points[t[(k + 1) % 3]];
            uses.push_back(std::min(a, b) << 33 | std::max(a, b) << 1 | (a < b ? 0u : 1u));
        }
    }
    std::sort(uses.begin(), uses.end());
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t end = i;
        while (end < uses.size() && uses[end] >> 1 == uses[i] >> 1)
            ++end;
        if (end - i == 1) {
            surface.border.push_back(
                {static_cast<std::uint32_t>(uses[i] >> 33), static_cast<std::uint32_t>(uses[i] >> 1 & UINT32_MAX)});
        } else if (end - i > 2) {
            ++surface.crowded;
        } else {
            surface.opposed += uses[i] == uses[i + 1] ? 1u : 0u;
        }
        i = end;
    }
    return surface;
}

std::vector<std::string> surface_flaws(const BaseMesh& mesh, const Surface& surface, std::string_view normals_remedy,
                                       std::uint64_t most_steps) {
    std::vector<std::string> flaws;
    edge_flaws(mesh, surface, most_steps, flaws);
    normal_flaws(mesh, surface.points, normals_remedy, flaws);
    return flaws;
}

void count_leaning_normals(BaseMesh& mesh, const Surface& surface) {
    constexpr double least = 5;  // degrees
    std::vector<glm::dvec3> sums(mesh.vertices.size(), glm::dvec3(0));
    std::vector<double> widest(mesh.vertices.size(), 0);
    const auto for_each_corner = [&](const auto& use) {
        for (const auto& t : mesh.triangles) {
            const glm::dvec3 facing = triangle_normal(mesh.vertices[t[0]].position, mesh.vertices[t[1]].position,
                                                      mesh.vertices[t[2]].position);
            for (const std::uint32_t i : t)
                use(surface.points[i], facing);
        }
    };
    for_each_corner([&](std::uint32_t i, const glm::dvec3& facing) { sums[i] += facing; });
    for_each_corner([&](std::uint32_t i, const glm::dvec3& facing) {
        widest[i] = std::max(widest[i], degrees_between(facing, sums[i]));
    });
    std::size_t leaning = 0;
    double most = 0;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const std::uint32_t at = surface.points[i];
        const double lean = degrees_between(mesh.vertices[i].normal, sums[at]);
        if (sums[at] == glm::dvec3(0) || lean < widest[at] + least || lean > 90)
            continue;
        ++leaning;
        most = std::max(most, lean);
    }
    if (leaning > 0)
        mesh.repairs.push_back(fmt::format(
            "{} vertices have a normal that is not that of the triangles around them, by up to {:.0f} degrees: "
            "displacement, N' and light follow it.",
            leaning, most));
}

}  // namespace tessera

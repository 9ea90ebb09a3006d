#include "testbench/setup/mesh/tangent_frames.h"

#include <fmt/format.h>

#include "testbench/setup/mesh/equal_groups.h"
#include "testbench/setup/mesh/texture_gradient.h"

namespace tessera {
namespace {

/// A sum below this fraction of its terms is the rounding error of a cancellation.
constexpr double cancelled = 1e-6;

struct FrameSum {
    glm::dvec3 direction{0};
    double weight = 0;
    std::uint32_t straight = 0, mirrored = 0;  // triangles
};

std::vector<std::uint32_t> frame_groups(const BaseMesh& mesh) {
    return first_equal(mesh.vertices, [](const BaseVertex& vertex) {
        const PositionKey p = position_key(vertex.position), n = position_key(vertex.normal);
        return std::array{p[0], p[1], p[2], n[0], n[1], n[2]};
    });
}

/// A unit vector perpendicular to n, from the axis least aligned with n.
glm::dvec3 perpendicular(const glm::dvec3& n) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(n[k]) < std::abs(n[axis]))
            axis = k;
    glm::dvec3 along(0);
    along[axis] = 1;
    return unit_or_zero(along - n * n[axis]);
}

}  // namespace

void complete_tangent_frames(BaseMesh& mesh) {
    const std::vector<std::uint32_t> group = frame_groups(mesh);
    std::vector<FrameSum> sums(mesh.vertices.size());

    double largest_area = 0;
    for (const auto& t : mesh.triangles) {
        largest_area = std::max(largest_area, triangle_area(mesh.vertices[t[0]].position, mesh.vertices[t[1]].position,
                                                            mesh.vertices[t[2]].position));
    }
    std::size_t flat_texture = 0;
    for (const auto& t : mesh.triangles) {
        const auto gradient = texture_gradient(mesh, t);
        if (!gradient) {
            ++flat_texture;
            continue;
        }
        const double weight = largest_area > 0 ? gradient->area / largest_area : 1;
        const glm::dvec3 direction = unit_or_zero(gradient->dp_du);
        const glm::dvec3 facing =
            triangle_normal(mesh.vertices[t[0]].position, mesh.vertices[t[1]].position, mesh.vertices[t[2]].position);
        for (std::uint32_t corner : t) {
            FrameSum& sum = sums[group[corner]];
            sum.direction += weight * direction;
            sum.weight += weight;
            const bool inside_out = glm::dot(facing, mesh.vertices[corner].normal) < 0;
            ++(gradient->mirrored != inside_out ? sum.mirrored : sum.straight);
        }
    }

    std::size_t without = 0, cancelling = 0, mixed = 0;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        BaseVertex& vertex = mesh.vertices[i];
        if (group[i] != i) {  // the group's first vertex precedes and already has its frame
            vertex.tangent = mesh.vertices[group[i]].tangent;
            vertex.handedness = mesh.vertices[group[i]].handedness;
            continue;
        }
        const FrameSum& sum = sums[i];
        const glm::dvec3 in_plane = sum.direction - vertex.normal * glm::dot(vertex.normal, sum.direction);
        if (safe_length(in_plane) > cancelled * sum.weight) {
            const glm::dvec3 rough = unit_or_zero(in_plane);
            vertex.tangent = unit_or_zero(rough - vertex.normal * glm::dot(vertex.normal, rough));
        } else {
            ++(sum.weight > 0 ? cancelling : without);
            vertex.tangent = perpendicular(vertex.normal);
        }
        vertex.handedness = sum.mirrored > sum.straight ? -1 : 1;
        mixed += sum.mirrored > 0 && sum.straight > 0;
    }

    if (flat_texture > 0) {
        mesh.repairs.push_back(
            fmt::format("{} triangle(s) have no area in texture space and do not define a tangent.", flat_texture));
    }
    if (without > 0) {
        mesh.repairs.push_back(
            fmt::format("{} point(s) without a tangent got a vector perpendicular to the normal.", without));
    }
    if (cancelling > 0) {
        mesh.repairs.push_back(
            fmt::format("At {} point(s) the directions of dp/du cancel (for example at a pole): the tangent is any "
                        "vector perpendicular to the normal.",
                        cancelling));
    }
    if (mixed > 0) {
        mesh.repairs.push_back(
            fmt::format("At {} point(s) the texture is mirrored in some triangles and not in others: "
                        "the majority determined the handedness.",
                        mixed));
    }
}

}  // namespace tessera

#include "testbench/setup/mesh/smooth_normals.h"

#include <fmt/format.h>

#include <algorithm>

#include "testbench/setup/mesh/equal_groups.h"
#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera {

void complete_smooth_normals(BaseMesh& mesh) {
    const auto has_none = [](const BaseVertex& vertex) { return vertex.normal == glm::dvec3(0); };
    if (std::none_of(mesh.vertices.begin(), mesh.vertices.end(), has_none))
        return;
    constexpr double cancelled = 1e-9;  // relative to the sum of angles; below it, rounding
    const std::vector<std::uint32_t> group = first_at_position(mesh.vertices);

    struct Sum {
        glm::dvec3 direction{0}, first{0};
        double angle = 0;
    };
    std::vector<Sum> sums(mesh.vertices.size());
    for (const auto& t : mesh.triangles) {
        const std::array<glm::dvec3, 3> p{mesh.vertices[t[0]].position, mesh.vertices[t[1]].position,
                                          mesh.vertices[t[2]].position};
        const glm::dvec3 normal = triangle_normal(p[0], p[1], p[2]);
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec3 a = unit_or_zero(p[(k + 1) % 3] - p[k]), b = unit_or_zero(p[(k + 2) % 3] - p[k]);
            const double angle = std::atan2(safe_length(glm::cross(a, b)), glm::dot(a, b));
            Sum& sum = sums[group[t[k]]];
            if (sum.angle == 0)
                sum.first = normal;
            sum.direction += angle * normal;
            sum.angle += angle;
        }
    }

    std::size_t cancelling = 0;
    std::vector<char> counted(mesh.vertices.size(), 0);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (!has_none(mesh.vertices[i]))
            continue;
        const Sum& sum = sums[group[i]];
        const bool cancels = !(safe_length(sum.direction) > cancelled * sum.angle);
        mesh.vertices[i].normal = cancels ? sum.first : unit_or_zero(sum.direction);
        cancelling += cancels && counted[group[i]] == 0;
        counted[group[i]] = 1;
    }
    if (cancelling > 0) {
        mesh.repairs.push_back(
            fmt::format("At {} point(s) the normals of the surrounding triangles cancel: the first "
                        "triangle's was used.",
                        cancelling));
    }
}

}  // namespace tessera

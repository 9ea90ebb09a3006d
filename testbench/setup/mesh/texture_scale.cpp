#include "testbench/setup/mesh/texture_scale.h"

#include <algorithm>
#include <limits>

#include "testbench/setup/mesh/texture_gradient.h"

namespace tessera {

void measure_texture_scale(BaseMesh& mesh) {
    double largest_area = 0, largest_texture_area = 0;
    for (const auto& triangle : mesh.triangles)
        if (const auto gradient = texture_gradient(mesh, triangle)) {
            largest_area = std::max(largest_area, gradient->area);
            largest_texture_area = std::max(largest_texture_area, gradient->texture_area);
        }
    if (!(largest_area > 0)) {
        mesh.texture_scale = {};
        mesh.repairs.push_back(
            "No triangle has an area in texture space: a texel's world size was assumed to be that of a "
            "map one model unit wide and high.");
        return;
    }
    // relative, so that sums of squares of huge models stay finite
    const auto share = [&](const TextureGradient& gradient) {
        return glm::dvec2(gradient.area / largest_area, gradient.texture_area / largest_texture_area);
    };
    glm::dvec2 whole(0);
    for (const auto& triangle : mesh.triangles)
        if (const auto gradient = texture_gradient(mesh, triangle))
            whole += share(*gradient);
    constexpr double sliver = 1e-4;  // texture area for its area, relative to the mesh's
    constexpr double infinity = std::numeric_limits<double>::infinity();
    BaseMesh::TextureScale scale{0, 0, infinity, 0, infinity, 0};
    double total = 0;
    for (const auto& triangle : mesh.triangles) {
        const auto gradient = texture_gradient(mesh, triangle);
        if (!gradient)
            continue;
        const glm::dvec2 its = share(*gradient);
        if (its.y * whole.x < sliver * its.x * whole.y)
            continue;
        const double weight = its.x;
        const double u = safe_length(gradient->dp_du), v = safe_length(gradient->dp_dv);
        total += weight;
        scale.mean_u += weight * u;
        scale.mean_v += weight * v;
        scale.smallest_u = std::min(scale.smallest_u, u);
        scale.largest_u = std::max(scale.largest_u, u);
        scale.smallest_v = std::min(scale.smallest_v, v);
        scale.largest_v = std::max(scale.largest_v, v);
    }
    mesh.texture_scale = {};
    if (!(total > 0))
        return;  // those that count have no area in space
    scale.mean_u /= total;
    scale.mean_v /= total;
    mesh.texture_scale = scale;
}

}  // namespace tessera

#include "testbench/setup/prepare_scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>

#include "testbench/common/error.h"
#include "testbench/setup/bound_promise.h"
#include "testbench/setup/check_settings.h"
#include "testbench/setup/mesh/smooth_normals.h"
#include "testbench/setup/mesh/tangent_frames.h"
#include "testbench/setup/mesh/texture_scale.h"
#include "testbench/setup/mesh/triangle_geometry.h"
#include "testbench/setup/prepare_model.h"
#include "testbench/setup/unit_vector.h"

namespace tessera {

namespace {

template <std::size_t Size>
bool finite(const std::array<double, Size>& values) {
    // single precision's range: products of coordinates stay finite
    return std::all_of(values.begin(), values.end(), [](double value) { return std::abs(value) < 3.4e38; });
}

BaseVertex base_vertex(const SceneVertex& vertex, std::size_t number) {
    if (!finite(vertex.position) || !finite(vertex.texture) || !finite(vertex.normal))
        throw InputError(fmt::format("vertices[{}] has a value that is not finite, or beyond 3.4e38", number));
    BaseVertex result;
    result.position = {vertex.position[0], vertex.position[1], vertex.position[2]};
    result.texture = {vertex.texture[0], vertex.texture[1]};
    const glm::dvec3 normal(vertex.normal[0], vertex.normal[1], vertex.normal[2]);
    if (normal != glm::dvec3(0))
        result.normal = unit_vector(normal);
    return result;
}

BaseMesh base_mesh(const Scene& scene) {
    BaseMesh mesh;
    for (std::size_t k = 0; k < scene.vertices.size(); ++k)
        mesh.vertices.push_back(base_vertex(scene.vertices[k], k));
    for (std::size_t k = 0; k < scene.triangles.size(); ++k) {
        for (const std::uint32_t corner : scene.triangles[k])
            if (corner >= scene.vertices.size())
                throw InputError(fmt::format("triangles[{}] names vertex {} of {}", k, corner, scene.vertices.size()));
        const auto& [a, b, c] = scene.triangles[k];
        const auto position = [&](std::uint32_t corner) { return mesh.vertices[corner].position; };
        if (triangle_normal(position(a), position(b), position(c)) == glm::dvec3(0))
            ++mesh.dropped_degenerate;
        else
            mesh.triangles.push_back(scene.triangles[k]);
    }
    if (mesh.triangles.empty())
        throw InputError(fmt::format("none of the {} triangles has an area", scene.triangles.size()));
    complete_smooth_normals(mesh);
    complete_tangent_frames(mesh);
    measure_texture_scale(mesh);
    return mesh;
}

HeightMap height_map(const Scene& scene) {
    const int most = 1 << scene.settings.formats.texture_integer;
    if (scene.map_width < 1 || scene.map_height < 1 || scene.map_width > most || scene.map_height > most)
        throw InputError(fmt::format("a map of {} x {} texels: each side must be 1 to {} (formats.texture_integer)",
                                     scene.map_width, scene.map_height, most));
    const std::size_t texels = static_cast<std::size_t>(scene.map_width) * static_cast<std::size_t>(scene.map_height);
    if (scene.map.size() != texels)
        throw InputError(
            fmt::format("the map has {} values, but map_width x map_height = {}", scene.map.size(), texels));
    const auto is_finite = [](float value) { return std::isfinite(value); };
    if (!std::all_of(scene.map.begin(), scene.map.end(), is_finite) || !std::isfinite(scene.map_low) ||
        !std::isfinite(scene.map_high) || scene.map_low > scene.map_high)
        throw InputError("the map has a value that is not finite, or map_low > map_high");
    HeightMap map;
    map.width = scene.map_width;
    map.height = scene.map_height;
    map.values = scene.map;
    map.range_low = map.span_low = scene.map_low;
    map.range_high = map.span_high = scene.map_high;
    return map;
}

}  // namespace

PreparedScene prepare(const Scene& scene) {
    check_settings(scene.settings);
    const BaseMesh mesh = base_mesh(scene);
    PreparedScene prepared = prepare_model(scene.settings, mesh, height_map(scene), "map");
    remark_on_bound(scene.settings, mesh, prepared);
    prepared.remarks.insert(prepared.remarks.begin(), mesh.repairs.begin(), mesh.repairs.end());
    if (mesh.dropped_degenerate > 0)
        prepared.remarks.push_back(
            fmt::format("triangles dropped because they have no area: {}", mesh.dropped_degenerate));
    return prepared;
}

}  // namespace tessera

#include "testbench/input/mesh/run_mesh.h"

#include <fmt/format.h>

#include <algorithm>

#include "testbench/common/error.h"
#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/input/mesh/mesh_text.h"
#include "testbench/input/mesh/surface_flaws.h"
#include "testbench/run_folder/read_run.h"
#include "testbench/setup/mesh/equal_groups.h"
#include "testbench/setup/mesh/smooth_normals.h"
#include "testbench/setup/mesh/tangent_frames.h"
#include "testbench/setup/mesh/texture_scale.h"
#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera {
namespace {

/// For each vertex the first with equal values in all fields that the next run uses.
std::vector<std::uint32_t> alike_vertices(const RecordedMesh& mesh) {
    std::vector<std::array<std::uint64_t, 8>> keys;
    keys.reserve(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const PositionKey p = position_key(mesh.positions[v]), n = position_key(mesh.normals[v]);
        keys.push_back(
            {p[0], p[1], p[2], n[0], n[1], n[2], alike_bits(mesh.textures[v].x), alike_bits(mesh.textures[v].y)});
    }
    return first_equal(keys);
}

/// Copies the triangles and the vertices they use, in the order of first use.
void take_triangles(const RecordedMesh& recorded, BaseMesh& mesh) {
    constexpr std::uint32_t none = UINT32_MAX;
    const std::vector<std::uint32_t> alike = alike_vertices(recorded);
    std::vector<std::uint32_t> vertex_of(recorded.positions.size(), none);
    mesh.triangles.reserve(recorded.triangles.size());
    for (const RecordedMesh::Triangle& t : recorded.triangles) {
        std::array<std::uint32_t, 3> corners{alike[t.vertices[0]], alike[t.vertices[1]], alike[t.vertices[2]]};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
            ++mesh.dropped_degenerate;
            continue;
        }
        for (std::uint32_t& corner : corners) {
            std::uint32_t& vertex = vertex_of[corner];
            if (vertex == none) {
                vertex = static_cast<std::uint32_t>(mesh.vertices.size());
                BaseVertex made;
                made.position = recorded.positions[corner];
                made.normal = unit_or_zero(recorded.normals[corner]);
                made.texture = recorded.textures[corner];
                mesh.vertices.push_back(made);
            }
            corner = vertex;
        }
        mesh.triangles.push_back(corners);
    }
    if (mesh.dropped_degenerate > 0)
        mesh.repairs.push_back(
            fmt::format("{} triangle(s) of the run with two corners at one displaced position "
                        "were dropped.",
                        mesh.dropped_degenerate));
}

void complete_normals(BaseMesh& mesh) {
    const auto without = std::count_if(mesh.vertices.begin(), mesh.vertices.end(),
                                       [](const BaseVertex& v) { return v.normal == glm::dvec3(0); });
    if (without == 0)
        return;
    mesh.repairs.push_back(fmt::format("{} vertices of the run have no normal: replaced by smooth normals.", without));
    complete_smooth_normals(mesh);
}

/// Built-in meshes have up = z, whatever the run's camera; for files and runs, the camera's up is used.
glm::dvec3 up_of(const Job& job) {
    if (job.mesh.source != MeshSource::file && job.mesh.source != MeshSource::run)
        return {0, 0, 1};
    return {job.camera.up[0], job.camera.up[1], job.camera.up[2]};
}

RecordedRun read(const std::filesystem::path& folder) {
    try {
        return read_run(folder);
    } catch (const InputError& error) {
        throw InputError(fmt::format("mesh.file, with mesh.source = \"run\": {}", error.what()));
    }
}

}  // namespace

BaseMesh read_run_mesh(const std::filesystem::path& folder) {
    const std::string name = (folder / "mesh.ply").string();
    BaseMesh mesh;
    {
        const RecordedRun run = read(folder);
        if (run.mesh.triangles.size() > largest_base_triangles)
            throw ResourceError(
                fmt::format("{}: {} triangles; a base mesh has at most {}: raise that run's "
                            "thresholds under [tests]",
                            name, run.mesh.triangles.size(), largest_base_triangles));
        take_triangles(run.mesh, mesh);
        mesh.up = up_of(run.job);
        if (run.job.hardware.culling == Culling::back)
            mesh.repairs.emplace_back(
                "The run culled triangles that faced away (hardware.culling = \"back\"): they are missing "
                "here.");
    }
    if (mesh.triangles.empty())
        throw InputError(
            fmt::format("{}: no triangle is left; run a job that leaves some (hardware.culling, camera)", name));
    const auto [low, high] = bounds_of(mesh.vertices);
    require_size(high - low, name);
    complete_normals(mesh);
    constexpr const char* smooth_normals =
        "Set output.obj = true in that run, and use its mesh.obj without normals, as in `f 1/1 2/2 3/3`: smooth ones are then "
        "calculated.";
    const Surface surface = surface_of(mesh);
    mesh.winding_changes = surface.opposed;
    for (std::string& flaw : surface_flaws(mesh, surface, smooth_normals))
        mesh.repairs.push_back(std::move(flaw));
    complete_tangent_frames(mesh);
    measure_texture_scale(mesh);
    return mesh;
}

}  // namespace tessera

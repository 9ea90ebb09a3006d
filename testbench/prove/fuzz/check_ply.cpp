#include <cmath>

#include "testbench/common/error.h"
#include "testbench/prove/fuzz/fuzz_target.h"
#include "testbench/prove/fuzz/memory_file.h"
#include "testbench/run_folder/ply_reader.h"

namespace tessera::fuzz {

void check_ply(std::string_view bytes) {
    const std::filesystem::path& path = file_of(bytes);
    try {
        const RecordedMesh mesh = read_ply(path);
        promise(mesh.normals.size() == mesh.positions.size() && mesh.textures.size() == mesh.positions.size(),
                "the numbers of normals or texture coordinates and of positions differ");
        for (const glm::dvec3& p : mesh.positions)
            promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "a position is not finite");
        for (const glm::vec3& n : mesh.normals)
            promise(std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z), "a normal is not finite");
        for (const glm::dvec2& t : mesh.textures)
            promise(std::isfinite(t.x) && std::isfinite(t.y), "a texture coordinate is not finite");
        for (const RecordedMesh::Triangle& t : mesh.triangles)
            for (const std::uint32_t i : t.vertices)
                promise(i < mesh.positions.size(), "a triangle names a vertex that does not exist");
    } catch (const InputError& error) {
        promise_message(error.what(), path.string());
    }
}

}  // namespace tessera::fuzz

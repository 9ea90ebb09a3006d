#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace tessera {

/// The emitted mesh of a run as in its mesh.ply (ply_writer.h): displaced, indexed, in model units, without culled
/// triangles.
struct RecordedMesh {
    struct Triangle {
        std::array<std::uint32_t, 3> vertices{};
        std::uint8_t generation = 0;  ///< of its youngest vertex
        /// Tests that split its parent: 1 Normal, 2 Summed Height, 3 both, plus 32 Highlight; 0 base.
        std::uint8_t split_by = 0;
        std::uint8_t stopped_by = 0;  ///< sum of 4 View, 8 Tex Coord, 16 Generation: tests that kept an edge whole
        std::uint32_t base = 0;       ///< its base triangle
    };

    std::vector<glm::dvec3> positions;  ///< P', finite
    std::vector<glm::vec3> normals;     ///< N', about unit length; zero where the hardware had none
    std::vector<glm::dvec2> textures;   ///< s, t: 0..1 spans the map once, t = 0 its bottom row
    std::vector<Triangle> triangles;

    std::array<glm::dvec3, 3> corners(const Triangle& t) const {
        return {positions[t.vertices[0]], positions[t.vertices[1]], positions[t.vertices[2]]};
    }
};

}  // namespace tessera

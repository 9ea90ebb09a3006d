#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/host/emitted_mesh.h"
#include "testbench/host/setup.h"

namespace tessera {

/// What kind of split made a triangle; the values are split_by's bits.
enum class DecidingTest : std::uint8_t { base = 0, normal = 1, summed_height = 2, both = 3 };

/// A run's displaced surface, indexed, in model units.
struct RenderMesh {
    struct Triangle {
        std::array<std::uint32_t, 3> vertices{};
        std::uint8_t generation = 0;  ///< the highest of its corners'
        DecidingTest deciding_test = DecidingTest::base;
    };

    glm::dvec3 origin{0};              ///< positions count from here: a mesh far from 0 keeps its precision
    std::vector<glm::vec3> positions;  ///< P'
    std::vector<glm::vec3> normals;    ///< N', about unit length; zero where the hardware had none
    std::vector<Triangle> triangles;
    std::uint64_t base_triangles = 0;  ///< for the caption; 0: unknown
};

/// Every triangle of the run, those with culled set too: they are the far side of the same surface.
RenderMesh make_render_mesh(const EmittedMesh& mesh, const Setup& setup);

}  // namespace tessera

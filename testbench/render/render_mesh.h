#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/machine/deciding_test.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// A run's displaced surface, indexed, in model units.
struct RenderMesh {
    struct Triangle {
        std::array<std::uint32_t, 3> vertices{};
        std::uint8_t generation = 0;  ///< the highest of its corners
        DecidingTest deciding_test = DecidingTest::base;
        std::uint8_t stopped_by = 0;  ///< sum of 4 View, 8 Tex Coord, 16 Generation: the tests that kept an edge whole
    };

    glm::dvec3 origin{0};              ///< positions are relative to this: a mesh far from 0 keeps its precision
    std::vector<glm::vec3> positions;  ///< P'
    std::vector<glm::vec3> normals;    ///< N', about unit length; zero where the hardware had none
    std::vector<Triangle> triangles;
    std::vector<float> triangle_errors;  ///< each triangle's distance to a reference, model units; empty: unknown
    datapath::HeightTest height_test = datapath::HeightTest::summed_height;  ///< the run's, for the legend
    std::uint64_t base_triangles = 0;  ///< number of their base triangles, for the legend; 0: unknown
};

/// From a run's mesh.ply. Vertices are shared if position and normal agree, in order of first use.
RenderMesh make_render_mesh(const RecordedMesh& mesh);

/// From an emitted mesh without culled triangles: equal in every number to that of its mesh.ply if the emitted mesh has
/// the file's order (EmittedMesh::sort()).
RenderMesh make_render_mesh(const EmittedMesh& mesh, const MachineSetup& setup);

}  // namespace tessera

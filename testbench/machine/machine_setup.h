#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"
#include "modules/pipeline.h"
#include "testbench/input/mesh/base_mesh.h"
#include "testbench/job/job.h"
#include "testbench/machine/quantised_map.h"
#include "testbench/machine/setup/model_scale.h"

namespace tessera {

/// Host values that did not fit their format and were saturated. fit_model() leaves room, so that none should.
struct InputSaturations {
    std::uint64_t position = 0;   ///< components of base vertices
    std::uint64_t normal = 0;     ///< components of base vertices' normals and tangents
    std::uint64_t registers = 0;  ///< displacement's scale and bias, directions of view and light
};

/// A job made ready for the machine: everything rounded to the hardware's formats. What the simulation, the golden
/// model and the reports all start from.
struct MachineSetup {
    datapath::Registers registers;
    Design design;
    unsigned machines = 1;  ///< of that design, side by side; base triangle b goes to machine b mod so many
    QuantisedMap map;
    std::vector<datapath::Triangle> base_triangles;
    ModelScale model_scale;

    double height_per_code = 0;   ///< world units: S * code / 2^bits, S as rounded
    glm::dvec2 texel_size{1, 1};  ///< world size of a texel along u and v

    std::uint64_t largest_rectangle_sum = 0;  ///< bound on any rectangle's sum over this mesh, in codes
    bool summed_height_bits_chosen = false;   ///< by `auto`
    std::uint64_t base_dropped = 0;           ///< triangles that rounding made name one vertex twice
    std::uint64_t texture_clamped = 0;        ///< vertices whose u or v lay outside a clamped map
    InputSaturations input_saturations;
    std::vector<std::string> remarks;  ///< one sentence each, for the report
};

/// Rounds mesh, map, camera, thresholds to the formats. The job must be resolved (resolve_job.h). Errors: InputError
/// where something cannot fit and no repair keeps the meaning (a table entry too narrow for the largest
/// rectangle, an eye too far away, a texture coordinate beyond the format, a threshold beyond its register or
/// below its step), with value, limit and what to do.
MachineSetup make_setup(const Job& job, const BaseMesh& mesh, const HeightMap& map);

}  // namespace tessera

#pragma once
#include "modules/timing/design.h"
#include "testbench/job/job.h"
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/model_scale.h"
#include "testbench/setup/prepared_scene.h"

namespace tessera {

/// A job prepared for the machine: common input of the simulation, the golden model and the reports.
struct MachineSetup : PreparedScene {
    ModelScale model_scale;  ///< scale and centre
    Design design;
    unsigned machines = 1;  ///< of that design, side by side; base triangle b goes to machine b modulo this number
    bool summed_height_bits_chosen = false;  ///< by `auto`
};

/// The job must be resolved (resolve_job.h). Errors: as prepare_model().
MachineSetup make_setup(const Job& job, const BaseMesh& mesh, const HeightMap& map);

}  // namespace tessera

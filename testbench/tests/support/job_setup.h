#pragma once
#include "testbench/machine/inputs.h"
#include "testbench/machine/machine_setup.h"

namespace tessera::testing {

inline MachineSetup setup_of(const Job& job) {
    const Inputs inputs = load_inputs(job);
    return make_setup(inputs.resolved.job, inputs.mesh, inputs.map);
}

/// 2 x 2 quads with noise of 32 x 32 texels; every edge may split, up to generation 4.
inline Job noise_job() {
    Job job;
    job.mode = Mode::functional;
    job.mesh.columns = job.mesh.rows = 2;
    job.map.source = MapSource::noise;
    job.map.width = job.map.height = 32;
    job.tests.view = false;
    job.tests.generation_limit = 4;
    return job;
}

}  // namespace tessera::testing

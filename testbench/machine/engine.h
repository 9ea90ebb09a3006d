#pragma once
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Selects the engine for a run in timed mode, according to `timing.engine`: sets MachineSetup::scheduled and the
/// reason. InputError if the job requests a schedule that its design or its options do not have.
void choose_engine(const Job& job, MachineSetup& setup);

}  // namespace tessera

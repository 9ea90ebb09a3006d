#pragma once
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Decides which engine times a run in timed mode, by `timing.engine`: MachineSetup::scheduled and why. InputError if the
/// job asks for a schedule and its design or its options have none.
void choose_engine(const Job& job, MachineSetup& setup);

}  // namespace tessera

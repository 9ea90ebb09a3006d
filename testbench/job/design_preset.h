#pragma once
#include "testbench/job/job.h"

namespace tessera {

/// Sets the keys of a preset, hardware.design, to its values. All other keys are unchanged.
void apply_design(Job& job);

}  // namespace tessera

#pragma once
#include "modules/machine.h"
#include "modules/rasteriser.h"
#include "testbench/prove/schedule/plan.h"

namespace tessera::schedule {

/// The plan of a machine of the paper's design in timed mode: one Tessellation Tests unit in parallel order, a queue
/// without a capacity, tables on chip, each with one reader on each side. `design`: the machine's.
Plan plan_of(const tessera::Machine& machine, const Rasteriser& rasteriser, const Design& design);

}  // namespace tessera::schedule

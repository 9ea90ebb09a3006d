#pragma once
#include <functional>
#include <string>
#include <vector>

#include "testbench/prove/faults/fault_report.h"

namespace tessera {

/// Runs the machine without its fault before it is run with it, for nothing can be told of a fault in a run that fails
/// anyway. `run` is called in a process of its own, as SystemC simulates once in each, and prints nothing: it disarms
/// the fault of the machine built here, runs it and says who detected what. Throws InputError if anybody did, or the
/// process ended otherwise. To be called while nothing of the machine has run.
void require_sound_without_fault(const std::function<std::vector<Caught>()>& run);

}  // namespace tessera

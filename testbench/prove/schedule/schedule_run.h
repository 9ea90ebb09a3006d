#pragma once
#include <string>

#include "testbench/job/job.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// Runs a job of the paper's design in timed mode, then its schedule on the facts recorded. Returns the first
/// difference, empty if there is none: in the sequence of triangles, the cycles in which each item entered and left
/// each unit, the units' states and levels, the memories' ports, the queue's levels. The job must be resolved.
///
/// observed: the clock has an observer, as with waveforms, for several stretches of the run: units then make every
/// request, and in between read promptly where they can (PromptMemory).
///
/// Runs in a child process, since SystemC elaborates once. If that process fails, the text is the reason.
std::string schedule_difference(const Job& job, const BaseMesh& mesh, const HeightMap& map, bool observed = false);

/// The first line in which two texts differ, from both; empty if they are equal.
std::string first_difference(const std::string& clocked, const std::string& scheduled);

}  // namespace tessera

#pragma once
#include <string>

#include "testbench/job/job.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// All results of a timed run, a line per figure: statistics.csv, timing.txt, the queue's levels, the triangles in
/// their order, and the cycles in which each item entered and left each unit.
///
/// Runs in a child process, since SystemC elaborates once. If that process fails, the text is the reason.
std::string engine_run(const Job& job, const BaseMesh& mesh, const HeightMap& map, bool scheduled);

/// The first line in which two such texts differ, from both; empty if they are equal.
std::string first_difference(const std::string& clocked, const std::string& scheduled);

}  // namespace tessera

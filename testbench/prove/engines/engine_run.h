#pragma once
#include <string>

#include "testbench/job/job.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// All that a timed run comes to, a line a figure: statistics.csv, timing.txt, the queue's levels, the triangles in their
/// order, and the cycles in which each item came into each unit and left it.
///
/// Runs in a process of its own, since SystemC elaborates once. What ends that process but its end is the text.
std::string engine_run(const Job& job, const BaseMesh& mesh, const HeightMap& map, bool scheduled);

/// The first line in which two such texts differ, of both; empty: they do not.
std::string first_difference(const std::string& clocked, const std::string& scheduled);

}  // namespace tessera

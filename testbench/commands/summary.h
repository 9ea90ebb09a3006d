#pragma once
#include <string>
#include <vector>

#include "testbench/machine/resolve_job.h"
#include "testbench/output/report/conformance_report.h"
#include "testbench/output/report/statistics.h"

namespace tessera {

/// The values that the job left to the program, each with its rule.
std::string found_text(const std::vector<FoundValue>& found);

/// The table a run prints: what came out, what it cost, what was checked.
/// mesh: of the simulation's. seconds: the run took.
std::string summary(const MachineSetup& setup, const Simulation& simulation, const MeshCounts& mesh,
                    const Checks& checks, double seconds);

}  // namespace tessera

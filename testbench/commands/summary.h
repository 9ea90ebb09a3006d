#pragma once
#include <string>
#include <vector>

#include "testbench/machine/resolve_job.h"
#include "testbench/output/report/conformance_report.h"
#include "testbench/output/report/statistics.h"

namespace tessera {

/// The values that the job left open ("auto"), each with the rule that determined it.
std::string found_text(const std::vector<FoundValue>& found);

/// Lines for what was done to the inputs, and for the setup's remarks.
std::string notes_text(const std::vector<std::string>& repairs, const std::vector<std::string>& remarks);

/// The table printed by a run: results, cost and checks. mesh: counts of the simulation's mesh. seconds: run time.
std::string summary(const MachineSetup& setup, const Simulation& simulation, const MeshCounts& mesh,
                    const Checks& checks, double seconds);

}  // namespace tessera

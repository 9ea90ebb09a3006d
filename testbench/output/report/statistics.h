#pragma once
#include <string>
#include <vector>

#include "testbench/machine/simulation.h"
#include "testbench/output/report/figure.h"
#include "testbench/output/report/mesh_counts.h"

namespace tessera {

/// The figures of a run, in pipeline order. No wall-clock time: two runs give the same bytes. mesh: counts of the
/// simulation's mesh.
std::vector<Figure> collect_statistics(const MachineSetup& setup, const Simulation& simulation, const MeshCounts& mesh);

/// {"group": {"name": {"value": ..., "unit": "...", "description": "..."}}}
std::string statistics_json(const std::vector<Figure>& figures);

/// A heading, then a row per figure: "group.name", value, unit, description.
std::string statistics_csv(const std::vector<Figure>& figures);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "testbench/machine/simulation.h"
#include "testbench/output/report/mesh_counts.h"

namespace tessera {

/// One figure of a run.
struct Figure {
    std::string group;  ///< the unit, memory or stream it belongs to
    std::string name;
    std::variant<std::uint64_t, std::int64_t, double, std::string> value;
    std::string unit;
    std::string description;
};

/// The figures of a run, in the order of the pipeline. No wall-clock time: two runs give the same bytes.
/// mesh: counts of the simulation's mesh.
std::vector<Figure> collect_statistics(const MachineSetup& setup, const Simulation& simulation, const MeshCounts& mesh);

/// {"group": {"name": {"value": ..., "unit": "...", "description": "..."}}}
std::string statistics_json(const std::vector<Figure>& figures);

/// A heading, then a row a figure: "group.name", value, unit, description.
std::string statistics_csv(const std::vector<Figure>& figures);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "testbench/explore/thresholds/rank_search.h"
#include "testbench/explore/thresholds/tuned_figures.h"

namespace tessera {

/// The mesh that a threshold of the Rank Test or of the Bound Test gives.
struct RankPoint {
    bool bound = false;  ///< the Bound Test's
    std::uint32_t register_value = 0;
    double threshold = 0;  ///< tests.rank_threshold or tests.bound_threshold
    double promised = 0;   ///< bound: no point is farther from the mesh; model units
    Outcome outcome;
};

/// For each table that the job's formats ask for, thresholds from the highest, at which no edge splits, down: some 64 of
/// them, one for each mesh. Larger meshes than `limit` triangles are left out. setup: of this job;
/// its thresholds change.
std::vector<RankPoint> rank_curve(MachineSetup& setup, const Job& job, const TexelError& errors, std::uint64_t limit,
                                  const std::function<void(double)>& on_progress);

/// A row a point; errors in `unit`.
std::string rank_curve_csv(const std::vector<RankPoint>& curve, const ErrorUnit& unit);

/// The same for the terminal: points with half as many triangles again as those before.
std::string rank_curve_text(const std::vector<RankPoint>& curve, const ErrorUnit& unit);

/// What a loader must know of the table: its size, the entries' fields, and what they promise.
std::string rank_table_json(const MachineSetup& setup, const ErrorUnit& unit);

/// The table as it lies in the memory: row by row, bottom row first, little endian.
std::string rank_table_bytes(const MachineSetup& setup);

}  // namespace tessera

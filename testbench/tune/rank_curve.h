#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "testbench/tune/rank_search.h"
#include "testbench/tune/tuned_figures.h"

namespace tessera {

/// The mesh produced by a threshold of the Rank Test or of the Bound Test.
struct RankPoint {
    bool bound = false;  ///< the threshold is the Bound Test's
    std::uint32_t register_value = 0;
    double threshold = 0;  ///< tests.rank_threshold or tests.bound_threshold
    double promised = 0;   ///< bound on the distance from any point to the mesh; model units
    Outcome outcome;
};

/// For each table requested by the job's formats, about 64 thresholds with distinct meshes, descending from the one at
/// which no edge splits. Meshes of more than `limit` triangles are left out. setup: of this job; its thresholds are
/// modified.
std::vector<RankPoint> rank_curve(MachineSetup& setup, const Job& job, const TexelError& errors, std::uint64_t limit,
                                  const std::function<void(double)>& on_progress);

/// CSV with one row per point; errors in `unit`.
std::string rank_curve_csv(const std::vector<RankPoint>& curve, const ErrorUnit& unit);

/// The same for the terminal: each point has at least half as many triangles again as the one before.
std::string rank_curve_text(const std::vector<RankPoint>& curve, const ErrorUnit& unit);

/// The data a loader needs about the table: its size, the entries' fields, and the errors they guarantee.
std::string rank_table_json(const MachineSetup& setup, const ErrorUnit& unit);

/// The table's memory image: row by row, bottom row first, little endian.
std::string rank_table_bytes(const MachineSetup& setup);

}  // namespace tessera

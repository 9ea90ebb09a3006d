#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "testbench/job/job.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/tune/base_choice.h"
#include "testbench/tune/threshold_search.h"

namespace tessera {

struct TuneRequest {
    Job job;
    TuneGoal goal;
    TuneSpace space;
    std::vector<BaseChoice> bases;  ///< at least one
    unsigned threads = 1;
};

/// A row of the table of all points tried.
struct TriedPoint {
    std::size_t base = 0;  ///< of TuneRequest::bases
    TunedPoint point;
};

struct TuneResult {
    std::size_t base = 0;
    TunedPoint point;
    Job job;               ///< thresholds and base mesh set; for a lattice of the paper's tests, mesh.file is empty
    std::string base_obj;  ///< for such a lattice
    std::vector<TriedPoint> tried;
    std::uint64_t evaluations = 0;  ///< meshes counted or measured
};

/// The job with this base mesh and its tests. For a lattice of the paper's tests, the caller sets mesh.file.
Job job_with_base(const Job& job, const BaseChoice& base, const TuneGoal& goal);

/// Its base mesh, exactly as the job will read it.
BaseMesh base_mesh_of(const Job& job, const BaseChoice& base, const HeightMap& map);

/// Finds the best thresholds over all base meshes: explore() on each, refine() on the best three; RankSearch on those
/// for ranks. The result does not depend on the number of threads. on_progress(what, 0..1) is called from one thread at
/// a time. Throws InputError, with the nearest attainable goal, if the goal cannot be met, and the errors of
/// make_setup().
TuneResult tune(const TuneRequest& request, const HeightMap& map,
                const std::function<void(const std::string&, double)>& on_progress);

}  // namespace tessera

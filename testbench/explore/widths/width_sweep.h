#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "testbench/explore/widths/quantity.h"
#include "testbench/explore/widths/width_run.h"
#include "testbench/job/job.h"
#include "testbench/output/report/saturation_figures.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// A quantity and the widths to try, in bits, widest first.
struct SweptQuantity {
    const Quantity* quantity = nullptr;
    std::vector<std::int64_t> widths;
};

struct WidthRequest {
    Job job;
    std::vector<SweptQuantity> swept;
    unsigned threads = 1;
    /// Limits for the knee; by default slightly above the values of the widest width.
    std::optional<double> most_flips;  ///< percent of the edges whose split decision differs from exact arithmetic's
    std::optional<double> most_error;  ///< RMS of positions, model units
};

/// One width of one quantity, everything else as in the job.
struct WidthRow {
    std::int64_t bits = 0, fraction = 0;
    bool of_the_job = false;  ///< the job's own width
    std::string refused;      ///< if not empty: why there is no such design; the rest is then meaningless
    WidthRun run;
    std::vector<SaturationFigure> saturations;
    std::uint64_t saturated = 0;  ///< total over all quantities

    // Storage of the design, whether or not it depends on this quantity.
    std::uint64_t base_vertex_bits = 0, queue_entry_bits = 0;
    std::uint64_t displacement_map_bytes = 0, normal_map_bytes = 0, summed_height_table_bytes = 0;
};

/// The narrowest width that, like every wider one tried, stays within the limits and violates no invariant.
struct WidthKnee {
    double most_flips = 0, most_error = 0;
    double most_local = 0;  ///< percent of the edges that may differ from the golden model: check.allowed_flips
    bool flips_given = false, error_given = false;
    std::optional<std::size_t> row;  ///< none: not even the widest qualifies
};

struct WidthTable {
    SweptQuantity swept;
    std::vector<WidthRow> rows;  ///< as swept.widths
    WidthKnee knee;
};

struct WidthSweep {
    std::uint64_t exact_triangles = 0;  ///< of the exact model's own mesh; 0 if more than four times limits.triangles
    std::vector<WidthTable> tables;
    std::string texel_borders;  ///< the warning of texel_borders.h for the first valid design; empty: none
};

/// The result does not depend on the number of threads. on_progress(what, 0..1) is called from one thread at a time.
/// Throws the errors of make_setup() for the job itself; widths that it refuses become rows.
WidthSweep sweep_widths(const WidthRequest& request, const BaseMesh& mesh, const HeightMap& map,
                        const std::function<void(const std::string&, double)>& on_progress);

}  // namespace tessera

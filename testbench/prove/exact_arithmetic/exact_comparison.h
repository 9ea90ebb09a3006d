#pragma once
#include <array>
#include <cstdint>

#include "testbench/check/conformance/conformance_result.h"
#include "testbench/check/conformance/end_to_end.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/prove/exact_arithmetic/exact_model.h"

namespace tessera {

/// The decisions that are compared with those of the exact model.
enum class Decided { normal, summed_height, view, tex_coord, generation, highlight, split, count };

/// The results of a job with one set of formats.
struct ExactComparison {
    // As in statistics.json and conformance.json of `tessera run`.
    std::uint64_t triangles = 0;
    std::uint64_t edges = 0;  ///< tested
    std::uint64_t edges_split = 0;
    ConformanceResult conformance;  ///< each edge against the golden model with the same rounded ends
    InvariantResult invariants;
    EndToEndResult end_to_end;
    datapath::Saturations saturations;

    /// Number of edges on which a decision differs from the exact model, which follows the machine's splits: every
    /// vertex has its exact counterpart, and every edge is decided again from these.
    std::array<std::uint64_t, static_cast<std::size_t>(Decided::count)> flips{};
    /// Distance of P' from its exact counterpart, over base and inserted vertices; model units.
    std::uint64_t positions = 0;
    double position_max = 0;
    double position_rms = 0;
    double position_lsb = 0;  ///< one LSB of the position in model units

    std::uint64_t flips_of(Decided decided) const { return flips[static_cast<std::size_t>(decided)]; }
};

/// Runs the bare datapath: functional mode's results. Throws ResourceError beyond `most_triangles`.
ExactComparison compare_with_exact(const MachineSetup& setup, const ExactModel& exact, std::uint64_t most_triangles);

}  // namespace tessera

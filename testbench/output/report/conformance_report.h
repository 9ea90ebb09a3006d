#pragma once
#include <optional>
#include <string>
#include <vector>

#include "testbench/check/conformance/conformance_result.h"
#include "testbench/check/conformance/end_to_end.h"
#include "testbench/check/conformance/setup_check.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/check/transport/read_check.h"
#include "testbench/check/transport/transport_check.h"
#include "testbench/compare/bound_check.h"
#include "testbench/output/report/figure.h"

namespace tessera {

/// The results of a run's checks; absent for checks disabled by the job.
struct Checks {
    std::optional<SetupResult> setup;
    std::optional<ConformanceResult> conformance;
    std::optional<EndToEndResult> end_to_end;
    std::optional<InvariantResult> invariants;
    std::optional<WorkResult> work;
    std::optional<ReadResult> reads;
    std::optional<BoundResult> bound;   ///< with a Bound Test
    double allowed_flips = 0.5;         ///< percent of edges
    std::vector<std::string> remarks;   ///< repairs and anomalies of mesh and map; one sentence each
    std::vector<std::string> warnings;  ///< for the summary: causes of differences from golden, each with its remedy

    bool passed() const {
        return (!setup || setup->passed()) && (!conformance || conformance->passed(allowed_flips)) &&
               (!end_to_end || end_to_end->passed()) && (!invariants || invariants->passed()) &&
               (!work || work->passed()) && (!reads || reads->passed()) && (!bound || bound->passed());
    }
    bool any() const { return setup || conformance || end_to_end || invariants || work || reads; }
};

/// report.txt: the verdict, the remarks, and every figure of the checks and of `statistics` for reading.
std::string report_text(const Checks& checks, const std::vector<Figure>& statistics);

/// conformance.json: the checks' figures, each group in an object of its own.
std::string conformance_json(const Checks& checks);

}  // namespace tessera

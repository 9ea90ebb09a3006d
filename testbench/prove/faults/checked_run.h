#pragma once
#include <optional>
#include <string>
#include <vector>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/check/transport/transport_check.h"
#include "testbench/common/error.h"
#include "testbench/machine/simulation.h"
#include "testbench/prove/faults/checked_units.h"
#include "testbench/prove/faults/fault_report.h"

namespace tessera {

/// How the simulation of a run with a fault ended. Unlike Simulation::run(), nothing is thrown: an error of the machine
/// is what is waited for.
struct FaultRun {
    std::optional<Caught>
        stopped;  ///< by the watchdog, an error of a unit or a resource limit; else it drained
    ExitCode code = ExitCode::fine;  ///< of that
    std::string text;                ///< of that, whole
};

FaultRun run_with_fault(Simulation& simulation);

/// Over all read checks.
ReadResult read_result(const CheckedUnits& units);

/// Who detected something, in this order: who stopped the run, read check, scoreboard, work conservation,
/// invariants. The last two only of a run that drained; those not asked for are null.
std::vector<Caught> who_noticed(const CheckedUnits& units, const FaultRun& run,
                                const ConformanceResult* conformance, const WorkResult* work,
                                const InvariantResult* invariants);

/// The same of the fault. Throws InputError if the fault's transaction never came, has no such bit, or was to change
/// places with one that never came.
FaultReport judge_fault(const Job::Fault& fault, const CheckedUnits& units, const FaultRun& run, bool timed,
                        const ConformanceResult* conformance, const WorkResult* work,
                        const InvariantResult* invariants);

}  // namespace tessera

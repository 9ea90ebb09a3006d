#include "testbench/prove/faults/checked_run.h"

#include <fmt/core.h>

#include <string_view>

#include "testbench/job/job_choices.h"

namespace tessera {

namespace {

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

/// The check behind an SC_ERROR, by its message type.
const char* checker_of(std::string_view type) {
    if (type == "tessera/protocol")
        return "protocol checker";
    if (type == "tessera/memory")
        return "memory response";
    return type.substr(0, 8) == "tessera/" ? "unit's own check" : "simulation kernel";
}

bool counts_held_back(FaultKind kind) {
    return kind == FaultKind::back_pressure_ignored || kind == FaultKind::request_before_end ||
           kind == FaultKind::response_early;
}

std::string injected_text(const Job::Fault& fault, const FaultTrigger& trigger, bool timed) {
    std::string text =
        fmt::format("{} at {}, transaction {}", name_of(fault.kind), fault.place, fault.transaction);
    if (counts_held_back(fault.kind))
        text += " of those held back";
    if (fault.kind == FaultKind::bit_flip || fault.kind == FaultKind::address_flip)
        text += fmt::format(", bit {}", fault.bit);
    if (timed)
        text += fmt::format(", cycle {}", trigger.cycle());
    return text;
}

}  // namespace

FaultRun run_with_fault(Simulation& simulation) {
    FaultRun run;
    try {
        run.text = simulation.run();
        if (!run.text.empty()) {
            run.stopped = Caught{"watchdog", first_line(run.text)};
            run.code = ExitCode::deadlock;
        }
    } catch (const sc_core::sc_report& report) {
        run.stopped = Caught{checker_of(report.get_msg_type()), report.get_msg()};
        run.text = report.what();
        run.code = ExitCode::check_failed;
    } catch (const ResourceError& error) {
        run.stopped = Caught{"resource limit", error.what()};
        run.text = error.what();
        run.code = ExitCode::resource_limit;
    }
    return run;
}

ReadResult read_result(const CheckedUnits& units) {
    ReadResult result;
    for (const auto& check : units.read_checks()) {
        const ReadResult& one = check->result();
        result.entries += one.entries;
        result.wrong += one.wrong;
        if (result.first_wrong.empty())
            result.first_wrong = one.first_wrong;
    }
    return result;
}

std::vector<Caught> who_noticed(const CheckedUnits& units, const FaultRun& run,
                                const ConformanceResult* conformance, const WorkResult* work,
                                const InvariantResult* invariants) {
    std::vector<Caught> detected;
    if (run.stopped)
        detected.push_back(*run.stopped);
    const ReadResult reads = read_result(units);
    if (!reads.passed())
        detected.push_back({"read check", reads.first_wrong});
    if (conformance != nullptr && conformance->mismatches > 0)
        detected.push_back({"scoreboard", first_line(conformance->first_mismatch)});
    if (run.stopped)
        return detected;
    if (work != nullptr && !work->passed())
        detected.push_back({"work conservation", work->first_violation});
    if (invariants != nullptr && !invariants->passed())
        detected.push_back({"invariants", first_line(invariants->first_violation)});
    return detected;
}

FaultReport judge_fault(const Job::Fault& fault, const CheckedUnits& units, const FaultRun& run, bool timed,
                        const ConformanceResult* conformance, const WorkResult* work,
                        const InvariantResult* invariants) {
    const FaultTrigger& trigger = units.trigger();
    if (!trigger.injected())
        throw InputError(
            fmt::format("fault.transaction = {} was never reached: {} saw {} transactions{}; lower it, or "
                        "choose a longer "
                        "job{}",
                        fault.transaction, fault.place, trigger.seen(),
                        counts_held_back(fault.kind) ? " that were held back" : "",
                        counts_held_back(fault.kind) ? ", a smaller buffer or timing.stalls_per_mille" : ""));
    if (trigger.no_such_bit())
        throw InputError(fmt::format("fault.bit = {}: the transaction at {} has fewer bits; lower it",
                                     fault.bit, fault.place));

    // Whoever stops a run by an error may do so before the next transaction could come.
    if (trigger.waits_for_next() && (!run.stopped || run.code == ExitCode::deadlock))
        throw InputError(
            fmt::format("fault.kind = \"{}\": no later transaction came at {} for fault.transaction = {} to "
                        "change places "
                        "with; lower it, or choose another place",
                        name_of(fault.kind), fault.place, fault.transaction));

    return {injected_text(fault, trigger, timed), who_noticed(units, run, conformance, work, invariants)};
}

}  // namespace tessera

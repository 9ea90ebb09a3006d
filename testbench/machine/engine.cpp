#include "testbench/machine/engine.h"

#include <fmt/core.h>

#include <string>

#include "modules/conductor.h"
#include "testbench/common/error.h"
#include "testbench/job/job_choices.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/toml_text.h"

namespace tessera {

namespace {

/// The first key whose value requires the clocked engine; empty if none does.
std::string key_without_schedule(const Job& job, const MachineSetup& setup) {
    if (job.output.vcd)
        return "output.vcd";
    if (job.output.timeline)
        return "output.timeline";
    if (job.check.reads)
        return "check.reads";
    // The limit counts the cycles in which the clock called a unit.
    if (job.limits.cycles_without_progress < Job::Limits{}.cycles_without_progress)
        return "limits.cycles_without_progress";
    return Conductor::key_without_schedule(setup.design, setup.registers.formats);
}

}  // namespace

void choose_engine(const Job& job, MachineSetup& setup) {
    setup.scheduled = false;
    if (job.mode != Mode::timed)
        return;
    if (job.timing.engine == Engine::clocked) {
        setup.engine_reason = "timing.engine";
        return;
    }
    const std::string name = key_without_schedule(job, setup);
    if (name.empty()) {
        setup.scheduled = true;
        setup.engine_reason = job.timing.engine == Engine::schedule ? "timing.engine" : "this design supports it";
        return;
    }
    const Key& key = *find_key(name);
    const std::string value = toml_value(key.get(job));
    if (job.timing.engine == Engine::schedule)
        throw InputError(fmt::format(
            "`timing.engine` = \"schedule\", but `{0}` = {1} has no schedule: set {0} = {2}, or timing.engine = \"auto\"",
            name, value, toml_value(default_of(key))));
    setup.engine_reason = fmt::format("{} = {} has no schedule", name, value);
}

}  // namespace tessera

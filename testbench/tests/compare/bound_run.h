#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "testbench/compare/bound_check.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/inputs.h"
#include "testbench/output/report/indexed_mesh.h"
#include "testbench/tests/support/bare_mesh.h"
#include "testbench/tests/support/job_settings.h"

namespace tessera::testing {

inline Inputs inputs_of(const std::string& settings) {
    Job job = with_settings({}, settings);
    validate(job);
    resolve_paths(job, {});
    return load_inputs(job);
}

/// A job as the program runs it, without the machine: its mesh is the bare recursion's.
struct BoundRun {
    explicit BoundRun(const std::string& settings)
        : inputs(inputs_of(settings)), setup(make_setup(job, inputs.mesh, inputs.map)) {
        BareRecursion bare(setup);
        finished = bare.run(emitted, most_edges) < most_edges;
        mesh = recorded_mesh(
            emitted, {setup.registers.formats, setup.registers.map, setup.model_scale.scale, setup.model_scale.centre});
        const datapath::Saturations saturations = bare.saturations;
        const InputSaturations& input = setup.input_saturations;
        saturated = saturations.displaced_position + saturations.view_distance + input.position + input.registers > 0;
        result = check_bound(job, inputs.mesh, inputs.map, setup, mesh, saturated);
    }

    /// The remark on the bound; empty: none.
    std::string remark() const {
        for (const std::string& text : setup.remarks)
            if (text.find("tests.bound_threshold = ") == 0)
                return text;
        return {};
    }
    std::string words() const { return remark() + " | " + (result ? result->text() : std::string()); }

    static constexpr std::uint64_t most_edges = 2000000;
    Inputs inputs;
    const Job& job = inputs.resolved.job;
    MachineSetup setup;
    EmittedMesh emitted;
    RecordedMesh mesh;
    bool finished = false, saturated = false;
    std::optional<BoundResult> result;
};

}  // namespace tessera::testing

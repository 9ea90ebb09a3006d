#include "testbench/commands/run_job.h"

#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/conformance/texel_borders.h"
#include "testbench/check/transport/conservation.h"
#include "testbench/commands/load_job.h"
#include "testbench/commands/output_folder.h"
#include "testbench/commands/progress.h"
#include "testbench/commands/run_files.h"
#include "testbench/commands/run_frames.h"
#include "testbench/commands/summary.h"
#include "testbench/common/atomic_file.h"
#include "testbench/common/atomic_set.h"
#include "testbench/job/dump_job.h"
#include "testbench/machine/fingerprint.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/simulation.h"
#include "testbench/output/picture/render_run.h"
#include "testbench/output/report/conformance_report.h"
#include "testbench/output/report/obj_writer.h"
#include "testbench/output/report/ply_writer.h"
#include "testbench/output/report/statistics.h"
#include "testbench/output/report/timing_report.h"
#include "testbench/output/trace/traces.h"
#include "testbench/prove/faults/checked_run.h"
#include "testbench/prove/faults/faultless_run.h"

namespace tessera {

namespace {

/// A job's mesh and map, and what the host makes of them.
struct Loaded {
    Inputs inputs;
    MachineSetup setup;
};

/// What was mended in the job's mesh and map on the way in joins the setup's own remarks.
Loaded load(const Job& asked) {
    Loaded loaded{load_inputs(asked), {}};
    const Inputs& inputs = loaded.inputs;
    loaded.setup = make_setup(inputs.resolved.job, inputs.mesh, inputs.map);
    std::vector<std::string> remarks;
    for (const std::string& repair : inputs.mesh.repairs)
        remarks.push_back("mesh: " + repair);
    for (const std::string& repair : inputs.map.repairs)
        remarks.push_back("map: " + repair);
    loaded.setup.remarks.insert(loaded.setup.remarks.begin(), remarks.begin(), remarks.end());
    return loaded;
}

class Stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void write_run_folder(const std::filesystem::path& folder, const Job& job, const MachineSetup& setup,
                      const Simulation& simulation, const MeshCounts& counts, const Checks& checks,
                      Progress& progress) {
    progress.show("writing reports", 0.85);
    write_file(folder / "job.toml", dump_job(job, folder));
    const std::vector<Figure> figures = collect_statistics(setup, simulation, counts);
    write_file(folder / "statistics.json", statistics_json(figures));
    write_file(folder / "statistics.csv", statistics_csv(figures));
    write_file(folder / "conformance.txt", conformance_text(checks));
    write_file(folder / "conformance.json", conformance_json(checks));
    const MeshUnits units{setup.registers.formats, setup.registers.map, setup.model_scale.scale,
                          setup.model_scale.centre};
    if (job.mode == Mode::timed) {
        write_file(folder / "timing.txt", timing_text(simulation.pipeline, simulation.cycles()));
        write_file(folder / "queue_levels.csv",
                   queue_levels_csv(simulation.pipeline.triangle_queue.history()));
    }
    progress.show("writing the mesh", 0.87);
    if (job.output.ply)
        write_ply(folder / "mesh.ply", simulation.monitor.mesh, units);
    if (job.output.obj)
        write_obj(folder / "mesh.obj", simulation.monitor.mesh, units);
    if (job.output.picture) {
        progress.show("picture", 0.9);
        write_picture(folder / "picture.png", simulation.monitor.mesh, setup, job);
    }
}

/// The traces' names and windows, and trace.fst if asked for.
std::string finish_traces(Traces& traces, const Command& command, const std::filesystem::path& folder,
                          AtomicSet& files) {
    traces.finish();
    std::string text;
    for (const std::string& line : traces.text())
        text += fmt::format("  {}\n", line);
    if (command.fst) {
        const std::string fault = make_fst(folder, files);
        text += fmt::format("  {}\n", fault.empty() ? "trace.fst: the same, compressed" : fault);
    }
    return text;
}

const char* verdict(const Checks& checks) {
    if (!checks.passed())
        return "CHECKS FAILED, see conformance.txt";
    const bool any = checks.setup || checks.conformance || checks.end_to_end || checks.invariants ||
                     checks.work || checks.reads;
    return any ? "all checks passed" : "nothing was checked";
}

/// What a run came to, and what it has to say of it.
struct Ending {
    ExitCode code;
    std::string text;
};

/// A run with a fault, or of the same machine without it, and what its checks found.
struct CheckedFaultRun {
    FaultRun run;
    Checks checks;

    template <class T>
    static const T* if_there(const std::optional<T>& part) {
        return part ? &*part : nullptr;
    }
    std::vector<Caught> detected(const CheckedUnits& units) const {
        return who_noticed(units, run, if_there(checks.conformance), if_there(checks.work),
                           if_there(checks.invariants));
    }
};

CheckedFaultRun check_fault_run(const Job& job, const MachineSetup& setup, Simulation& simulation,
                                const CheckedUnits& units, const Scoreboard* scoreboard,
                                const TransportCheck* work) {
    CheckedFaultRun result;
    result.run = run_with_fault(simulation);
    Checks& checks = result.checks;
    checks.allowed_flips = job.check.allowed_flips;
    checks.remarks = setup.remarks;
    checks.reads = read_result(units);
    if (scoreboard != nullptr)
        checks.conformance = scoreboard->result();
    if (work != nullptr && !result.run.stopped)
        checks.work = work_result(*work, simulation);
    if (job.check.invariants && !result.run.stopped)
        checks.invariants = check_invariants(simulation.monitor.mesh, setup.base_triangles, setup.registers);
    return result;
}

/// A run with a fault leaves its conformance report and its job, and no mesh that anyone could take for a result.
Ending run_faulty(const Job& job, const MachineSetup& setup, Simulation& simulation, CheckedUnits& units,
                  const Scoreboard* scoreboard, const TransportCheck* work, Progress& progress) {
    progress.show("running without the fault", 0);
    require_sound_without_fault([&] {
        units.disarm();
        return check_fault_run(job, setup, simulation, units, scoreboard, work).detected(units);
    });
    progress.show("running with the fault", 0.5);
    auto [run, checks] = check_fault_run(job, setup, simulation, units, scoreboard, work);
    checks.fault = judge_fault(
        job.fault, units, run, job.mode == Mode::timed, CheckedFaultRun::if_there(checks.conformance),
        CheckedFaultRun::if_there(checks.work), CheckedFaultRun::if_there(checks.invariants));
    const std::filesystem::path folder = job.output.folder;
    OutputFolder output(folder);
    AtomicSet files;
    write_file(folder / "job.toml", dump_job(job, folder));
    write_file(folder / "conformance.txt", conformance_text(checks));
    write_file(folder / "conformance.json", conformance_json(checks));
    replace_run(folder, files);
    output.keep();
    progress.clear();
    if (run.stopped)
        fmt::print(stderr, "tessera: {}\n", run.text);
    ExitCode code = run.code;
    if (checks.fault->caught.empty())
        code = ExitCode::fault_missed;
    else if (!run.stopped)
        code = ExitCode::check_failed;
    return {code, fmt::format("{}  results in {}\n", fault_text(*checks.fault),
                              std::filesystem::absolute(folder).lexically_normal().string())};
}

/// `name` tells the run from others, on the line that shows its progress. What it leaves takes the place of an earlier
/// run in `replaced`: job.output.folder, or one above it.
Ending run_once(const Job& asked, const Command& command, const std::string& name,
                const std::filesystem::path& replaced) {
    const std::filesystem::path folder = asked.output.folder;
    check_output_folder(folder);

    Progress progress(name);
    progress.show("reading mesh and map", 0);
    const Loaded loaded = load(asked);
    const Inputs& inputs = loaded.inputs;
    const MachineSetup& setup = loaded.setup;
    const Job& job = inputs.resolved.job;

    std::optional<CheckedUnits> checked_units;
    if (CheckedUnits::wanted(job))
        checked_units.emplace(job, setup.registers.formats, tag_bits_in_use(setup.design));
    Simulation simulation(setup, static_cast<std::uint64_t>(job.limits.triangles),
                          static_cast<std::uint64_t>(job.limits.cycles_without_progress),
                          checked_units ? &*checked_units : nullptr);
    if (checked_units)
        checked_units->require_placed();
    std::optional<GoldenInputs> golden;
    std::unique_ptr<Scoreboard> scoreboard;
    if (job.check.golden) {
        golden.emplace(setup);
        scoreboard = std::make_unique<Scoreboard>(setup.registers, *golden);
        simulation.pipeline.pass_or_tessellate.decided.bind(*scoreboard);
    }
    std::unique_ptr<TransportCheck> work;
    if (job.check.work) {
        work = std::make_unique<TransportCheck>(setup.registers, setup.base_triangles);
        simulation.pipeline.pass_or_tessellate.decided.bind(*work);
        simulation.pipeline.pass_or_tessellate.finished.bind(*work);
        simulation.rasteriser.taken.bind(*work);
    }
    if (job.fault.kind != FaultKind::none)
        return run_faulty(job, setup, simulation, *checked_units, scoreboard.get(), work.get(), progress);
    TexelBorders borders(setup.registers.formats);
    simulation.pipeline.pass_or_tessellate.decided.bind(borders);
    simulation.monitor.on_progress([&](std::size_t triangles) {
        progress.show(
            fmt::format("simulating, {} triangles", triangles),
            0.6 * static_cast<double>(simulation.host.sent()) / static_cast<double>(simulation.host.total()));
    });

    std::optional<OutputFolder> output;
    AtomicSet files;
    std::optional<Traces> traces;
    if (Traces::wanted(job)) {
        const std::vector<const Unit*> units = units_to_trace(job.output.trace_units, simulation.pipeline);
        output.emplace(folder);
        traces.emplace(job, folder, simulation, units);
    }

    const Stopwatch stopwatch;
    const std::string stuck = simulation.run();
    const double seconds = stopwatch.seconds();
    const std::string traces_text = traces ? finish_traces(*traces, command, folder, files) : std::string{};
    if (!stuck.empty()) {
        progress.clear();
        fmt::print(stderr, "tessera: {}", stuck);
        if (traces) {
            write_file(folder / "job.toml", dump_job(job, folder));
            replace_run(replaced, files);
            output->keep();
            fmt::print(stderr, "{}  in {}\n", traces_text,
                       std::filesystem::absolute(folder).lexically_normal().string());
        }
        return {ExitCode::deadlock, {}};
    }

    EmittedMesh& mesh = simulation.monitor.mesh;
    mesh.sort();
    Checks checks;
    checks.allowed_flips = job.check.allowed_flips;
    checks.remarks = setup.remarks;
    if (scoreboard)
        checks.conformance = scoreboard->result();
    if (work)
        checks.work = work_result(*work, simulation);
    if (checked_units)
        checks.reads = read_result(*checked_units);
    checks.texel_borders =
        texel_borders_warning(borders.count(), job, setup.registers.map.width, setup.registers.map.height);
    std::optional<GoldenJob> golden_job;
    if (job.check.golden || job.check.end_to_end) {
        progress.show("checking the set-up", 0.6);
        golden_job.emplace(job, inputs.mesh, inputs.map, setup.model_scale);
        checks.setup = check_setup(setup, *golden_job, simulation);
    }
    if (job.check.invariants) {
        progress.show("checking the mesh", 0.62);
        checks.invariants = check_invariants(mesh, setup.base_triangles, setup.registers);
    }
    if (job.check.end_to_end) {
        // Golden's own run saturates nothing: with values that did there is nothing to judge it by.
        const datapath::Saturations saturated = simulation.pipeline.saturations();
        const bool judged =
            saturated.displaced_position + saturated.screen_position + saturated.view_distance == 0;
        checks.end_to_end = compare_end_to_end(
            setup, *golden_job, checks.setup->base_triangles, mesh,
            judged ? job.check.allowed_triangles : std::numeric_limits<double>::infinity(),
            [&](double part) { progress.show("golden model's own run and distances", 0.65 + 0.2 * part); });
    }
    if (!output)
        output.emplace(folder);
    const MeshCounts counts = count_mesh(mesh);
    write_run_folder(folder, job, setup, simulation, counts, checks, progress);
    replace_run(replaced, files);
    output->keep();
    progress.clear();

    return {checks.passed() ? ExitCode::fine : ExitCode::check_failed,
            fmt::format("{}{}{}  {}\n  results in {}\n", found_text(inputs.resolved.found),
                        summary(setup, simulation, counts, checks, seconds), traces_text, verdict(checks),
                        std::filesystem::absolute(folder).lexically_normal().string())};
}

}  // namespace

ExitCode run_job(const Command& command) {
    Job job = load_job(command.job_file, command.settings, command.data_folder);
    if (command.dump_config) {
        fmt::print("{}", dump_job(job));
        return ExitCode::fine;
    }
    if (!command.trace_option.empty() && !Traces::wanted(job))
        throw InputError(
            fmt::format("{} chooses what to trace, and nothing is traced: add --vcd, --timeline or both",
                        command.trace_option));
    require_run_folder(job);
    require_inputs_stay(job);
    record_fingerprints(job);
    if (job.frames.count > 1)
        return run_frames(
            job, [&](const Job& frame, const std::string& name, const std::filesystem::path& replaced) {
                return run_once(frame, command, name, replaced).code;
            });
    const Ending ending = run_once(job, command, {}, job.output.folder);
    fmt::print("{}", ending.text);
    return ending.code;
}

}  // namespace tessera

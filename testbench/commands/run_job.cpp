#include "testbench/commands/run_job.h"

#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "testbench/check/conformance/difference_advice.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/conformance/texel_borders.h"
#include "testbench/check/transport/conservation.h"
#include "testbench/check/transport/read_checked_units.h"
#include "testbench/commands/progress.h"
#include "testbench/commands/run_files.h"
#include "testbench/commands/summary.h"
#include "testbench/common/atomic_file.h"
#include "testbench/common/atomic_set.h"
#include "testbench/common/in_background.h"
#include "testbench/common/parallel.h"
#include "testbench/compare/bound_check.h"
#include "testbench/job/dump_job.h"
#include "testbench/job/read_job.h"
#include "testbench/machine/design_remarks.h"
#include "testbench/machine/fingerprint.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/simulation.h"
#include "testbench/machine/totals.h"
#include "testbench/output/report/conformance_report.h"
#include "testbench/output/report/indexed_mesh.h"
#include "testbench/output/report/obj_writer.h"
#include "testbench/output/report/ply_writer.h"
#include "testbench/output/report/statistics.h"
#include "testbench/output/report/timing_report.h"
#include "testbench/output/trace/traces.h"
#include "testbench/render/png_writer.h"
#include "testbench/render/view_picture.h"

namespace tessera {

namespace {

using PassSink = tlm::tlm_analysis_if<datapath::TrianglePass>;

/// Passes a simulation's decided passes to checks on another thread.
class PassesInBackground : public PassSink {
  public:
    explicit PassesInBackground(const std::vector<PassSink*>& checks)
        : passes_([checks](const datapath::TrianglePass& pass) {
              for (PassSink* check : checks)
                  check->write(pass);
          }) {}

    void write(const datapath::TrianglePass& pass) override { passes_.put(pass); }
    void finish() { passes_.finish(); }

  private:
    InBackground<datapath::TrianglePass> passes_;
};

/// A job's mesh and map, and the setup made from them.
struct Loaded {
    Inputs inputs;
    MachineSetup setup;
};

/// Loads the job's inputs. Repairs of its mesh and map are added to the setup's remarks.
Loaded load(const Job& asked) {
    Loaded loaded{load_inputs(asked), {}};
    const Inputs& inputs = loaded.inputs;
    loaded.setup = make_setup(inputs.resolved.job, inputs.mesh, inputs.map);
    const std::vector<std::string> remarks = repairs_of(inputs.mesh, inputs.map);
    loaded.setup.remarks.insert(loaded.setup.remarks.begin(), remarks.begin(), remarks.end());
    for (std::string& remark : design_remarks(inputs.resolved.job, loaded.setup))
        loaded.setup.remarks.push_back(std::move(remark));
    return loaded;
}

MeshUnits units_of(const MachineSetup& setup) {
    return {setup.registers.formats, setup.registers.map, setup.model_scale.scale, setup.model_scale.centre};
}

void write_mesh_and_picture(const std::filesystem::path& folder, const Job& job, const MachineSetup& setup,
                            const EmittedMesh& mesh) {
    // An AtomicSet is for one thread at a time: the picture's file is written after these.
    auto mesh_files = beside([&] {
        if (job.output.ply)
            write_ply(folder / "mesh.ply", mesh, units_of(setup));
        if (job.output.obj)
            write_obj(folder / "mesh.obj", mesh, units_of(setup));
    });
    std::string picture;
    if (job.output.picture)
        picture =
            encode_png(render_views(make_render_mesh(mesh, setup), make_view(job.camera), {PictureView::overview}, {})
                           .front()
                           .image);
    mesh_files.get();
    if (job.output.picture)
        write_file(folder / "picture.png", picture);
}

void write_reports(const std::filesystem::path& folder, const Job& job, const MachineSetup& setup,
                   const Simulation& simulation, const MeshCounts& counts, const Checks& checks) {
    write_file(folder / "job.toml", dump_job(job, folder));
    const std::vector<Figure> figures = collect_statistics(setup, simulation, counts);
    write_file(folder / "statistics.json", statistics_json(figures));
    write_file(folder / "statistics.csv", statistics_csv(figures));
    write_file(folder / "conformance.json", conformance_json(checks));
    write_file(folder / "report.txt", report_text(checks, figures));
    if (job.mode == Mode::timed)
        write_file(folder / "queue_levels.csv",
                   queue_levels_csv(simulation.last_machine().machine.triangle_queue.history()));
}

/// Name and window of the waveforms; writes trace.fst if requested.
std::string finish_traces(Traces& traces, const Command& command, const std::filesystem::path& folder,
                          AtomicSet& files) {
    traces.finish();
    std::string text = fmt::format("  {}\n", traces.text());
    if (command.fst) {
        const std::string fault = make_fst(folder, files);
        text += fmt::format("  {}\n", fault.empty() ? "trace.fst: the same, compressed" : fault);
    }
    return text;
}

const char* verdict(const Checks& checks) {
    if (!checks.passed())
        return "CHECKS FAILED, see report.txt";
    return checks.any() ? "all checks passed" : "nothing was checked";
}

/// Verdict and messages of a run.
struct Ending {
    ExitCode code;
    std::string text;
};

Ending run_once(const Job& asked, const Command& command) {
    const std::filesystem::path folder = asked.output.folder;
    check_output_folder(folder);

    Progress progress;
    progress.show("reading mesh and map", 0);
    const Loaded loaded = load(asked);
    const Inputs& inputs = loaded.inputs;
    const MachineSetup& setup = loaded.setup;
    const Job& job = inputs.resolved.job;

    auto golden_made = beside([&] {
        return job.check.golden || job.check.end_to_end
                   ? std::make_unique<GoldenJob>(job, inputs.mesh, inputs.map, setup.model_scale, setup)
                   : nullptr;
    });
    std::optional<ReadCheckedUnits> checked_units;
    if (job.check.reads)
        checked_units.emplace();
    Simulation simulation(setup, static_cast<std::uint64_t>(job.limits.triangles),
                          static_cast<std::uint64_t>(job.limits.cycles_without_progress),
                          checked_units ? &*checked_units : nullptr);
    std::vector<PassSink*> pass_checks;
    std::optional<GoldenInputs> golden;
    std::unique_ptr<Scoreboard> scoreboard;
    if (job.check.golden) {
        golden.emplace(setup);
        scoreboard = std::make_unique<Scoreboard>(setup.registers, *golden);
        pass_checks.push_back(scoreboard.get());
    }
    std::unique_ptr<TransportCheck> work;
    if (job.check.work) {
        work = std::make_unique<TransportCheck>(setup.registers, setup.base_triangles);
        observe_finished(simulation, *work);
        pass_checks.push_back(work.get());
    }
    std::optional<PassesInBackground> passes;
    if (!pass_checks.empty()) {
        passes.emplace(pass_checks);
        simulation.observe_decisions(*passes);
    }
    TexelBorders borders(setup.registers.formats);
    for (const auto& hosted : simulation.machines)
        hosted->machine.pass_or_tessellate.decided.bind(borders);
    simulation.monitor.on_progress([&](std::size_t triangles) {
        progress.show(fmt::format("simulating, {} triangles", triangles),
                      0.6 * static_cast<double>(simulation.sent()) / static_cast<double>(setup.base_triangles.size()));
    });

    AtomicSet files;
    std::optional<Traces> traces;
    if (job.output.vcd) {
        const std::vector<const Unit*> units = units_to_trace(job.output.trace_units, simulation.machine);
        files.make_folder(folder, "output.folder");
        traces.emplace(job, folder, simulation, units);
    }

    Checks checks;
    checks.allowed_flips = job.check.allowed_flips;
    checks.remarks = setup.remarks;
    const std::unique_ptr<GoldenJob> golden_job = golden_made.get();
    std::optional<GoldenRun> golden_run;
    if (job.check.end_to_end)
        golden_run.emplace(*golden_job, received_triangles(setup, *golden_job),
                           static_cast<std::uint64_t>(job.limits.triangles));

    const auto start = std::chrono::steady_clock::now();
    const std::string stuck = simulation.run();
    if (passes)
        passes->finish();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::string traces_text = traces ? finish_traces(*traces, command, folder, files) : std::string{};
    if (!stuck.empty()) {
        progress.clear();
        fmt::print(stderr, "tessera: {}", stuck);
        if (traces) {
            write_file(folder / "job.toml", dump_job(job, folder));
            replace_run(folder, files);
            fmt::print(stderr, "{}  in {}\n", traces_text,
                       std::filesystem::absolute(folder).lexically_normal().string());
        }
        return {ExitCode::deadlock, {}};
    }

    if (scoreboard) {
        checks.conformance = scoreboard->result();
        golden.reset();  // 36 bytes per texel
    }
    progress.show("checking the set-up", 0.6);
    auto setup_result = beside([&] {
        return golden_job ? std::optional<SetupResult>(check_setup(setup, *golden_job, simulation)) : std::nullopt;
    });
    EmittedMesh& mesh = simulation.monitor.mesh;
    mesh.sort();
    auto invariants = beside([&] {
        return job.check.invariants ? std::optional<InvariantResult>(check_invariants(mesh, setup)) : std::nullopt;
    });
    if (work)
        checks.work = work_result(*work, simulation);
    if (checked_units)
        checks.reads = checked_units->result();
    const auto warn = [&](std::string warning) {
        if (!warning.empty())
            checks.warnings.push_back(std::move(warning));
    };
    warn(texel_borders_warning(borders.count(), job, setup.registers.map.width, setup.registers.map.height));
    checks.setup = setup_result.get();
    if (golden_run) {
        // Golden's own run does not saturate, so with saturated values the meshes cannot be compared.
        const datapath::Saturations saturated = Totals(simulation).saturations;
        const bool judged = saturated.displaced_position + saturated.screen_position + saturated.view_distance == 0;
        progress.show("golden model's own run", 0.62);
        checks.end_to_end = golden_run->compare(
            setup, mesh, judged ? job.check.allowed_triangles : std::numeric_limits<double>::infinity(),
            [&](double part) { progress.show("distances", 0.65 + 0.15 * part); });
        golden_run.reset();
    }
    if ((checks.conformance && checks.conformance->flips_percent() > checks.allowed_flips) ||
        (checks.end_to_end && !checks.end_to_end->passed()))
        warn(difference_advice(job, checks.conformance ? checks.conformance->flips_percent() : 0,
                               checks.end_to_end && !checks.end_to_end->passed() ? &*checks.end_to_end : nullptr));
    if (setup.bound_asked) {
        progress.show("measuring the bound", 0.8);
        const Totals totals(simulation);
        const datapath::Saturations& run = totals.saturations;
        const InputSaturations& input = setup.input_saturations;
        checks.bound = check_bound(job, inputs.mesh, inputs.map, setup, recorded_mesh(mesh, units_of(setup)),
                                   run.displaced_position + run.view_distance + input.position + input.registers > 0);
    }
    files.make_folder(folder, "output.folder");
    progress.show("mesh and picture", 0.8);
    auto mesh_counts = beside([&] { return count_mesh(mesh); });
    write_mesh_and_picture(folder, job, setup, mesh);
    progress.show("checking the mesh", 0.95);
    checks.invariants = invariants.get();
    const MeshCounts counts = mesh_counts.get();
    write_reports(folder, job, setup, simulation, counts, checks);
    replace_run(folder, files);
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
    if (!command.trace_option.empty() && !job.output.vcd)
        throw InputError(fmt::format("{} selects what to trace, but tracing is off: add --vcd", command.trace_option));
    require_run_folder(job);
    require_inputs_stay(job);
    record_fingerprints(job);
    const Ending ending = run_once(job, command);
    fmt::print("{}", ending.text);
    return ending.code;
}

}  // namespace tessera

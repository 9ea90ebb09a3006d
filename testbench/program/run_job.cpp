#include "testbench/program/run_job.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include "testbench/check/scoreboard.h"
#include "testbench/common/atomic_file.h"
#include "testbench/host/inputs.h"
#include "testbench/host/simulation.h"
#include "testbench/job/dump_job.h"
#include "testbench/job/read_job.h"
#include "testbench/job/validate_job.h"
#include "testbench/program/progress.h"
#include "testbench/program/summary.h"
#include "testbench/render/render_run.h"
#include "testbench/report/conformance_report.h"
#include "testbench/report/obj_writer.h"
#include "testbench/report/ply_writer.h"
#include "testbench/report/statistics.h"

namespace tessera {

namespace {

Job load_job(const Command& command) {
    Job job = command.job_file.empty() ? Job{} : read_job(command.job_file);
    for (const std::string& setting : command.settings)
        apply_setting(job, setting);
    validate(job);
    return job;
}

[[noreturn]] void refuse_run_folder(const std::filesystem::path& folder, const std::string& why) {
    throw InputError(
        fmt::format("output.folder = \"{}\": cannot write there: {}; choose another", folder.string(), why));
}

/// Finds out before a long run whether its folder can be written, and leaves no trace: a run that fails leaves nothing.
void check_run_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::path there = std::filesystem::absolute(folder).lexically_normal();
    while (!std::filesystem::exists(std::filesystem::symlink_status(there, error)) &&
           there.has_relative_path())
        there = there.parent_path();
    if (!std::filesystem::is_directory(there, error))
        refuse_run_folder(folder, fmt::format("{} is no folder", there.string()));
    if (access(there.c_str(), W_OK | X_OK) != 0)
        refuse_run_folder(folder,
                          fmt::format("{}: {}", there.string(), std::generic_category().message(errno)));
}

void make_run_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        refuse_run_folder(folder, error.message());
}

/// What was mended in the job's mesh and map on the way in joins the setup's own remarks.
Setup load_setup(const Job& job, const std::filesystem::path& data_folder) {
    const BaseMesh mesh = load_mesh(job, data_folder);
    const HeightMap map = load_map(job, data_folder);
    Setup setup = make_setup(job, mesh, map);
    std::vector<std::string> remarks;
    for (const std::string& repair : mesh.repairs)
        remarks.push_back("mesh: " + repair);
    for (const std::string& repair : map.repairs)
        remarks.push_back("map: " + repair);
    setup.remarks.insert(setup.remarks.begin(), remarks.begin(), remarks.end());
    return setup;
}

class Stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void write_run_folder(const std::filesystem::path& folder, const Job& job, const Setup& setup,
                      const Simulation& simulation, const Checks& checks) {
    write_file(folder / "job.toml", dump_job(job, folder));
    const std::vector<Figure> figures = collect_statistics(setup, simulation);
    write_file(folder / "statistics.json", statistics_json(figures));
    write_file(folder / "statistics.csv", statistics_csv(figures));
    write_file(folder / "conformance.txt", conformance_text(checks));
    write_file(folder / "conformance.json", conformance_json(checks));
    const MeshUnits units{setup.registers.formats, setup.registers.map, setup.model_scale.scale,
                          setup.model_scale.centre};
    // A mesh or picture of another job beside this one's figures would be believed.
    const auto wanted = [&](bool wanted_now, const char* name) {
        if (!wanted_now)
            std::filesystem::remove(folder / name);
        return wanted_now;
    };
    if (wanted(job.output.ply, "mesh.ply"))
        write_ply(folder / "mesh.ply", simulation.monitor.mesh, units);
    if (wanted(job.output.obj, "mesh.obj"))
        write_obj(folder / "mesh.obj", simulation.monitor.mesh, units);
    if (wanted(job.output.picture, "picture.png"))
        write_picture(folder / "picture.png", simulation.monitor.mesh, setup, job);
}

const char* verdict(const Checks& checks) {
    if (!checks.passed())
        return "CHECKS FAILED, see conformance.txt";
    return checks.conformance || checks.invariants ? "all checks passed" : "nothing was checked";
}

}  // namespace

ExitCode run_job(const Command& command) {
    const Job job = load_job(command);
    if (command.dump_config) {
        fmt::print("{}", dump_job(job));
        return ExitCode::fine;
    }
    const std::filesystem::path folder = job.output.folder;
    check_run_folder(folder);

    Progress progress;
    progress.show("reading mesh and map", 0);
    const Setup setup = load_setup(job, command.data_folder);

    Simulation simulation(setup, static_cast<std::uint64_t>(job.limits.triangles),
                          static_cast<std::uint64_t>(job.limits.cycles_without_progress));
    std::optional<GoldenInputs> golden;
    std::unique_ptr<Scoreboard> scoreboard;
    if (job.check.golden || job.check.end_to_end)
        golden.emplace(setup);
    if (job.check.golden) {
        scoreboard = std::make_unique<Scoreboard>(setup.registers, *golden);
        simulation.pipeline.pass_or_tessellate.decided.bind(*scoreboard);
    }
    simulation.monitor.on_progress([&](std::size_t triangles) {
        progress.show(
            fmt::format("{} triangles", triangles),
            static_cast<double>(simulation.host.sent()) / static_cast<double>(simulation.host.total()));
    });

    const Stopwatch stopwatch;
    const std::string stuck = simulation.run();
    const double seconds = stopwatch.seconds();
    if (!stuck.empty()) {
        progress.clear();
        fmt::print(stderr, "tessera: {}", stuck);
        return ExitCode::deadlock;
    }

    EmittedMesh& mesh = simulation.monitor.mesh;
    mesh.sort();
    Checks checks;
    checks.allowed_flips = job.check.allowed_flips;
    checks.remarks = setup.remarks;
    if (scoreboard)
        checks.conformance = scoreboard->result();
    if (job.check.invariants) {
        progress.show("checking the mesh", 0.95);
        checks.invariants = check_invariants(mesh, setup.base_triangles, setup.registers);
    }
    if (job.check.end_to_end) {
        progress.show("running the golden model", 0.97);
        checks.end_to_end = compare_end_to_end(setup, *golden, mesh);
    }
    progress.show("writing", 0.99);
    make_run_folder(folder);
    write_run_folder(folder, job, setup, simulation, checks);
    progress.clear();

    fmt::print("{}", summary(setup, simulation, checks, seconds));
    fmt::print("  {}\n  results in {}\n", verdict(checks),
               std::filesystem::absolute(folder).lexically_normal().string());
    return checks.passed() ? ExitCode::fine : ExitCode::check_failed;
}

}  // namespace tessera

#include "testbench/commands/command_line.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "modules/version.h"
#include "testbench/commands/bake_options.h"
#include "testbench/commands/compare_run.h"
#include "testbench/commands/rank_command.h"
#include "testbench/commands/render_options.h"
#include "testbench/commands/run_job.h"
#include "testbench/commands/tune_options.h"
#include "testbench/common/error.h"
#include "testbench/job/dump_job.h"

namespace tessera {

namespace {

std::filesystem::path default_data_folder() {
    const char* const from_environment = std::getenv("TESSERA_DATA");
    return from_environment != nullptr ? std::filesystem::path(from_environment)
                                       : std::filesystem::path(TESSERA_SOURCE_DIR) / ".." / "shared" / "data";
}

/// The trace options: shorthands for settings, and --fst.
class TraceOptions {
  public:
    void add_to(CLI::App& run) {
        const std::string group = "Traces (mode = \"timed\")";
        run.add_flag("--vcd", vcd_, "write waveforms, trace.vcd; same as --set output.vcd=true")->group(group);
        run.add_flag("--fst", fst_, "also compress the waveforms, trace.fst (needs vcd2fst from the package gtkwave)")
            ->group(group);
        run.add_option("--trace", window_,
                       "cycles to trace, FROM:TO; same as --set output.trace_from=FROM --set output.trace_to=TO")
            ->group(group);
        run.add_option(
               "--trace-units", units_,
               "waveforms only of units whose name contains one of these words; same as --set output.trace_units")
            ->group(group);
    }

    void apply_to(Command& command) const {
        command.fst = fst_;
        const auto set = [&](const char* key, const std::string& value) {
            command.settings.push_back(fmt::format("output.{}={}", key, value));
        };
        if (vcd_ || fst_)
            set("vcd", "true");
        if (!window_.empty() || !units_.empty())
            command.trace_option = window_.empty() ? "--trace-units" : "--trace";
        if (!window_.empty()) {
            const std::size_t colon = window_.find(':');
            if (colon == std::string::npos || colon == 0 || colon + 1 == window_.size())
                throw InputError(
                    fmt::format("--trace {}: expected two cycles, FROM:TO, as in --trace 0:5000", window_));
            set("trace_from", window_.substr(0, colon));
            set("trace_to", window_.substr(colon + 1));
        }
        if (!units_.empty())
            set("trace_units", units_);
    }

  private:
    bool vcd_ = false, fst_ = false;
    std::string window_, units_;
};

}  // namespace

std::function<ExitCode()> read_command_line(int argc, const char* const* argv) {
    Command command;
    RankOrder rank_order;
    std::string run_folder;
    std::string data = default_data_folder().lexically_normal().string();

    CLI::App app{"tessera: a SystemC model of hardware that renders displacement maps by adaptive tessellation"};
    app.set_version_flag("--version", std::string("tessera ") + version);
    app.require_subcommand(0, 1);  // a missing subcommand is reported below
    app.footer(
        "exit codes: 0 success, 1 conformance or an invariant violated, 2 bad input or usage, 3 deadlock,\n"
        "            4 resource limit reached");

    CLI::App* const run = app.add_subcommand("run", "run a job: tessellate, check against the golden model, report");
    CLI::Option* const job = run->add_option("JOB", command.job_file,
                                             "job file (TOML); default: the half donut on the plane of 18 triangles");
    run->add_option("--set", command.settings, "set one key of the job, as in --set tests.view_threshold=2")
        ->take_all()
        ->allow_extra_args(false);
    run->add_option("--data", data, "folder of `data:` paths in the job; default: $TESSERA_DATA");
    run->add_flag("--dump-config", command.dump_config, "print the effective job with every key documented, then exit");

    TraceOptions traces;
    traces.add_to(*run);

    CLI::App* const compare = app.add_subcommand("compare",
                                                 "measure a run's mesh against the displaced surface; writes "
                                                 "error.json into its folder");
    compare->add_option("RUN", run_folder, "run folder, written by `tessera run`")->required();
    compare->add_option("--data", data, "folder of `data:` paths in its job; default: $TESSERA_DATA");

    CLI::App* const render = app.add_subcommand("render", "render a finished run's mesh to PNG");
    RenderOptions render_options;
    render_options.add_to(*render);
    render->add_option("--data", data, "folder of `data:` paths in the run's job; default: $TESSERA_DATA");

    CLI::App* const bake =
        app.add_subcommand("bake", "sample a curved surface, a quadric or NURBS patch, into a displacement map");
    BakeOptions bake_options;
    bake_options.add_to(*bake);
    bake->add_option("--data", data, "folder of `data:` paths in the base mesh's job; default: $TESSERA_DATA");

    CLI::App* const tune =
        app.add_subcommand("tune", "find a job's thresholds for a number of triangles or a bound on the error");
    TuneOptions tune_options;
    tune_options.add_to(*tune);
    tune->add_option("--data", data, "folder of `data:` paths in the job; default: $TESSERA_DATA");

    CLI::App* const rank = app.add_subcommand("rank", "make a job's Rank Table and measure the mesh at each threshold");
    CLI::Option* const rank_job =
        rank->add_option("JOB", rank_order.job_file, "job file (TOML); default: the half donut");
    rank->add_option(
        "--output", rank_order.output,
        "output folder for rank_table.bin (the memory's contents), rank_table.json and thresholds.csv; default: "
        "runs/rank");
    rank->add_option("--set", rank_order.settings, "set one key of the job first")->take_all()->allow_extra_args(false);
    rank->add_option("--data", data, "folder of `data:` paths in the job; default: $TESSERA_DATA");

    CLI::App* const keys = app.add_subcommand("keys", "print every key of a job file: unit, default, range, meaning");

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        app.exit(success);
        return {};
    } catch (const CLI::ParseError& error) {
        const std::vector<CLI::App*> verbs = app.get_subcommands();
        throw InputError(fmt::format("{}; see `tessera --help` and `tessera {} --help`", error.what(),
                                     verbs.empty() ? "run" : verbs.front()->get_name()));
    }
    if (app.get_subcommands().empty())
        throw InputError(
            "no command given: use `tessera run`, `tessera compare`, `tessera render`, `tessera bake`, "
            "`tessera tune`, `tessera rank` or `tessera keys`; see `tessera --help`");
    if ((job->count() > 0 && command.job_file.empty()) || (rank_job->count() > 0 && rank_order.job_file.empty()))
        throw InputError("JOB is empty: name a job file, or leave it out for the default job");
    if (keys->parsed())
        return [] {
            fmt::print("{}", document_keys());
            return ExitCode::fine;
        };
    if (compare->parsed())
        return [run_folder, data] { return compare_run(run_folder, data); };
    if (render->parsed())
        return [request = render_options.request(), data] { return render_command(request, data); };
    if (bake->parsed())
        return [request = bake_options.request(), data] { return bake_command(request, data); };
    if (tune->parsed())
        return [order = tune_options.order(), data] { return tune_command(order, data); };
    if (rank->parsed())
        return [rank_order, data] { return rank_command(rank_order, data); };
    command.data_folder = data;
    traces.apply_to(command);
    return [command] { return run_job(command); };
}

}  // namespace tessera

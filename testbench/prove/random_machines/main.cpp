#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <systemc>

#include "testbench/common/atomic_file.h"
#include "testbench/common/error.h"
#include "testbench/common/grouped_digits.h"
#include "testbench/job/job_choices.h"
#include "testbench/prove/random_machines/case_process.h"

// Runs random cases, seed by seed, in both modes, each run in a child process. Every run must end, satisfy the
// invariants and conform to the golden model; both modes must give the same mesh. Exit codes as tessera's: 0 all
// passed, 1 failures, 2 usage.

namespace {

using namespace tessera;

struct Order {
    std::uint64_t seed = 1;
    std::uint64_t count = 300;
    std::string write;
    std::string failures = "runs/random_cases";
    bool list = false;
};

void print_totals(std::uint64_t first, std::uint64_t count, std::uint64_t failed, const CaseFigures& all) {
    const auto number = [](std::uint64_t value) { return grouped_digits(value); };
    fmt::print("random cases, seeds {} to {}, in both modes\n", first, first + count - 1);
    fmt::print("  {} runs, {} triangles from {}, {} edges, {} cycles, {} triangles spilled\n", number(all.runs),
               number(all.triangles), number(all.base_triangles), number(all.edges), number(all.cycles),
               number(all.spilled));
    fmt::print(
        "  allowed: {} flipped edges, {} collapsed and {} turned over triangles, {} "
        "pieces open at the input's seams and creases\n",
        number(all.flips), number(all.collapsed), number(all.turned_over), number(all.open_input_edges));
    fmt::print("{} cases: {} cracks, {} T-vertices, {} other violations, {} mismatches, {} failed\n", number(count),
               number(all.cracks), number(all.t_vertices), number(all.other_violations), number(all.mismatches),
               number(failed));
}

/// Writes the case as files, and its failure.
void leave_failure(const RandomCase& random_case, Mode mode, const std::string& failure, const Order& order) {
    const std::filesystem::path folder =
        std::filesystem::path(order.failures) / fmt::format("seed_{}_{}", random_case.seed, name_of(mode));
    random_case.write(folder, mode);
    write_file(folder / "failure.txt", failure + "\n");
    fmt::print("seed {}, {}: {}\n{}\n  in {}\n", random_case.seed, name_of(mode), random_case.summary(), failure,
               folder.string());
    std::fflush(stdout);
}

int run_cases(const Order& order) {
    CaseFigures all;
    std::uint64_t failed = 0;
    for (std::uint64_t seed = order.seed; seed != order.seed + order.count; ++seed) {
        const RandomCase random_case = make_random_case(seed);
        const CaseResult functional = run_case_in_process(random_case, Mode::functional);
        CaseResult timed = run_case_in_process(random_case, Mode::timed);
        all.add(functional.figures);
        all.add(timed.figures);
        if (functional.failure.empty() && timed.failure.empty() &&
            functional.figures.mesh_digest != timed.figures.mesh_digest)
            timed.failure = "the two modes emit different meshes";
        if (!functional.failure.empty())
            leave_failure(random_case, Mode::functional, functional.failure, order);
        if (!timed.failure.empty())
            leave_failure(random_case, Mode::timed, timed.failure, order);
        failed += functional.failure.empty() && timed.failure.empty() ? 0U : 1U;
        if (order.list)
            fmt::print("seed {}: {} triangles from {}, {} edges, {} cycles: {}\n", seed, timed.figures.triangles,
                       timed.figures.base_triangles, timed.figures.edges, timed.figures.cycles, random_case.summary());
    }
    print_totals(order.seed, order.count, failed, all);
    return static_cast<int>(failed == 0 ? ExitCode::fine : ExitCode::check_failed);
}

}  // namespace

int sc_main(int argc, char** argv) {
    sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
    Order order;
    CLI::App app{
        "Runs the machine on random meshes, maps and designs, checks every run, and writes failed cases as "
        "jobs."};
    app.add_option("--seed", order.seed, "the first case")->capture_default_str();
    app.add_option("--count", order.count, "cases, of consecutive seeds")
        ->capture_default_str()
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 32));
    app.add_option("--write", order.write,
                   "only write the first case to this folder, for `tessera run FOLDER/job.toml`");
    app.add_option("--failures", order.failures, "folder for failed cases")->capture_default_str();
    app.add_flag("--list", order.list, "print a line for each case");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
    }
    try {
        if (order.write.empty())
            return run_cases(order);
        const RandomCase random_case = make_random_case(order.seed);
        random_case.write(order.write, Mode::timed);
        fmt::print("seed {}: {}\n  in {}\n", order.seed, random_case.summary(), order.write);
        return 0;
    } catch (const InputError& error) {
        fmt::print(stderr, "tessera_random_cases: {}\n", error.what());
        return static_cast<int>(ExitCode::bad_input);
    } catch (const std::exception& error) {
        fmt::print(stderr, "tessera_random_cases: {}\n", error.what());
        return static_cast<int>(ExitCode::resource_limit);
    }
}

int main(int argc, char** argv) {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);
    std::signal(SIGPIPE, SIG_IGN);
    return sc_core::sc_elab_and_sim(argc, argv);
}

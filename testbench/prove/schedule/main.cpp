#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <systemc>

#include "testbench/common/error.h"
#include "testbench/prove/random_machines/random_case.h"
#include "testbench/prove/schedule/schedule_run.h"
#include "testbench/prove/schedule/scheduled_case.h"

// Runs random variants of the paper's design, seed by seed, and their schedules (README.md). The order of the triangles
// and every item's cycles must be equal. Exit codes as tessera's: 0 all equal, 1 differences, 2 usage.

namespace {

using namespace tessera;

int compare(std::uint64_t first, std::uint64_t count) {
    std::uint64_t failed = 0;
    for (std::uint64_t seed = first; seed != first + count; ++seed) {
        const RandomCase drawn = make_scheduled_case(seed);
        const BaseMesh mesh = drawn.base_mesh();
        const HeightMap map = drawn.height_map();
        const std::string difference = schedule_difference(drawn.job, mesh, map, seed % 2 == 1);
        if (difference.empty())
            continue;
        ++failed;
        fmt::print("seed {}: {}\n{}\n", seed, drawn.summary(), difference);
    }
    fmt::print("schedule: {} random designs, seeds {} to {}: {} differ\n", count, first, first + count - 1, failed);
    return static_cast<int>(failed == 0 ? ExitCode::fine : ExitCode::check_failed);
}

}  // namespace

int sc_main(int argc, char** argv) {
    sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
    std::uint64_t first = 1, count = 2000;
    CLI::App app{"Compares the cycles of random designs with their schedules."};
    app.add_option("--seed", first, "the first design")->capture_default_str();
    app.add_option("--count", count, "designs, of consecutive seeds")
        ->capture_default_str()
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 32));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
    }
    try {
        return compare(first, count);
    } catch (const std::exception& error) {
        fmt::print(stderr, "tessera_compare_schedule: {}\n", error.what());
        return static_cast<int>(ExitCode::resource_limit);
    }
}

int main(int argc, char** argv) {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);
    return sc_core::sc_elab_and_sim(argc, argv);
}

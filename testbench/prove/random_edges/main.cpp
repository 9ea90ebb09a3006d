#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>

#include "testbench/common/error.h"
#include "testbench/common/grouped_digits.h"
#include "testbench/prove/random_edges/edge_trial.h"

// Runs random edges through the datapath from both ends and against the definitions: modules/datapath/CRACK_FREEDOM.md.
// Exit codes as tessera's: 0 all equal, 1 differences, 2 usage.

namespace {

using namespace tessera;

/// From this number of edges on, each test must be both true and false often enough. With fewer, chance may decide.
constexpr std::uint64_t fewest_to_judge = 100'000;
constexpr double least_share = 0.01;

std::string one_sided(const EdgeTrial& trial) {
    constexpr const char* names[] = {"Normal Test",    "height test",     "View Test",
                                     "Tex Coord Test", "Generation Test", "Highlight Test"};
    for (std::size_t k = 0; k < trial.yes.size(); ++k) {
        const double share = static_cast<double>(trial.yes[k]) / static_cast<double>(trial.edges);
        if (trial.edges >= fewest_to_judge && (share < least_share || share > 1 - least_share))
            return names[k];
    }
    return {};
}

void print(const EdgeTrial& trial, std::uint64_t seed, double seconds) {
    const auto number = [](std::uint64_t value) { return grouped_digits(value); };
    const auto percent = [&](std::uint64_t value) {
        return 100 * static_cast<double>(value) / static_cast<double>(trial.edges);
    };
    fmt::print("random edges, seed {}: {} edges, {} machines with usual, narrow, wide and any formats in turn\n", seed,
               number(trial.edges), number(trial.machines));
    fmt::print(
        "  true: Normal Test {:.1f} %, height test {:.1f} %, View Test {:.1f} %, Tex Coord Test "
        "{:.1f} %, "
        "Generation Test {:.1f} %, Highlight Test {:.1f} %; split {:.1f} %\n",
        percent(trial.yes[0]), percent(trial.yes[1]), percent(trial.yes[2]), percent(trial.yes[3]),
        percent(trial.yes[4]), percent(trial.yes[5]), percent(trial.splits));
    fmt::print(
        "  thresholds equal to the measured value: Normal Test {}, height test {}, View Test {}, Highlight "
        "Test {}\n",
        number(trial.at_limit[0]), number(trial.at_limit[1]), number(trial.at_limit[2]), number(trial.at_limit[3]));
    fmt::print("  {} with an end behind the near plane, {} zero inserted normals, {} tried again shifted by periods\n",
               number(trial.behind), number(trial.degenerate), number(trial.moved));
    fmt::print("{} edges: {} differ from the other end, {} when shifted by periods, {} from the definitions\n",
               number(trial.edges), number(trial.unlike_reversed), number(trial.unlike_moved),
               number(trial.unlike_direct));
    fmt::print(stderr, "{:.1f} s, {} edges per second\n", seconds,
               number(static_cast<std::uint64_t>(static_cast<double>(trial.edges) / seconds)));
}

int try_edges(int argc, char** argv) {
    std::uint64_t seed = 1, edges = 1'000'000;
    CLI::App app{"Tests random edges: results must be the same from either end and equal to the definitions."};
    app.add_option("--seed", seed, "seed of the random edges")->capture_default_str();
    app.add_option("--edges", edges, "number of edges")
        ->capture_default_str()
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 48));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
    }
    const auto start = std::chrono::steady_clock::now();
    const EdgeTrial trial = try_random_edges(seed, edges);
    print(trial, seed, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (!trial.first_fault.empty())
        fmt::print("first fault: {}\n", trial.first_fault);
    const std::string untried = one_sided(trial);
    if (!untried.empty())
        fmt::print("the {} had nearly always the same result: it was not exercised\n", untried);
    return static_cast<int>(trial.faults() == 0 && untried.empty() ? ExitCode::fine : ExitCode::check_failed);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return try_edges(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tessera_random_edges: %s\n", error.what());
        return static_cast<int>(tessera::ExitCode::resource_limit);
    }
}

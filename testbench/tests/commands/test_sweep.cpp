#include <catch2/catch.hpp>
#include <fstream>
#include <iostream>

#include "testbench/tests/support/checkout.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

bool sweeps_run() {
    const ProgramEnd end = run_program({"sh", "-c", "/usr/bin/env snakemake --version"}, source_folder());
    if (end.exit_code != 0)
        std::cout << "this test is skipped: snakemake is not installed (scripts/install sweep)\n";
    return end.exit_code == 0;
}

/// Nine designs of a tiny job. In three of them a full queue may not spill, and the run deadlocks.
const std::string small = R"(job = "half_donut"
figures = ["timing.cycles", "timing.bottleneck"]
minimise = ["timing.cycles_per_triangle", "area"]

[set]
"tests.generation_limit" = 3
"check.golden" = false
"check.end_to_end" = false
"check.invariants" = false

[derived]
area = { is = "area.total_register_bits + area.triangle_queue_memory_bits", unit = "bit" }

[[axis]]
key = "timing.summed_height_table_ports"
values = [1, 2, 4]

[[axis]]
name = "queue"
[axis.points]
unbounded = {}
small = { "hardware.queue_capacity" = 2, "hardware.queue_overflow" = "stall" }
stack = { "hardware.queue_order" = "lifo" }
)";

ProgramEnd sweep(const Checkout& checkout, const std::string& text, const std::string& options = {}) {
    write_all(checkout.root() / "small.toml", text);
    return checkout.run("scripts/sweep small.toml " + options);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

std::size_t results_in(const fs::path& store) {
    std::size_t count = 0;
    if (fs::exists(store))
        for (const auto& entry : fs::recursive_directory_iterator(store))
            count += entry.path().extension() == ".gz";
    return count;
}

}  // namespace

TEST_CASE("sweep: each design is a row, the front is marked, a failed run is a row with its reason") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const ProgramEnd end = sweep(checkout, small);
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    const fs::path folder = checkout.root() / "runs/sweeps";
    const std::string table = read_all(folder / "small/table.csv");
    const std::vector<std::string> rows = lines_of(table);
    INFO(table);
    REQUIRE(rows.size() == 10);
    CHECK_THAT(rows[0],
               Contains("run,scene,timing.summed_height_table_ports [entries per cycle],queue,timing.cycles [cycle],"
                        "timing.bottleneck,area [bit],timing.cycles_per_triangle [cycle/triangle],front,status"));
    CHECK_THAT(rows[1], Contains("0,half_donut,1,unbounded,") && Contains(",ok,"));
    CHECK_THAT(rows[2], Contains(",failed,") && Contains("exit code 3: "));
    CHECK_THAT(table, !Contains(checkout.root().string()));
    CHECK_THAT(end.err, Contains("9 designs; 8 runs to do") && Contains("6 ok, 3 failed"));

    INFO("a sweep that shares designs runs only what is new");
    CHECK_THAT(sweep(checkout, replaced(small, "[1, 2, 4]", "[1, 2, 4, 8]"), "--check").err,
               Contains("12 designs; 3 runs to do"));

    INFO("the effective job is the address: a default that is written out is the same run");
    CHECK_THAT(sweep(checkout, replaced(small, "[set]\n", "[set]\n\"timing.transform_latency\" = 20\n"), "--check").err,
               Contains("9 designs; 0 runs to do"));

    INFO("keys beside hardware.design stay as the sweep has them; `unbounded` and `stack` are then the same");
    const std::string modern = "[[axis]]\nkey = \"hardware.design\"\nvalues = [\"modern\"]\n";
    CHECK_THAT(sweep(checkout, small + modern, "--check").err, Contains("9 designs; 5 runs to do"));

    INFO("killed between its runs and resumed: the same bytes, and nothing runs twice");
    const std::string address = rows[1].substr(rows[1].rfind(',') + 1);
    fs::remove_all(folder);
    write_all(checkout.root() / "small.toml", small);
    const ProgramEnd killed = checkout.run(
        "setsid scripts/sweep small.toml & sleep 0.2; "
        "until [ \"$(find runs/sweeps/results -name '*.gz' | wc -l)\" -ge 2 ]; do sleep 0.02; done 2>/dev/null; "
        "kill -KILL -- -$!; wait $! || true");
    INFO(killed.text());
    const std::size_t before = results_in(folder / "results");
    CHECK(before >= 2);
    CHECK(before < 9);
    CHECK_FALSE(fs::exists(folder / "small/table.csv"));
    const fs::path first = folder / "results" / address.substr(0, 2) / (address + ".json.gz");
    REQUIRE(fs::exists(first));
    const auto written = fs::last_write_time(first);
    const ProgramEnd resumed = checkout.run("scripts/sweep small.toml");
    INFO(resumed.text());
    CHECK(resumed.exit_code == 0);
    CHECK(read_all(folder / "small/table.csv") == table);
    CHECK(fs::last_write_time(first) == written);
    CHECK(results_in(folder / "results") == 9);

    INFO("another program's results are not these");
    const fs::path program = checkout.root() / "build/release/testbench/commands/tessera";
    fs::remove(program);
    fs::copy(tessera_program(), program);
    std::ofstream(program, std::ios::app) << "x";
    CHECK_THAT(checkout.run("scripts/sweep small.toml --check").err, Contains("9 designs; 8 runs to do"));
}

TEST_CASE("sweep: a run that does not end is a row, and is tried again") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const ProgramEnd end = sweep(checkout, "longest_run = 0.001\n" + replaced(small, "[1, 2, 4]", "[1]"));
    INFO(end.text());
    CHECK(end.exit_code == 1);
    CHECK_THAT(read_all(checkout.root() / "runs/sweeps/small/table.csv"),
               Contains(",no result,took longer than 0.001 s,"));
    CHECK(sweep(checkout, replaced(small, "[1, 2, 4]", "[1]")).exit_code == 0);
}

TEST_CASE("sweep: workers that share a study search some of the designs, each run once") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const auto [storage, file] = GENERATE(table<std::string, std::string>(
        {{"", "runs/sweeps/small_search/search.journal"}, {" --storage sqlite:///study.db", "study.db"}}));
    const ProgramEnd end = sweep(checkout, small + "\n[search]\nruns = 5\n", "--search --workers 2" + storage);
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    const fs::path folder = checkout.root() / "runs/sweeps";
    const std::vector<std::string> rows = lines_of(read_all(folder / "small_search/table.csv"));
    CHECK(rows.size() > 3);
    CHECK(rows.size() <= 7);  // both workers may start the last run
    CHECK(results_in(folder / "results") == rows.size() - 1);
    CHECK(fs::exists(checkout.root() / file));

    INFO("the study of another sweep file is another one");
    const ProgramEnd other =
        checkout.run("sed -i 's/1, 2, 4/3, 6, 8/' small.toml; scripts/sweep small.toml --search --workers 2" + storage);
    INFO(other.text());
    CHECK(other.exit_code == 0);
}

TEST_CASE("sweep: the error of each design is measured if a figure needs it") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const ProgramEnd end = sweep(checkout,
                                 "job = \"half_donut\"\n"
                                 "minimise = [\"mesh.triangles\", \"error.interpolated.reference_to_mesh_rms\"]\n"
                                 "[set]\n\"mode\" = \"functional\"\n\"map.width\" = 32\n\"map.height\" = 32\n"
                                 "[[axis]]\nkey = \"tests.generation_limit\"\nvalues = [1, 4]\n");
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    CHECK_THAT(end.err, Contains("2 ok; 2 on the front"));  // fewer triangles, or a smaller error
    CHECK_THAT(read_all(checkout.root() / "runs/sweeps/small/table.csv"),
               Contains("error.interpolated.reference_to_mesh_rms [model unit]"));
}

TEST_CASE("sweep: the first commands of its README run") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    unsigned commands = 0;
    for (const std::string& line : lines_of(read_all(source_folder() / "scripts/exploration/README.md"))) {
        if (line.rfind("scripts/sweep testbench/examples/sweeps/first.toml", 0) != 0)
            continue;
        ++commands;
        const ProgramEnd end = checkout.run(line);
        INFO(line << end.text());
        CHECK(end.exit_code == 0);
        CHECK_THAT(end.err, Contains(commands == 1 ? "first: 8 designs; 7 runs to do" : "8 ok; "));
    }
    CHECK(commands == 2);
}

TEST_CASE("sweep: if Slurm does not start, its test gets the reason") {
    const Checkout checkout;
    for (const char* const tool : {"munged", "slurmctld", "slurmd", "sbatch"}) {
        write_all(checkout.root() / "tools" / tool, "#!/bin/sh\nexit 1\n");
        fs::permissions(checkout.root() / "tools" / tool, fs::perms::owner_all);
    }
    const ProgramEnd end = checkout.run("scripts/checks/sweep_tests/slurm_cluster start cluster");
    INFO(end.text());
    CHECK(end.exit_code == 3);
    CHECK_THAT(end.err, Contains("slurm_cluster: munged does not start") || Contains("needs root"));
}

TEST_CASE("sweep: an invalid study is refused before the first run, with file and line") {
    const Checkout checkout;
    const auto [from, to, message] = GENERATE(table<std::string, std::string, std::string>({
        {"table_ports\"", "table_port\"", "small.toml:15: unknown key `timing.summed_height_table_port`"},
        {"generation_limit", "generations", "small.toml:6: unknown key `tests.generations`"},
        {"[1, 2, 4]", "[]", "small.toml:14: this axis has no values: the product is empty"},
        {"[1, 2, 4]", "[1, 2, 400]", "small.toml:15: `timing.summed_height_table_ports` = 400 is out of range"},
        {"figures =", "figure =", "small.toml:2: unknown entry `figure`"},
        {"half_donut", "half_donat", "small.toml:1: there is no job `half_donat`"},
        {"[set]", "constraints = [\"hardware.machines > 1\"]\n[set]",
         "small.toml:5: the constraints exclude every design: the product is empty"},
        {"[set]", "constraints = [\"hardware.machine > 1\"]\n[set]", "small.toml:5: unknown key `hardware.machine`"},
        {"[set]", "constraints = [\"open('x')\"]\n[set]", "small.toml:5: `open('x')`: only names"},
        {"timing.cycles\"", "timing.cycle\"", "small.toml:2: no run has the figure `timing.cycle`"},
        {"\"queue\"", "\"queue", "small.toml: "},
        {"key = ", "keys = ", "small.toml:14: "},
        {"stack = { ", "stack = { \"timing.summed_height_table_ports\" = 2, ",
         "small.toml:23: `timing.summed_height_table_ports` is also on another axis, line 14"},
    }));
    if (!sweeps_run())
        return;
    const ProgramEnd end = sweep(checkout, replaced(small, from, to));
    INFO(from << " -> " << to << end.text());
    CHECK(end.exit_code == 2);
    CHECK_THAT(end.err, Contains(message));
    CHECK(results_in(checkout.root() / "runs/sweeps/results") <= 1);
}

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

// Crater Lake through the machine with a Rank Test, as a user runs it, from 24 base triangles.

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

constexpr double crater_depth = 945;  // m, from the lake's bottom to the rim: full scale

struct Quality {
    std::uint64_t triangles;
    double rms, largest;  // m, vertically at grid points
};

/// Of the mesh with these settings beside; both modes' checks have passed.
Quality crater_lake(const TestFolder& here, const Arguments& settings) {
    const std::string job = (source_folder() / "testbench/examples/jobs/crater_lake_24.toml").string();
    succeed(Arguments{"run",   job,
                      "--set", "mesh.source=lattice",
                      "--set", "mesh.spacing=128",
                      "--set", "map.range=data",
                      "--set", "displacement.scale=0.945",
                      "--set", "hardware.height_test=rank",
                      "--set", "hardware.triangulation=greatest_rank",
                      "--set", "tests.normal=false",
                      "--set", "tests.view=false",
                      "--set", "tests.generation_limit=15",
                      "--set", "mode=functional",
                      "--set", "output.picture=false",
                      "--set", "output.folder=run"} +
                settings,
            here.path());
    succeed({"compare", "run"}, here.path());
    const auto error = read_json(here.path() / "run/error.json");
    const auto vertical = [&](const char* name) { return error["vertical"][name]["value"].get<double>() * 1000; };
    return {RunFolder(here.path() / "run").count("run", "triangles_finished"), vertical("rms"), vertical("max")};
}

}  // namespace

TEST_CASE("rank: Crater Lake's error at 4,800 triangles, with entries of 8 bits") {
    const TestFolder here;
    const Quality found = crater_lake(here, {"--set", "tests.rank_threshold=0.038"});
    CHECK(found.triangles < 4800);
    CHECK(found.rms < 5.5);
}

TEST_CASE("rank: no grid point is farther from the mesh than the bound says") {
    const TestFolder here;
    for (const char* const bits : {"6", "16"}) {
        const Quality found =
            crater_lake(here, {"--set", "formats.rank_bits=0", "--set", std::string("formats.bound_bits=") + bits,
                               "--set", "tests.bound_threshold=0.04"});
        INFO(bits << " bits, " << found.triangles << " triangles");
        CHECK(found.largest < 0.04 * crater_depth);
        CHECK(found.largest > 0.02 * crater_depth);
    }
}

TEST_CASE("tessera rank: a row has the figures of a run with its threshold, and every promise holds") {
    const TestFolder here;
    const std::string job = (source_folder() / "testbench/examples/jobs/crater_lake_rank.toml").string();
    const Arguments settings{"--set", "formats.bound_bits=8", "--set", "limits.triangles=40000"};
    const ProgramEnd end = succeed(Arguments{"rank", job, "--output", "tables"} + settings, here.path());
    CHECK_THAT(end.out, Contains("24 base triangles") && Contains("tables/thresholds.csv"));
    const auto table = read_json(here.path() / "tables/rank_table.json");
    CHECK(fs::file_size(here.path() / "tables/rank_table.bin") == table["columns"].get<std::uint64_t>() *
                                                                      table["rows"].get<std::uint64_t>() *
                                                                      table["entry_bytes"].get<std::uint64_t>());
    std::size_t rows = 0, runs = 0;
    for (const std::string& line : lines_of(read_all(here.path() / "tables/thresholds.csv"))) {
        if (rows++ == 0)
            continue;
        std::vector<std::string> cells;
        std::istringstream text(line);
        for (std::string cell; std::getline(text, cell, ',');)
            cells.push_back(cell);
        REQUIRE(cells.size() == 7);
        INFO(line);
        const bool bound = cells[0] == "bound";
        if (bound)
            CHECK(std::stod(cells[6]) <= std::stod(cells[3]));
        CHECK(std::stoul(cells[4]) <= 40000);
        if (rows % 10 != 0)
            continue;
        ++runs;
        succeed(Arguments{"run", job, "--set", std::string("tests.") + cells[0] + "_threshold=" + cells[2], "--set",
                          std::string("tests.") + (bound ? "rank" : "bound") + "_threshold=" + (bound ? "1e6" : "1"),
                          "--set", "mode=functional", "--set", "output.picture=false", "--set", "output.folder=run"} +
                    settings,
                here.path());
        CHECK(RunFolder(here.path() / "run").count("run", "triangles_finished") == std::stoul(cells[4]));
    }
    CHECK(rows > 40);
    CHECK(runs >= 4);
}

TEST_CASE("rank: a base mesh that the test cannot split is named, with one that it can") {
    const TestFolder here;
    const ProgramEnd end = succeed({"run", "--set", "hardware.height_test=rank", "--set", "mode=functional", "--set",
                                    "mesh.columns=8", "--set", "output.picture=false", "--set", "output.folder=run"},
                                   here.path());
    CHECK_THAT(end.out, Contains("the Rank Test never splits them") && Contains("mesh.source = \"lattice\""));
}

#include <catch2/catch.hpp>

#include "testbench/job/job_keys.h"
#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

// The limits of a job's values, as a user meets them: a correct run, or one message and no files.

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const Arguments small{"map.width=16", "map.height=16", "tests.generation_limit=2", "output.picture=false"};

Arguments run_of(const Arguments& settings) {
    return Arguments{"run", "--set", "output.folder=out"} + set(small) + set(settings);
}

/// The numbers of [timing] at one end of their ranges, except those named.
Arguments timing_at(bool highest, const Arguments& others) {
    Arguments settings;
    for (const Key& key : find_table("timing")->keys) {
        if (key.kind != KeyKind::integer || std::find(others.begin(), others.end(), key.name) != others.end())
            continue;
        const double end = highest ? key.range.high : key.range.low;
        settings.push_back(key.name + "=" + std::to_string(static_cast<std::int64_t>(end)));
    }
    return settings;
}

void expect_run(const Arguments& settings) {
    const TestFolder here;
    succeed(run_of(settings), here.path());
    require_consistent(RunFolder(here.path() / "out"));
}

}  // namespace

TEST_CASE("limits: every timing key runs at its lowest value") {
    expect_run(timing_at(false, {}));
}

TEST_CASE("limits: every timing key at its highest value ends in a message or a run") {
    for (const char* const mode : {"timed", "functional"}) {
        const TestFolder here;
        Arguments settings = timing_at(true, {});
        settings.emplace_back(std::string("mode=") + mode);
        settings.emplace_back("limits.cycles_without_progress=2147483647");
        const ProgramEnd end = run_tessera(run_of(settings), here.path());
        INFO(end.text());
        CHECK((end.exit_code == 0 || end.exit_code == 3 || end.exit_code == 4));
        if (end.exit_code == 0)
            require_consistent(RunFolder(here.path() / "out"));
        else
            CHECK(end.err.rfind("tessera: ", 0) == 0);
    }
}

TEST_CASE("limits: a negative number of fraction bits of the view distance is reported as it is") {
    const TestFolder here;
    succeed(run_of({"formats.position_bits=12", "formats.position_fraction=0", "camera.eye=[0, -30, 30]"}),
            here.path());
    const RunFolder run(here.path() / "out");
    const auto fraction = run.statistics.at("formats").at("view_distance_fraction").at("value");
    CHECK(fraction < 0);
    CHECK(fraction > -32);
    require_consistent(run);
}

TEST_CASE("limits: the shortest vectors that a number can express are valid directions") {
    const TestFolder here;
    const auto mesh_of = [&](const std::string& up, const std::string& light) {
        succeed(run_of({"camera.up=" + up, "hardware.light=" + light}), here.path());
        return read_all(here.path() / "out/mesh.ply");
    };
    CHECK(mesh_of("[0, 0, 5e-324]", "[0, 0, 5e-324]") == mesh_of("[0, 0, 1]", "[0, 0, 1]"));
}

TEST_CASE("limits: a saturation that no width prevents is a note, not a warning") {
    const TestFolder here;
    const ProgramEnd end = succeed(
        run_of({"map.source=constant", "camera.eye=[0, -3, 0]", "camera.target=[0, 0, 0]", "hardware.light=[0, 0, 1]"}),
        here.path());
    CHECK_THAT(end.out, Contains("note: intensity: ") && Contains("no key widens") && !Contains("warning: "));
}

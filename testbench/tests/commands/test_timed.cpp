#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

// Timed mode through the program: exit codes, reports, and identical bytes from two runs.

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

Arguments timed_run(const std::string& folder, const Arguments& settings) {
    return Arguments{"run", "--set", "output.folder=" + folder} + set(settings);
}

const Arguments small{"map.width=64", "map.height=64", "output.picture=false"};

}  // namespace

TEST_CASE("timed run: a full queue that stalls ends with exit code 3 and names the waiting units") {
    const TestFolder here;
    const ProgramEnd end =
        run_tessera(timed_run("out", {"hardware.queue_capacity=8", "hardware.queue_overflow=stall"}), here.path());
    INFO(end.text());
    CHECK(end.exit_code == 3);
    CHECK_THAT(end.err, Contains("tessera: deadlock: ") && Contains("triangle_queue: ") && Contains("(capacity 8)") &&
                            Contains("waits for get_triangle") && Contains("hardware.queue_overflow = \"spill\"") &&
                            Contains("pass_or_tessellate: ") && Contains("waits for tessellation"));
}

TEST_CASE("timed run: no progress within the bound ends with exit code 3") {
    const TestFolder here;
    const ProgramEnd end = run_tessera(timed_run("out", {"limits.cycles_without_progress=10"}), here.path());
    INFO(end.text());
    CHECK(end.exit_code == 3);
    CHECK_THAT(end.err, Contains("tessera: livelock: ") && Contains("limits.cycles_without_progress = 10"));
}

TEST_CASE("timed run: slow progress is not a livelock") {
    const TestFolder here;
    const Arguments tiny{"tests.generation_limit=1", "output.picture=false", "check.end_to_end=false"};
    for (const std::vector<std::string>& slow : std::vector<std::vector<std::string>>{
             {"timing.transform_latency=1000000", "limits.cycles_without_progress=1000"},
             {"timing.stalls_per_mille=1000", "timing.stalls_longest=1000000"},
             {"timing.lighting_latency=2000", "limits.cycles_without_progress=1000"}})
        succeed(timed_run("out", tiny + slow), here.path());
}

TEST_CASE("timed run: full off-chip memory ends with exit code 4 and names the key") {
    const TestFolder here;
    for (const std::string order : {"fifo", "lifo"}) {
        const ProgramEnd end = run_tessera(
            timed_run("out",
                      {"hardware.queue_capacity=2", "hardware.off_chip_triangles=5", "hardware.queue_order=" + order}),
            here.path());
        INFO(end.text());
        CHECK(end.exit_code == 4);
        CHECK_THAT(end.err, Contains("hardware.off_chip_triangles = 5") && Contains("hardware.queue_capacity = 2"));
        CHECK(here.names().empty());
    }
}

TEST_CASE("timed run: a window or units to trace without a trace are refused") {
    const TestFolder here;
    for (const std::vector<std::string>& option :
         std::vector<std::vector<std::string>>{{"--trace", "5:50"}, {"--trace-units", "queue"}})
        refused(timed_run("out", {}) + option, here.path(), {option[0], "--vcd", "--timeline"});
}

TEST_CASE("timed run: a queue that may not overflow ends with exit code 4 and names the key") {
    const TestFolder here;
    const ProgramEnd end =
        run_tessera(timed_run("out", {"hardware.queue_capacity=8", "hardware.queue_overflow=error"}), here.path());
    INFO(end.text());
    CHECK(end.exit_code == 4);
    CHECK_THAT(end.err, Contains("hardware.queue_capacity = 8"));
}

TEST_CASE("timed run: the same job twice writes the same bytes") {
    const TestFolder here;
    const Arguments settings =
        small + Arguments{"hardware.queue_capacity=8", "hardware.tests_units=3", "timing.stalls_per_mille=200"};
    for (const char* const folder : {"a", "b"}) {
        fs::create_directories(here.path() / folder);
        const ProgramEnd end = succeed(timed_run("out", settings), here.path() / folder);
        CHECK_THAT(end.out, Contains("all checks passed"));
    }
    const RunFolder a(here.path() / "a/out"), b(here.path() / "b/out");
    require_consistent(a);
    require_same_files(a.files(), b.files());
}

TEST_CASE("timed run: the mesh files are functional mode's, byte for byte, stalls or not") {
    const TestFolder here;
    const auto mesh_of = [&](const std::string& folder, const Arguments& settings) {
        succeed(timed_run(folder, small + settings), here.path());
        auto files = RunFolder(here.path() / folder).files();
        return files.at("mesh.ply");
    };
    const std::string functional = mesh_of("functional", {"mode=functional"});
    CHECK(functional.size() > 10'000);
    CHECK(mesh_of("timed", {}) == functional);
    CHECK(mesh_of("stalled", {"timing.stalls_per_mille=500", "timing.stalls_seed=7", "hardware.queue_order=lifo",
                              "hardware.queue_capacity=4"}) == functional);
    CHECK(mesh_of("modern", {"hardware.design=modern"}) == functional);
    CHECK(mesh_of("four_machines", {"hardware.design=modern", "hardware.machines=4"}) == functional);
    CHECK(mesh_of("modern_functional", {"hardware.design=modern", "mode=functional"}) == functional);
}

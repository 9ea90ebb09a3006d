#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

// The Highlight Test through the program: what runs with it print and write, and that runs without it do not.

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

Arguments run_with(const Arguments& settings) {
    return Arguments{"run", "--set", "output.folder=out"} + set(settings);
}

}  // namespace

TEST_CASE("highlight run: the results are consistent, and every file names the test") {
    const TestFolder here;
    const ProgramEnd end = succeed(run_with({"tests.highlight=true", "output.obj=true"}), here.path());
    CHECK_THAT(end.out, Contains("highlight alone") && Contains("all checks passed"));
    const RunFolder run(here.path() / "out");
    require_consistent(run);
    const std::uint64_t alone = run.count("pass_or_tessellate", "split_by_highlight");
    CHECK(alone > 500);
    CHECK(run.count("pass_or_tessellate", "split_in_highlight") >= alone);
    const auto files = run.files();
    CHECK_THAT(files.at("report.txt"), Contains("  HT  "));
    CHECK_THAT(files.at("mesh.obj"), Contains("usemtl highlight_g") && Contains("Highlight Test alone"));
    CHECK_THAT(files.at("mesh.ply"), Contains("32 is added where the Highlight Test was true"));
    const auto queue_entry = run.count("formats", "queue_entry");

    // its pictures and its error can be made from the folder
    succeed({"render", "out", "--view", "test", "--size", "320"}, here.path());
    succeed({"compare", "out"}, here.path());

    const ProgramEnd without = succeed(run_with({}), here.path());
    CHECK_THAT(without.out, !Contains("ighlight"));
    const RunFolder plain(here.path() / "out");
    require_consistent(plain);
    CHECK(plain.count("formats", "queue_entry") + 1 == queue_entry);
    for (const auto& [name, content] : plain.files()) {
        INFO(name);
        if (name != "job.toml" && name != "picture.png")
            CHECK(content.find("ighlight") == std::string::npos);
    }
}

TEST_CASE("highlight run: functional and timed mode, with a queue that spills, give the same mesh") {
    const TestFolder here;
    const auto mesh_of = [&](const std::vector<std::string>& more) {
        succeed(run_with({"tests.highlight=true", "map.width=64", "map.height=64", "output.picture=false",
                          "output.obj=true"}) +
                    set(more),
                here.path());
        const auto files = RunFolder(here.path() / "out").files();
        return files.at("mesh.ply") + files.at("mesh.obj");
    };
    const std::string functional = mesh_of({"mode=functional"});
    CHECK_THAT(functional, Contains("usemtl highlight_g"));
    CHECK((mesh_of({"hardware.queue_capacity=4", "hardware.tests_units=3"}) == functional));
}

// A Highlight Test that never asks for a split: the mesh and every cycle are those of a design without it, except for
// the latency.
TEST_CASE("highlight run: it takes the cycles of an equally longer Normal Test") {
    const TestFolder here;
    const auto levels_of = [&](const std::vector<std::string>& more) {
        succeed(run_with({"map.width=64", "map.height=64", "output.picture=false",
                          "timing.summed_height_table_ports=12", "tests.highlight_normal_threshold=2"}) +
                    set(more),
                here.path());
        const RunFolder run(here.path() / "out");
        return std::to_string(run.count("timing", "cycles")) + "\n" + run.files().at("queue_levels.csv");
    };
    const std::string longer = levels_of({"timing.normal_test_latency=34"});
    CHECK((levels_of({"tests.highlight=true", "timing.highlight_test_latency=25"}) == longer));
    const std::string as_is = levels_of({});
    CHECK((as_is != longer));
    CHECK((levels_of({"tests.highlight=true", "timing.highlight_test_latency=0"}) == as_is));
    CHECK((levels_of({"timing.highlight_test_latency=25"}) == as_is));  // no Highlight Test: it counts for nothing
}

TEST_CASE("highlight run: waveforms have its bit only in a design that has it") {
    const TestFolder here;
    const auto waveforms = [&](const std::string& highlight) {
        succeed(run_with({"tests.highlight=" + highlight, "tests.generation_limit=3", "output.vcd=true",
                          "output.picture=false"}),
                here.path());
        return read_all(here.path() / "out/trace.vcd");
    };
    CHECK_THAT(waveforms("true"), Contains(" highlight $end") && Contains(" highlight [2:0] $end"));
    CHECK_THAT(waveforms("false"), !Contains("highlight"));
}

TEST_CASE("highlight run: values out of range are refused") {
    const TestFolder here;
    for (const std::string setting :
         {"tests.highlight_angle=91", "tests.highlight_angle=-1", "tests.highlight_normal_threshold=2.5",
          "timing.highlight_test_latency=-1", "tests.highlight=yes"}) {
        const ProgramEnd end = run_tessera(run_with({setting}), here.path());
        INFO(end.text());
        CHECK(end.exit_code == 2);
        CHECK_THAT(end.err, Contains(setting.substr(0, setting.find('='))));
    }
    CHECK(here.names().empty());
}

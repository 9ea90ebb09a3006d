#include <catch2/catch.hpp>
#include <string>

#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

// The Highlight Test through the program: what runs with it print and write, and that runs without it do not.

using namespace tessera;
using Catch::Contains;

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

#include <catch2/catch.hpp>

#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// Runs the default job with these settings, in a separate folder.
struct Attempt {
    TestFolder here;
    ProgramEnd end;

    explicit Attempt(const std::vector<std::string>& settings) {
        // A picture takes ten times as long as everything else.
        end = run_tessera(Arguments{"run"} + set({"output.folder=out", "output.picture=false"}) + set(settings),
                          here.path());
    }

    /// Requires that the run succeeded.
    RunFolder well() const {
        INFO(end.text());
        REQUIRE(end.exit_code == 0);
        CHECK(end.err.empty());
        RunFolder run(here.path() / "out");
        require_consistent(run);
        return run;
    }
};

std::uint64_t finished(const RunFolder& run) {
    return run.count("run", "triangles_finished");
}

}  // namespace

// Without a picture: machine/test_limits.cpp.
TEST_CASE("a viewport of one pixel and a mesh behind the camera get a picture") {
    Attempt({"camera.viewport_width=1", "camera.viewport_height=1", "output.picture=true"}).well();
    Attempt({"camera.eye=[0, -3, 0.5]", "camera.target=[0, -6, 0.5]", "output.picture=true"}).well();
}

TEST_CASE("an eye beyond the machine's range is a clear error or a run") {
    const Attempt attempt(
        {"camera.eye=[0, -1000000, 1000000]", "displacement.scale=1e-6", "mesh.width=1e-6", "mesh.depth=1e-6"});
    INFO(attempt.end.text());
    CHECK((attempt.end.exit_code == 0 || attempt.end.exit_code == 2));
    if (attempt.end.exit_code == 2) {
        CHECK_THAT(attempt.end.err, Contains("camera.eye"));
        CHECK(attempt.here.names().empty());
    }
}

TEST_CASE("culling removes triangles from the mesh files and from Lighting, and changes nothing else") {
    const RunFolder all = Attempt({"displacement.scale=0.6"}).well();
    const RunFolder front = Attempt({"displacement.scale=0.6", "hardware.culling=back"}).well();
    CHECK(all.count("pass_or_tessellate", "culled") == 0);
    CHECK(front.count("pass_or_tessellate", "culled") > 0);
    CHECK(front.count("pass_or_tessellate", "culled") < finished(front));
    CHECK(finished(front) == finished(all));
}

TEST_CASE("a recursion without end is stopped by the triangle limit") {
    for (const char* const mode : {"mode=functional", "mode=timed"})
        for (const char* const order : {"hardware.queue_order=fifo", "hardware.queue_order=lifo"}) {
            const Attempt endless({"tests.normal_threshold=0", "tests.summed_height_threshold=0",
                                   "limits.triangles=20000", "tests.generation=false", "tests.tex_coord=false",
                                   "tests.view=false", mode, order});
            INFO(endless.end.text());
            CHECK(endless.end.exit_code == 4);
            CHECK_THAT(endless.end.err, Contains("limits.triangles = 20000"));
        }
}

TEST_CASE("checks and files that are switched off are omitted") {
    const Attempt attempt({"check.golden=false", "check.end_to_end=false", "check.invariants=false", "check.work=false",
                           "output.ply=false", "output.obj=false", "output.picture=false", "tests.generation_limit=2"});
    INFO(attempt.end.text());
    REQUIRE(attempt.end.exit_code == 0);
    const RunFolder run(attempt.here.path() / "out");
    CHECK(run.files().size() == 6);
    CHECK_FALSE(run.conformance.contains("conformance"));
    CHECK_FALSE(run.conformance.contains("invariants"));
    CHECK_THAT(attempt.end.out, Contains("nothing was checked"));
}

TEST_CASE("read checks compare every table read, and change nothing") {
    for (const char* const mode : {"mode=functional", "mode=timed"}) {
        const std::vector<std::string> settings{mode, "check.golden=false", "check.end_to_end=false",
                                                "check.invariants=false", "check.work=false"};
        std::vector<std::string> with_reads = settings;
        with_reads.emplace_back("check.reads=true");
        const Attempt plain(settings), checked(with_reads);
        CHECK_THAT(checked.end.out, Contains("all checks passed"));
        const RunFolder run = checked.well();
        CHECK(run.conformance["reads"]["wrong"] == 0);
        CHECK(run.conformance["reads"]["entries"] == run.count("displacement_map", "reads") +
                                                         run.count("normal_map", "reads") +
                                                         run.count("summed_height_table", "reads"));
        CHECK(run.files().at("mesh.ply") == plain.well().files().at("mesh.ply"));
    }
}

TEST_CASE("read checks compare the reads of a cache and the reads of units through it") {
    const Attempt checked({"mode=timed", "check.reads=true", "timing.displacement_map_cache_bytes=100",
                           "timing.normal_map_cache_bytes=1000", "timing.summed_height_table_cache_bytes=4096"});
    CHECK_THAT(checked.end.out, Contains("all checks passed") && Contains("fetched"));
    const RunFolder run = checked.well();
    std::uint64_t reads = 0;
    for (const char* const table : {"displacement_map", "normal_map", "summed_height_table"}) {
        const std::uint64_t entries = run.count(table, "reads"), fills = run.count(table, "cache_fills");
        CHECK(run.count(table, "cache_hits") + fills == entries);
        CHECK(run.count(table, "bytes_fetched") > 32 * fills);
        reads += entries + fills;
    }
    CHECK(run.conformance["reads"]["wrong"] == 0);
    CHECK(run.conformance["reads"]["entries"] == reads);
}

TEST_CASE("a failed check ends with exit code 1, and the results are written") {
    const Attempt attempt({"check.allowed_flips=0", "formats.normal_bits=8", "formats.normal_fraction=6"});
    INFO(attempt.end.text());
    REQUIRE(attempt.end.exit_code == 1);
    CHECK_THAT(attempt.end.out, Contains("more than the 0 % that check.allowed_flips allows"));
    CHECK_THAT(attempt.end.out, Contains("CHECKS FAILED, see report.txt"));
    CHECK_THAT(attempt.end.out, Contains("results in "));
    const RunFolder run(attempt.here.path() / "out");
    CHECK(run.conformance["passed"] == false);
    const std::map<std::string, std::string> files = run.files();
    CHECK_THAT(files.at("report.txt"), Catch::StartsWith("Checks: FAILED: conformance"));
    CHECK(run.read_ply().faces == finished(run));
}

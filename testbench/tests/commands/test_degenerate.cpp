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

TEST_CASE("maps of one texel, one row or one column run") {
    CHECK(finished(Attempt({"map.width=1", "map.height=1"}).well()) >= 18);
    Attempt({"map.width=1", "map.height=64"}).well();
    Attempt({"map.width=64", "map.height=1"}).well();
    Attempt({"map.width=1", "map.height=1", "map.address_u=repeat", "map.address_v=repeat"}).well();
}

TEST_CASE("a surface without detail stays the base mesh") {
    CHECK(finished(Attempt({"map.source=constant"}).well()) == 18);
    CHECK(finished(Attempt({"map.source=constant", "map.value=0"}).well()) == 18);
    CHECK(finished(Attempt({"map.source=constant", "map.value=1"}).well()) == 18);
    CHECK(finished(Attempt({"tests.generation_limit=0"}).well()) == 18);
    CHECK(finished(Attempt({"tests.normal=false", "tests.summed_height=false"}).well()) == 18);
    // without the Summed Height Test, which depends on the map alone, whatever the scale
    CHECK(finished(Attempt({"displacement.scale=0", "tests.summed_height=false"}).well()) == 18);
}

TEST_CASE("zero, negative and enormous heights run") {
    Attempt({"displacement.scale=0"}).well();
    CHECK(finished(Attempt({"displacement.scale=-0.25"}).well()) > 1000);
    Attempt({"displacement.scale=-0.25", "displacement.bias=0.25"}).well();
    Attempt({"displacement.scale=1e-6"}).well();
    Attempt({"displacement.scale=1e6", "tests.generation_limit=4"}).well();
    Attempt({"displacement.bias=-1e6", "tests.generation_limit=4"}).well();
}

TEST_CASE("a camera at any position runs") {
    Attempt({"camera.viewport_width=1", "camera.viewport_height=1", "output.picture=true"}).well();
    Attempt({"camera.viewport_width=1", "camera.viewport_height=16384", "camera.eye=[1, -3, 2.5]"}).well();
    Attempt({"camera.eye=[0.01, 0.02, 0.1]", "camera.target=[1, 0, 0.1]"}).well();  // within the heights
    Attempt({"camera.eye=[0, 0, 0]", "camera.target=[0, 1, 0]"}).well();            // in the plane itself
    Attempt({"camera.eye=[0, -3.2, -2.4]"}).well();                                 // below
    Attempt({"camera.eye=[0, -3, 0.5]", "camera.target=[0, -6, 0.5]", "output.picture=true"})
        .well();                                    // all of the mesh is behind the eye
    Attempt({"camera.eye=[0, -150, 120]"}).well();  // a dot on the screen
    Attempt({"camera.near_plane=1e6"}).well();
    Attempt({"camera.field_of_view=0.1", "camera.eye=[1, -3, 2.5]", "tests.generation_limit=6",
             "check.allowed_triangles=100"})
        .well();
    Attempt({"camera.field_of_view=179"}).well();
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

    // seen from below every triangle is a back face: an empty mesh and an empty picture
    const Attempt below(
        {"map.source=constant", "camera.eye=[0, -3.2, -2.4]", "hardware.culling=back", "output.picture=true"});
    const RunFolder none = below.well();
    CHECK(none.count("pass_or_tessellate", "culled") == 18);
    CHECK(none.read_ply().faces == 0);
}

TEST_CASE("the queue's order, its watermark and the access to memory change no triangle") {
    const auto plain = Attempt({}).well().files();
    for (const char* const setting :
         {"hardware.queue_order=lifo", "hardware.queue_watermark=1000", "hardware.direct_memory=false"}) {
        INFO(setting);
        const auto other = Attempt({setting}).well().files();
        CHECK((plain.at("mesh.ply") == other.at("mesh.ply")));
    }
}

TEST_CASE("thresholds of zero end at the map's resolution, the generation limit or the triangle limit") {
    const std::vector<std::string> zero{"tests.normal_threshold=0", "tests.summed_height_threshold=0",
                                        "tests.view_threshold=0",
                                        // many values are exactly 0
                                        "check.allowed_flips=100", "check.allowed_triangles=100"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), zero.begin(), zero.end());
        return Attempt(more);
    };
    with({"map.width=16", "map.height=16"}).well();
    with({"tests.generation_limit=5"}).well();
    const Attempt limited = with({"limits.triangles=5000"});
    INFO(limited.end.text());
    CHECK(limited.end.exit_code == 4);
    CHECK_THAT(limited.end.err, Contains("limits.triangles = 5000"));
    CHECK(limited.here.names().empty());
    // Only the triangle limit ends these runs, before the first triangle is finished.
    for (const char* const mode : {"mode=functional", "mode=timed"})
        for (const char* const order : {"hardware.queue_order=fifo", "hardware.queue_order=lifo"}) {
            const Attempt endless = with({"limits.triangles=20000", "tests.generation=false", "tests.tex_coord=false",
                                          "tests.view=false", mode, order});
            INFO(endless.end.text());
            CHECK(endless.end.exit_code == 4);
            CHECK_THAT(endless.end.err, Contains("limits.triangles = 20000"));
        }
}

TEST_CASE("the narrowest and widest formats run or report the value that does not fit") {
    const auto settles = [](std::vector<std::string> settings) {
        // so coarse a bound allows that many flips
        settings.insert(settings.end(), {"check.allowed_flips=100", "check.allowed_triangles=100"});
        const Attempt attempt(settings);
        INFO(attempt.end.text());
        if (attempt.end.exit_code == 0) {
            attempt.well();
            return;
        }
        CHECK(attempt.end.exit_code == 2);
        CHECK(attempt.end.err.rfind("tessera: ", 0) == 0);
        CHECK(attempt.here.names().empty());
    };
    settles({"formats.position_bits=8", "formats.position_fraction=4"});
    settles({"formats.position_bits=32", "formats.position_fraction=31"});
    settles({"formats.position_bits=32", "formats.position_fraction=0"});
    settles({"formats.normal_bits=6", "formats.normal_fraction=4"});
    settles({"formats.normal_bits=18", "formats.normal_fraction=16"});
    settles({"formats.normal_fraction=0"});
    settles({"formats.texture_integer=8", "formats.texture_fraction=0"});
    settles({"formats.displacement_bits=1"});
    settles({"formats.summed_height_bits=8"});
    settles({"formats.summed_height_bits=48"});
    settles({"formats.screen_bits=16", "formats.screen_fraction=0"});
    settles({"formats.screen_bits=31", "formats.screen_fraction=16"});
    settles({"formats.generation_bits=1", "tests.generation_limit=1"});
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

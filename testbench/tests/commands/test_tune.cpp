#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

using namespace tessera;
using Catch::Contains;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

const Arguments small_map{"--set", "map.width=64", "--set", "map.height=64"};

/// Runs the tuned job and compares it: error.json must have the tuner's figures, bit for bit.
void check_by_run_and_compare(const fs::path& folder, const std::string& name) {
    const Json tuned = read_json(folder / (name + ".json"));
    succeed({"run", name + ".toml", "--set", "mode=functional", "--set", "check.end_to_end=false", "--set",
             "output.picture=false"},
            folder);
    const fs::path run = folder / "runs" / fs::path(name).filename();
    succeed({"compare", run.string()}, folder);
    const Json error = read_json(run / "error.json");
    const auto value = [&](const char* group, const char* figure) { return error.at(group).at(figure).at("value"); };
    CHECK(value("measurement", "triangles") == tuned.at("triangles"));
    const bool vertical = tuned.at("error").at("what") == "vertical error";
    const bool map_units = tuned.at("error").at("unit") == "map unit";
    const char* const group = vertical ? "vertical" : "interpolated";
    CHECK(value(group, vertical ? (map_units ? "rms_map" : "rms") : "reference_to_mesh_rms") ==
          tuned.at("error").at("rms"));
    CHECK(value(group, vertical ? (map_units ? "max_map" : "max") : "reference_to_mesh_max") ==
          tuned.at("error").at("max"));
}

}  // namespace

TEST_CASE("tune writes a job that runs with the reported figures, and the same bytes again") {
    const TestFolder here;
    const Arguments tune = Arguments{"tune", "--triangles", "600", "--tried", "tried.csv"} + small_map;
    succeed(tune, here.path());
    CHECK(here.names() == Arguments{"tried.csv", "tuned.json", "tuned.toml"});
    const Json tuned = read_json(here.path() / "tuned.json");
    CHECK(tuned.at("triangles") <= 600);
    CHECK(tuned.at("triangles") >= 570);
    CHECK(tuned.at("goal").at("triangles") == 600);
    CHECK(lines_of(read_all(here.path() / "tried.csv")).size() > 10);
    CHECK_THAT(read_all(here.path() / "tuned.toml"), Contains("# Tuned by") && Contains("runs/tuned"));
    check_by_run_and_compare(here.path(), "tuned");

    const TestFolder again;
    succeed(tune + Arguments{"--jobs", "2"}, again.path());
    for (const char* const name : {"tuned.json", "tuned.toml", "tried.csv"})
        CHECK(read_all(again.path() / name) == read_all(here.path() / name));
}

TEST_CASE("tune chooses a base mesh, writes a lattice beside the job and keeps a bound") {
    const TestFolder here;
    fs::create_directory(here.path() / "found");
    succeed(Arguments{"tune", "--triangles", "900", "--grid", "lattice16", "--output", "found/lattice.toml", "--set",
                      "tests.view=false"} +
                small_map,
            here.path());
    CHECK(fs::exists(here.path() / "found/lattice.obj"));
    CHECK_THAT(read_all(here.path() / "found/lattice.toml"), Contains("file = \"lattice.obj\""));
    CHECK(read_json(here.path() / "found/lattice.json").at("base").at("spacing") == 16);
    check_by_run_and_compare(here.path(), "found/lattice");
    write_all(here.path() / "found/lattice.obj", read_all(here.path() / "found/lattice.obj") + "# changed\n");
    const ProgramEnd changed = run_tessera({"run", "found/lattice.toml"}, here.path());
    CHECK(changed.exit_code == 2);
    CHECK_THAT(changed.err, Contains("mesh.fingerprint = ") && Contains("was changed since"));

    succeed(Arguments{"tune", "--error", "0.02", "--grid", "auto", "--output", "bound.toml"} + small_map, here.path());
    const Json bound = read_json(here.path() / "bound.json");
    CHECK(bound.at("goal").at("error") == 0.02);
    CHECK(bound.at("error").at("rms") <= 0.02);
    CHECK(bound.at("error").at("rms") > 0.015);
    check_by_run_and_compare(here.path(), "bound");
}

TEST_CASE("a bound on the error holds for the error that compare measures, bit for bit") {
    const TestFolder here;
    const auto error_for = [&](const char* option, const std::string& value) {
        succeed(Arguments{"tune", option, value, "--vary", "none", "--grid", "5x7", "--set", "tests.view=false"} +
                    small_map,
                here.path());
        return read_json(here.path() / "tuned.json").at("error").at("rms").get<double>();
    };
    for (int triangles = 100; triangles <= 800; triangles += 100) {
        const double bound = std::nextafter(error_for("--triangles", std::to_string(triangles)), 0.0);
        INFO(triangles);
        CHECK(error_for("--error", Json(bound).dump()) <= bound);
    }
}

TEST_CASE("a tuned job whose map has changed since is refused") {
    const TestFolder here;
    write_all(here.path() / "map.pgm", "P2 4 4 9\n0 9 5 1\n1 2 3 1\n8 2 3 1\n4 2 9 0\n");
    succeed({"tune", "--triangles", "60", "--set", "map.file=map.pgm"}, here.path());
    const Arguments run{"run", "tuned.toml", "--set", "mode=functional"};
    succeed(run, here.path());
    write_all(here.path() / "map.pgm", "P2 4 4 9\n0 9 5 1\n1 2 3 1\n8 2 3 1\n4 2 9 9\n");
    const ProgramEnd end = run_tessera(run, here.path());
    INFO(end.text());
    CHECK(end.exit_code == 2);
    CHECK_THAT(end.err, Contains("map.fingerprint = ") && Contains("was changed since"));
}

TEST_CASE("tune finds a Bound Test's threshold for an error in metres, on one of the given lattices") {
    const TestFolder here;
    const std::string job = (source_folder() / "testbench/examples/jobs/crater_lake_rank.toml").string();
    succeed({"tune", job, "--error", "60", "--metric", "max", "--grid", "lattice64,lattice128"}, here.path());
    const Json bound = read_json(here.path() / "tuned.json");
    CHECK(bound.at("height_test") == "rank");
    CHECK(bound.at("error").at("unit") == "map unit");
    CHECK(bound.at("error").at("max") <= 60);
    CHECK(bound.at("triangles") < 2000);
    CHECK_THAT(read_all(here.path() / "tuned.toml"), Contains("spacing = ") && Contains("rank_bits = 0\n"));
    check_by_run_and_compare(here.path(), "tuned");
}

TEST_CASE("tune chooses between the paper's tests and a Rank Test") {
    const TestFolder here;
    succeed(Arguments{"tune", "--triangles", "600", "--tests", "normal,summed_height,rank", "--grid", "auto", "--tried",
                      "tried.csv", "--set", "tests.view=false"} +
                small_map,
            here.path());
    const Json tuned = read_json(here.path() / "tuned.json");
    CHECK(tuned.at("height_test") == "rank");
    CHECK_THAT(read_all(here.path() / "tried.csv"), Contains(",summed_height,") && Contains(",rank,"));
    check_by_run_and_compare(here.path(), "tuned");
}

TEST_CASE("tune works on a surface that is not a height field") {
    const TestFolder here;
    succeed(Arguments{"tune", "--triangles", "1200", "--set", "mesh.source=cylinder", "--set", "mesh.columns=12",
                      "--set", "mesh.rows=6", "--set", "map.address_u=repeat", "--set", "displacement.scale=0.1"} +
                small_map,
            here.path());
    const Json tuned = read_json(here.path() / "tuned.json");
    CHECK(tuned.at("error").at("unit") == "model unit");
    CHECK(tuned.at("triangles") <= 1200);
    check_by_run_and_compare(here.path(), "tuned");
}

// Others that name a remedy: remedies.h.
TEST_CASE("tune refuses wrong usage and unreachable goals, and writes nothing") {
    const TestFolder here;
    const auto tune = [&](const Arguments& more) { return refused(Arguments{"tune"} + more + small_map, here.path()); };
    CHECK_THAT(tune({}), Contains("--triangles") && Contains("--error") && Contains("tune --help"));
    CHECK_THAT(tune({"--triangles", "5", "--error", "1"}), Contains("either"));
    CHECK_THAT(tune({"--triangles", "900", "--tests", "summed_height,curvature"}), Contains("one of them"));
    CHECK_THAT(tune({"--triangles", "-4"}), Contains("--triangles") && Contains("-4"));
    CHECK_THAT(tune({"--triangles", "17"}),
               Contains("18 triangles") && Contains("(mesh.columns, mesh.rows)") && !Contains("--grid"));
    CHECK_THAT(tune({"--triangles", "17", "--grid", "4x4"}), Contains("32 triangles") && Contains("(--grid)"));
    CHECK_THAT(tune({"--triangles", "3", "--set", "mesh.source=lattice", "--set", "mesh.spacing=16"}),
               Contains("(mesh.spacing)"));
    CHECK_THAT(tune({"--triangles", "100", "--set", "map.source=constant"}),
               Contains("the map has no relief, so that no edge requests a split; use at most 18"));
    CHECK_THAT(tune({"--error", "1e-9"}), Contains("allow at least that") && !Contains("--grid"));
    for (const char* number : {"18446744073709551615", "18446744073709551616", "99999999999999999999999"})
        CHECK_THAT(tune({"--triangles", number}), Contains(number) && Contains("limits.triangles"));
    CHECK_THAT(tune({"--error", "nan"}), Contains("--error"));
    CHECK_THAT(tune({"--triangles", "500", "--jobs", "0"}), Contains("--jobs"));
    CHECK_THAT(tune({"--triangles", "500", "--grid", "3x3", "absent.toml"}), Contains("no such job file"));
    CHECK_THAT(tune({"--triangles", "500", "--grid", "big"}), Contains("--grid big"));
    CHECK_THAT(tune({"--triangles", "500", "--grid", "0x4"}), Contains("--grid 0x4"));
    CHECK_THAT(tune({"--triangles", "500", "--output", "a.toml", "--tried", "./a.toml"}), Contains("--tried"));
    CHECK(here.names().empty());
}

TEST_CASE("tune overwrites neither its inputs nor any mesh") {
    const TestFolder here;
    write_all(here.path() / "mine.toml", "[map]\nwidth = 32\nheight = 32\n");
    write_all(here.path() / "own.obj", "# mine\nv 0 0 0\n");
    CHECK_THAT(refused({"tune", "mine.toml", "--triangles", "300", "--output", "mine.toml"}, here.path()),
               Contains("would overwrite mine.toml"));
    CHECK_THAT(
        refused(Arguments{"tune", "--triangles", "300", "--grid", "lattice16", "--output", "own.toml"} + small_map,
                here.path()),
        Contains("own.obj"));
    CHECK(read_all(here.path() / "own.obj") == "# mine\nv 0 0 0\n");
    REQUIRE(run_tessera({"run", "--set", "mode=functional", "--set", "map.width=32", "--set", "map.height=32", "--set",
                         "output.folder=runs/tuned"},
                        here.path())
                .exit_code == 0);
    CHECK_THAT(refused({"tune", "--triangles", "30000", "--set", "mesh.source=run", "--set", "mesh.file=runs/tuned"},
                       here.path()),
               Contains("remove its own base mesh"));
}

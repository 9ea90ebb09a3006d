#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

using namespace tessera;
using Catch::Contains;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

const Arguments quick{"--set", "map.width=48", "--set", "map.height=48", "--set", "tests.generation_limit=6"};

}  // namespace

TEST_CASE("widths: a row has the figures of tessera run with those formats") {
    const TestFolder here;
    const ProgramEnd end =
        succeed(Arguments{"widths", "--quantity", "normal,screen_range", "--bits", "8..14", "--output", "w"} + quick,
                here.path());
    CHECK_THAT(end.out, Contains("knee: ") && Contains("refused: ") && Contains("w/widths.csv"));
    CHECK(lines_of(read_all(here.path() / "w/widths.csv")).size() == 1 + 14);
    const Json table = read_json(here.path() / "w/widths.json");
    const auto check_row = [&](const char* quantity, std::int64_t bits, const Arguments& formats) {
        INFO(quantity << " " << bits);
        const Json* row = nullptr;
        for (const Json& each : table.at("quantities").at(quantity).at("rows"))
            if (each.at("bits") == bits)
                row = &each;
        REQUIRE(row != nullptr);
        succeed(
            Arguments{"run", "--set", "mode=functional", "--set", "output.picture=false", "--set",
                      "check.allowed_flips=100", "--set", "check.allowed_triangles=100", "--set", "output.folder=run"} +
                formats + quick,
            here.path());
        const Json statistics = read_json(here.path() / "run/statistics.json");
        const Json conformance = read_json(here.path() / "run/conformance.json");
        const auto value = [&](const char* group, const std::string& name) {
            return statistics.at(group).at(name).at("value");
        };
        CHECK(row->at("triangles") == value("run", "triangles_finished"));
        CHECK(row->at("edges") == value("run", "edges_tested"));
        CHECK(row->at("edges_split") == value("run", "edges_split"));
        CHECK(row->at("storage").at("queue_entry_bits") == value("formats", "queue_entry"));
        CHECK(row->at("storage").at("normal_map_bytes") == value("normal_map", "size"));
        CHECK(row->at("storage").at("summed_height_table_bytes") == value("summed_height_table", "size"));
        for (const auto& [name, count] : row->at("saturations").items())
            CHECK(count == value("saturations", name));
        const Json& checked = conformance.at("conformance");
        CHECK(row->at("local").at("flipped_edges") == checked.at("flipped_edges"));
        CHECK(row->at("local").at("mismatches") == checked.at("mismatches"));
    };
    check_row("normal", 8, {"--set", "formats.normal_bits=8", "--set", "formats.normal_fraction=6"});
    check_row("normal", 13, {"--set", "formats.normal_bits=13", "--set", "formats.normal_fraction=11"});
}

TEST_CASE("widths: a row of saturated screen positions has the run's count, and the run warns") {
    const TestFolder here;
    const Arguments near{"--set", "camera.eye=[0.2, -0.5, 0.4]", "--set", "camera.viewport_width=256",
                         "--set", "camera.viewport_height=256"};
    succeed(Arguments{"widths", "--quantity", "screen_range", "--bits", "18", "--output", "s.csv"} + near + quick,
            here.path());
    const Json row = read_json(here.path() / "s.json").at("quantities").at("screen_range").at("rows").at(0);
    const ProgramEnd run =
        succeed(Arguments{"run", "--set", "formats.screen_bits=18", "--set", "check.allowed_triangles=100", "--set",
                          "output.folder=run", "--set", "output.picture=false"} +
                    near + quick,
                here.path());
    const Json statistics = read_json(here.path() / "run/statistics.json");
    const Json counted = statistics.at("saturations").at("screen_position").at("value");
    CHECK(counted > 100);
    CHECK(row.at("saturations").at("screen_position") == counted);
    CHECK_THAT(run.out, Contains("warning: screen position: ") && Contains("formats.screen_bits"));
}

TEST_CASE("widths: a map not divisible by the mesh's quads gives a warning") {
    const TestFolder here;
    const auto sweep = [&](const char* side) {
        const std::string text =
            succeed({"widths", "--quantity", "normal", "--bits", "14..14", "--output", "w.csv", "--set",
                     std::string("map.width=") + side, "--set", std::string("map.height=") + side},
                    here.path())
                .out;
        CHECK(read_json(here.path() / "w.json").contains("warning") == (text.find("warning: ") != std::string::npos));
        return text;
    };
    CHECK_THAT(sweep("64"), Contains("warning: ") && Contains("map.height = 72"));
    CHECK_THAT(sweep("72"), !Contains("warning: "));
}

TEST_CASE("widths: the output is identical again, with two threads, into a folder or a file") {
    const TestFolder here;
    const Arguments sweep = Arguments{"widths", "--quantity", "position,displacement", "--bits", "10..12"} + quick;
    const ProgramEnd first = succeed(sweep + Arguments{"--output", "a"}, here.path());
    const ProgramEnd second = succeed(sweep + Arguments{"--output", "b.csv", "--jobs", "2"}, here.path());
    CHECK(here.names() == Arguments{"a", "b.csv", "b.json"});
    CHECK(read_all(here.path() / "a/widths.csv") == read_all(here.path() / "b.csv"));
    CHECK(read_all(here.path() / "a/widths.json") == read_all(here.path() / "b.json"));
    CHECK(first.out.substr(0, first.out.find("written")) == second.out.substr(0, second.out.find("written")));
}

TEST_CASE("widths: wrong usage is refused in one line, and nothing is written") {
    const TestFolder here;
    const auto sweep_refused = [&](const Arguments& more) {
        return refused(Arguments{"widths"} + more + quick, here.path());
    };
    CHECK_THAT(sweep_refused({"--quantity", "normals"}),
               Contains("--quantity normals") && Contains("did you mean normal?"));
    CHECK_THAT(sweep_refused({"--quantity", "normal,normal"}), Contains("twice"));
    CHECK_THAT(sweep_refused({"--bits", "8-12"}), Contains("--bits 8-12") && Contains("8..16"));
    CHECK_THAT(sweep_refused({"--bits", "12..8"}), Contains("8..12"));
    CHECK_THAT(sweep_refused({"--bits", "0..8"}), Contains("--bits 0..8"));
    CHECK_THAT(sweep_refused({"--bits", "8..100"}), Contains("64"));
    CHECK_THAT(sweep_refused({"--quantity", "normal", "--bits", "20..30"}), Contains("normal has 6 to 18 bits"));
    CHECK_THAT(sweep_refused({"--flips", "-1"}), Contains("--flips"));
    CHECK_THAT(sweep_refused({"--flips", "101"}), Contains("--flips 101"));
    CHECK_THAT(sweep_refused({"--flips", "nan"}), Contains("--flips"));
    CHECK_THAT(sweep_refused({"--error", "-1"}), Contains("--error"));
    CHECK_THAT(sweep_refused({"--error", "inf"}), Contains("--error"));
    CHECK_THAT(sweep_refused({"--jobs", "0"}), Contains("--jobs: Value 0 not in range") && Contains("64"));
    CHECK_THAT(sweep_refused({"--output", ""}), Contains("--output"));
    CHECK_THAT(sweep_refused({"--output", "absent/w.csv"}), Contains("absent"));
    CHECK_THAT(sweep_refused({"absent.toml"}), Contains("no such job file"));
    CHECK_THAT(sweep_refused({"--set", "frames.count=3"}), Contains("frames.count = 3"));
    CHECK_THAT(sweep_refused({"--set", "formats.normal_bits=40"}), Contains("formats.normal_bits"));
    CHECK(here.names().empty());

    write_all(here.path() / "job.toml", "[map]\nwidth = 16\nheight = 16\n");
    write_all(here.path() / "m.csv", "P2 2 2 9 1 2 3 4\n");
    CHECK_THAT(sweep_refused({"--output", "m.csv", "--set", "map.source=file", "--set", "map.file=m.csv"}),
               Contains("would overwrite m.csv"));
    CHECK(read_all(here.path() / "m.csv") == "P2 2 2 9 1 2 3 4\n");
}

TEST_CASE("widths: a sweep with every width refused fails") {
    const TestFolder here;
    const ProgramEnd end = run_tessera(
        Arguments{"widths", "--quantity", "screen", "--bits", "10..14", "--output", "w"} + quick, here.path());
    INFO(end.text());
    CHECK(end.exit_code == 2);
    CHECK(lines_of(end.err).size() == 1);
    CHECK_THAT(end.err, Contains("every width was refused, screen of 14 bits because: ") &&
                            Contains("formats.screen_fraction = 8"));
    CHECK_THAT(end.out, Contains("knee: none; every width was refused"));
}

TEST_CASE("widths: Crater Lake's Summed Height Table and positions") {
    const TestFolder here;
    const std::string job = (source_folder() / "testbench/examples/jobs/crater_lake_24.toml").string();
    succeed({"widths", job, "--quantity", "summed_height,position", "--bits", "24..32", "--output", "w"}, here.path());
    const Json table = read_json(here.path() / "w/widths.json").at("quantities");
    // a table of sufficient width changes nothing
    const Json& heights = table.at("summed_height").at("rows");
    const Json& widest = heights.at(0);
    std::size_t refused = 0;
    for (const Json& row : heights) {
        refused += row.contains("refused") ? 1u : 0u;
        if (!row.contains("refused")) {
            CHECK(row.at("triangles") == widest.at("triangles"));
            CHECK(row.at("position_error") == widest.at("position_error"));
        }
    }
    CHECK(refused > 0);
    CHECK(refused < heights.size());
    for (const Json& row : table.at("position").at("rows")) {
        CHECK(row.at("cracks") == 0);
        CHECK(row.at("local").at("mismatches") == 0);
    }
}

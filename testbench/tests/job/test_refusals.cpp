// A user's mistakes: what is refused, and that the message says where and why.
#include <rapidcheck/catch.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "testbench/job/job_keys.h"
#include "testbench/job/nearest_name.h"
#include "testbench/job/read_job.h"
#include "testbench/job/toml_text.h"
#include "testbench/job/validate_job.h"
#include "testbench/tests/job/job_cases.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using Catch::Equals;
using Catch::StartsWith;

namespace fs = std::filesystem;

namespace {

std::string validate_error_of(const Job& job) {
    return error_of([&] { validate(job); });
}

}  // namespace

TEST_CASE("every key refuses values of every other type, with line and column") {
    const std::vector<std::string> values{"true",
                                          "3",
                                          "\"word\"",
                                          "1979-05-27",
                                          "07:32:00",
                                          "1979-05-27T07:32:00Z",
                                          "[1, 2]",
                                          "[1, 2, 3, 4]",
                                          "[1, \"a\", 3]",
                                          "{ a = 1 }",
                                          "[]",
                                          "0.5"};
    for (const Key& key : all_keys()) {
        std::size_t refused = 0;
        for (const std::string& value : values) {
            const std::string error = parse_error_of("\n" + one_key(key, value));
            if (!error.empty()) {
                INFO(key.name << " = " << value);
                ++refused;
                CHECK_THAT(error, StartsWith(key.name == "mode" ? "job.toml:2:1: `" : "job.toml:3:1: `"));
                CHECK_THAT(error, Contains("`" + key.name + "`"));
            }
        }
        INFO(key.name);
        CHECK(refused >= values.size() - 2);
    }
}

TEST_CASE("every number's range holds at its ends and refuses beyond them") {
    for (const Key& key : all_keys()) {
        INFO(key.name);
        const auto around = [&](double value) {
            const std::string text = key.kind == KeyKind::integer
                                         ? std::to_string(static_cast<std::int64_t>(value))
                                         : toml_number(value);
            return key.kind == KeyKind::vector ? "[1, 1, " + text + "]" : text;
        };
        if (key.kind != KeyKind::integer && key.kind != KeyKind::number && key.kind != KeyKind::vector) {
            continue;
        }
        const double infinity = std::numeric_limits<double>::infinity();
        const bool whole = key.kind == KeyKind::integer;
        const double below = whole ? key.range.low - 1 : std::nextafter(key.range.low, -infinity);
        const double above = whole ? key.range.high + 1 : std::nextafter(key.range.high, infinity);
        CHECK_THAT(parse_error_of(one_key(key, around(key.range.low))), Equals(""));
        CHECK_THAT(parse_error_of(one_key(key, around(key.range.high))), Equals(""));
        const std::string too_high = parse_error_of(one_key(key, around(above)));
        CHECK_THAT(too_high, StartsWith("job.toml:2:1: `" + key.name + "` = "));
        CHECK_THAT(too_high, Contains("out of range; the range is"));
        if (!(key.range.or_zero && below == 0)) {
            CHECK_THAT(parse_error_of(one_key(key, around(below))), Contains("out of range; the range is"));
        }
        if (!whole) {
            for (const std::string value : {"nan", "-nan", "inf", "-inf"}) {
                const std::string error = parse_error_of(
                    one_key(key, key.kind == KeyKind::vector ? "[1, " + value + ", 1]" : value));
                CHECK_THAT(error, Contains("`" + key.name + "` = ") && Contains("not a finite number"));
            }
        }
    }
    CHECK_THAT(parse_error_of("formats.summed_height_bits = 0"), Equals(""));
    CHECK_THAT(parse_error_of("formats.summed_height_bits = 7"), Contains("the range is 0 or 8 .. 48 bits"));
}

TEST_CASE("mistyped names are reported with place and suggestion") {
    CHECK_THAT(parse_error_of("[mesh]\nrows = 2\n\n  colums = 3\n"),
               Equals("job.toml:4:3: unknown key `mesh.colums`; did you mean `mesh.columns`?"));
    CHECK_THAT(parse_error_of("mesh.colums = 3"),
               Equals("job.toml:1:6: unknown key `mesh.colums`; did you mean `mesh.columns`?"));
    CHECK_THAT(parse_error_of("[mehs]\nrows = 2\n"), Contains("unknown table `mehs`; did you mean `mesh`?"));
    CHECK_THAT(parse_error_of("[mesh]\naddress_u = \"clamp\"\n"), Contains("did you mean `map.address_u`?"));
    CHECK_THAT(parse_error_of("queue_order = \"lifo\"\n"), Contains("did you mean `hardware.queue_order`?"));
    CHECK_THAT(parse_error_of("\"mesh.rows\" = 2\n"),
               Contains("unknown key `\"mesh.rows\"`; did you mean `mesh.rows`?"));
    CHECK_THAT(parse_error_of("xyzzyplugh = 2\n"),
               Contains("unknown key `xyzzyplugh`; `tessera keys` lists"));
    CHECK_THAT(parse_error_of("[[mesh]]\nrows = 2\n"), Contains("`mesh` is an array of 1"));
    CHECK_THAT(parse_error_of("mesh = 3\n"), Contains("`mesh` is 3, an integer") && Contains("write [mesh]"));
    CHECK_THAT(parse_error_of("[mesh.rows]\nx = 2\n"),
               Contains("`mesh.rows` is a table; expected an integer"));
    CHECK_THAT(parse_error_of("[mesh.more]\nx = 2\n"), Contains("unknown table `mesh.more`"));
    CHECK_THAT(parse_error_of("mesh.camera = {eye = [1, 2, 3]}\n"),
               Contains("unknown table `mesh.camera`; did you mean the group `camera`?") &&
                   Contains("write [camera]") && Contains("eye, target, "));
    CHECK_THAT(parse_error_of("camera = {eye = [1, 2, 3]}\n"), Equals(""));
    CHECK_THAT(parse_error_of("\"\" = 1\n"), Contains("unknown key `\"\"`"));
    CHECK_THAT(parse_error_of("folder = \"x\"\n"), Contains("unknown key `folder`"));
    CHECK(nearest_name("mesh.file", {"mesh.file"}) == "mesh.file");
    CHECK(nearest_name(std::string(100000, 'a'), {"mesh.file"}).empty());
}

TEST_CASE("values are reported with place, value and what is wanted") {
    CHECK_THAT(parse_error_of("[mesh]\ncolumns = 99999\n"),
               Equals("job.toml:2:1: `mesh.columns` = 99999 is out of range; the range is 0 .. 2048 quads"));
    CHECK_THAT(
        parse_error_of("[mesh]\ncolumns = \"three\"\n"),
        Equals("job.toml:2:1: `mesh.columns` is \"three\", a string; expected an integer, 0 .. 2048 quads"));
    CHECK_THAT(parse_error_of("[mesh]\ncolumns = 3.0\n"), Contains("is 3.0, a floating-point number"));
    CHECK_THAT(
        parse_error_of("[map]\nsource = \"half-donut\"\n"),
        Equals(
            "job.toml:2:1: `map.source` = \"half-donut\" is not a choice; the choices are half_donut, text, "
            "noise, constant, ramp, file; did you mean \"half_donut\"?"));
    CHECK_THAT(parse_error_of("[map]\ntext = \"a\\u0000b\"\n"), Contains("without NUL"));
    CHECK_THAT(parse_error_of("[map]\ntext = \"" + std::string(5000, 'x') + "\"\n"),
               Contains("has 5000 bytes"));
    CHECK_THAT(parse_error_of("[output]\nfolder = \"\"\n"), Contains("`output.folder` = \"\" is empty"));
    const std::string two = parse_error_of("[output]\nply = 1\n[mesh]\nrows = -1\n");
    CHECK_THAT(two, StartsWith("job.toml:2:1: `output.ply`") && Contains("\njob.toml:4:1: `mesh.rows`"));
}

TEST_CASE("TOML's own errors carry file, line and column") {
    CHECK_THAT(parse_error_of("[mesh]\nrows = \n"), StartsWith("job.toml:2:") && Contains("not TOML"));
    CHECK_THAT(parse_error_of("[mesh]\nrows = 1\nrows = 2\n"), StartsWith("job.toml:3:"));
    CHECK_THAT(parse_error_of("[mesh]\n[map]\n[mesh]\n"), StartsWith("job.toml:3:"));
    CHECK_THAT(parse_error_of("[mesh\n"), StartsWith("job.toml:1:"));
    CHECK_THAT(parse_error_of("[mesh]\nrows = 99999999999999999999\n"), StartsWith("job.toml:2:"));
    CHECK_THAT(parse_error_of("[mesh]\nwidth = 1e999\n"), StartsWith("job.toml:2:"));
}

TEST_CASE("files that are no job files") {
    const TemporaryFolder folder;
    const auto read_error = [](const fs::path& path) { return error_of([&] { read_job(path); }); };
    CHECK_THAT(read_error(folder.path() / "none.toml"), Contains("none.toml: no such job file"));
    CHECK_THAT(read_error(folder.path() / "none" / "none.toml"), Contains("no such job file"));
    CHECK_THAT(read_error(folder.path()), Contains("is a folder"));
    CHECK_THAT(read_error("/dev/null"), Contains("is not a file that can be read"));
    CHECK_THAT(read_error(folder.write("huge.toml", std::string(1024 * 1024 + 1, '#'))),
               Contains("over 1048576 bytes"));
    CHECK_THAT(read_error(folder.write("largest.toml", std::string(1024 * 1024, '\n'))), Equals(""));
    const fs::path typo = folder.write("typo.toml", "[mesh]\ncolums = 3\n");
    CHECK_THAT(read_error(typo), StartsWith(typo.string() + ":2:1: unknown key"));
    std::string garbage;
    for (std::uint32_t i = 0, state = 1; i < 100000; ++i) {
        state = state * 1664525u + 1013904223u;
        garbage += static_cast<char>(state >> 24);
    }
    const fs::path binary = folder.write("garbage.toml", garbage);
    CHECK_THAT(read_error(binary), StartsWith(binary.string() + ":1:"));
    const fs::path not_a_folder = folder.write("file", "") / "job.toml";
    CHECK_FALSE(read_error(not_a_folder).empty());
    CHECK_FALSE(read_error("").empty());
    CHECK_FALSE(read_error(fs::path(std::string(10000, 'x'))).empty());
}

TEST_CASE("keys that contradict each other") {
    const auto error_with = [](const std::vector<std::string>& settings) {
        Job job;
        for (const std::string& setting : settings) {
            apply_setting(job, setting);
        }
        return validate_error_of(job);
    };
    CHECK_THAT(error_with({"mesh.source=file"}), Contains("`mesh.file` is empty"));
    CHECK_THAT(error_with({"mesh.source=patches"}),
               Contains("`mesh.file` is empty, but `mesh.source` = \"patches\""));
    CHECK_THAT(error_with({"mesh.source=patches", "mesh.file=a.txt"}), Equals(""));
    CHECK_THAT(error_with({"mesh.file=a.obj", "mesh.source=plane"}),
               Contains("`mesh.file` = \"a.obj\", but `mesh.source` = \"plane\""));
    CHECK_THAT(error_with({"map.source=file"}), Contains("`map.file` is empty"));
    CHECK_THAT(error_with({"map.file=a.exr", "map.source=half_donut"}),
               Contains("`map.source` = \"half_donut\" reads no file"));
    CHECK_THAT(error_with({"map.source=file", "map.file=a.exr", "mesh.source=file", "mesh.file=a.obj"}),
               Equals(""));
    CHECK_THAT(error_with({"mesh.source=cylinder", "mesh.columns=2"}),
               Contains("a cylinder closes around itself"));
    CHECK_THAT(error_with({"mesh.source=sphere", "mesh.rows=1"}), Contains("a sphere has 2 or more"));
    CHECK_THAT(error_with({"map.source=text", "map.text="}), Contains("`map.text` is empty"));
    CHECK_THAT(error_with({"formats.texture_integer=8", "map.width=256", "map.height=256"}), Equals(""));
    CHECK_THAT(error_with({"formats.texture_integer=7"}),
               Contains("`formats.texture_integer` = 7 addresses at most 128"));
    CHECK_THAT(error_with({"camera.eye=[0, 0, 0]", "camera.target=[0, 0, 0]"}),
               Contains("are the same point"));
    CHECK_THAT(error_with({"camera.up=[0, 0, 0]"}),
               Contains("`camera.up` = [0.0, 0.0, 0.0] has no direction"));
    CHECK_THAT(error_with({"camera.eye=[0, 0, 5]", "camera.target=[0, 0, 0]", "camera.up=[0, 0, 1]"}),
               Contains("is parallel to the view direction [0.0, 0.0, -5.0]"));
    CHECK_THAT(error_with({"camera.eye=[0, 0, 5]", "camera.up=[0, 1, 0]"}), Equals(""));
    CHECK_THAT(error_with({"hardware.light=[0, 0, 0]"}), Contains("`hardware.light`"));
    CHECK_THAT(error_with({"formats.position_bits=16"}),
               Contains("`formats.position_fraction` = 16 must be less than"));
    CHECK_THAT(error_with({"formats.position_bits=17"}), Equals(""));
    CHECK_THAT(error_with({"formats.screen_bits=8"}),
               Contains("`formats.screen_fraction` = 8 must be less than"));
    CHECK_THAT(error_with({"formats.normal_bits=15"}), Contains("`formats.normal_fraction` = 14 leaves 1"));
    CHECK_THAT(error_with({"formats.generation_bits=3"}),
               Contains("`formats.generation_bits` = 3 counts to 7"));
    CHECK_THAT(error_with({"formats.generation_bits=3", "tests.generation_limit=7"}), Equals(""));
    CHECK_THAT(error_with({"formats.screen_bits=18"}), Contains("reaches only 512 pixels"));
    CHECK_THAT(error_with({"mesh.source=file", "map.source=file"}),
               Contains("`mesh.file`") && Contains("\n`map.file`"));

    CHECK_THAT(error_with({"map.fingerprint=0123456789abcdef"}), Contains("`map.file` is empty"));
    CHECK_THAT(error_with({"map.source=file", "map.file=a.exr", "map.fingerprint=0123456789ABCDEF"}),
               Contains("expected 16 hexadecimal digits"));
    CHECK_THAT(error_with({"map.source=file", "map.file=a.exr", "map.fingerprint=0123456789abcdef"}),
               Equals(""));

    const std::string fault = "fault.kind=dropped", place = "fault.place=host.to_get_triangle";
    CHECK_THAT(error_with({fault, place}), Equals(""));
    CHECK_THAT(error_with({fault}), Contains("`fault.place` is empty"));
    CHECK_THAT(error_with({place}), Contains("but `fault.kind` = \"none\""));
    CHECK_THAT(error_with({fault, place, "frames.count=2"}), Contains("`frames.count` = 2"));
    CHECK_THAT(error_with({fault, place, "output.vcd=true"}), Contains("`output.vcd` = true"));
    CHECK_THAT(error_with({fault, place, "output.timeline=true"}), Contains("`output.timeline` = true"));

    Job out_of_range;  // made in code, past the checks of reading
    out_of_range.tests.normal_threshold = -1;
    out_of_range.camera.viewport_width = 0;
    CHECK_THAT(validate_error_of(out_of_range),
               Contains("`camera.viewport_width` = 0 is out of range") &&
                   Contains("\n`tests.normal_threshold` = -1.0 is out of range"));
    out_of_range.formats.texture_integer = 1000;  // must not reach a shift
    CHECK_THAT(validate_error_of(out_of_range), Contains("`formats.texture_integer` = 1000"));
}

TEST_CASE("validate survives random jobs") {
    rc::prop("a verdict, nothing else", [] {
        Job job;
        for (const Key& key : all_keys()) {
            set_value(job, key, random_value(key));
        }
        validate_error_of(job);
    });
}

// User errors: what is refused, and that the message says where and why.
#include <rapidcheck/catch.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "testbench/common/random.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/nearest_name.h"
#include "testbench/job/read_job.h"
#include "testbench/job/toml_text.h"
#include "testbench/job/validate_job.h"
#include "testbench/tests/job/job_cases.h"
#include "testbench/tests/support/refusals.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using Catch::Equals;
using Catch::StartsWith;

namespace fs = std::filesystem;

namespace {

std::string validate_error_of(const Job& job) {
    return input_error_of([&] { validate(job); });
}

void expect_whole(const std::string& input, const std::string& message) {
    INFO(input);
    CHECK(parse_error_of(input) == message);
}

/// Applies settings separated by "; " in order, and returns validate()'s message about them.
std::string settings_error_of(const std::string& settings) {
    Job job;
    for (std::size_t from = 0; from < settings.size();) {
        const std::size_t end = std::min(settings.find("; ", from), settings.size());
        apply_setting(job, settings.substr(from, end - from));
        from = end + 2;
    }
    return validate_error_of(job);
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
        // A list of numbers is also one number, or none.
        const std::size_t most_accepted = key.kind == KeyKind::numbers ? 5 : 2;
        CHECK(refused >= values.size() - most_accepted);
    }
}

TEST_CASE("every number's range holds at its ends and refuses beyond them") {
    for (const Key& key : all_keys()) {
        INFO(key.name);
        const auto around = [&](double value) {
            const std::string text =
                key.kind == KeyKind::integer ? std::to_string(static_cast<std::int64_t>(value)) : toml_number(value);
            return key.kind == KeyKind::vector ? "[1, 1, " + text + "]" : text;
        };
        if (key.kind != KeyKind::integer && key.kind != KeyKind::number && key.kind != KeyKind::vector)
            continue;
        const double infinity = std::numeric_limits<double>::infinity();
        const bool whole = key.kind == KeyKind::integer;
        const double below = whole ? key.range.low - 1 : std::nextafter(key.range.low, -infinity);
        const double above = whole ? key.range.high + 1 : std::nextafter(key.range.high, infinity);
        CHECK_THAT(parse_error_of(one_key(key, around(key.range.low))), Equals(""));
        CHECK_THAT(parse_error_of(one_key(key, around(key.range.high))), Equals(""));
        const std::string too_high = parse_error_of(one_key(key, around(above)));
        CHECK_THAT(too_high, StartsWith("job.toml:2:1: `" + key.name + "` = "));
        CHECK_THAT(too_high, Contains("out of range; the range is"));
        if (!(key.range.or_zero && below == 0))
            CHECK_THAT(parse_error_of(one_key(key, around(below))), Contains("out of range; the range is"));
        if (whole) {
            using Limits = std::numeric_limits<std::int64_t>;
            for (const std::int64_t value : {Limits::min(), Limits::max()})
                CHECK_THAT(parse_error_of(one_key(key, std::to_string(value))), Contains("out of range; the range is"));
        } else {
            for (const std::string value : {"nan", "-nan", "inf", "-inf"}) {
                const std::string error =
                    parse_error_of(one_key(key, key.kind == KeyKind::vector ? "[1, " + value + ", 1]" : value));
                CHECK_THAT(error, Contains("`" + key.name + "` = ") && Contains("not a finite number"));
            }
        }
    }
    CHECK_THAT(parse_error_of("formats.summed_height_bits = 0"), Equals(""));
    CHECK_THAT(parse_error_of("formats.summed_height_bits = 7"), Contains("the range is 0 or 8 .. 48 bits"));
}

TEST_CASE("mistyped names are reported with their position and a suggestion") {
    const std::string suggestion = "unknown key `mesh.colums`; did you mean `mesh.columns`?";
    expect_whole("[mesh]\nrows = 2\n\n  colums = 3\n", "job.toml:4:3: " + suggestion);
    expect_whole("mesh.colums = 3", "job.toml:1:6: " + suggestion);
    expect_refusals(
        {
            {"[mehs]\nrows = 2\n", {"unknown table `mehs`; did you mean `mesh`?"}},
            {"[mesh]\naddress_u = \"clamp\"\n", {"did you mean `map.address_u`?"}},
            {"queue_order = \"lifo\"\n", {"did you mean `hardware.queue_order`?"}},
            {"\"mesh.rows\" = 2\n", {"unknown key `\"mesh.rows\"`; did you mean `mesh.rows`?"}},
            {"[tests]\ngradient_threshold = 2\n",
             {"unknown key `tests.gradient_threshold`",
              "; a height test of one's own is known if the environment "
              "variable TESSERA_HEIGHT_TESTS names its library"}},
            {"[hardware]\nheight_test = \"gradient\"\n",
             {"is not a choice; the choices are summed_height, rank, curvature, mipmap", "TESSERA_HEIGHT_TESTS"}},
            {"xyzzyplugh = 2\n", {"unknown key `xyzzyplugh`; `tessera keys` lists"}},
            {"[[mesh]]\nrows = 2\n", {"`mesh` is an array of 1"}},
            {"mesh = 3\n", {"`mesh` is 3, an integer", "write [mesh]"}},
            {"[mesh.rows]\nx = 2\n", {"`mesh.rows` is a table; expected an integer"}},
            {"[mesh.more]\nx = 2\n", {"unknown table `mesh.more`"}},
            {"mesh.camera = {eye = [1, 2, 3]}\n",
             {"unknown table `mesh.camera`; did you mean the group `camera`?", "write [camera]", "eye, target, "}},
            {"camera = {eye = [1, 2, 3]}\n", {}},
            {"\"\" = 1\n", {"unknown key `\"\"`"}},
            {"folder = \"x\"\n", {"unknown key `folder`"}},
            {"[mesh]\n\n[fault]\nkind = \"none\"\n", {"job.toml:3:2: unknown table `fault`"}},
        },
        parse_error_of);
    CHECK(nearest_name("mesh.file", {"mesh.file"}) == "mesh.file");
    CHECK(nearest_name(std::string(100000, 'a'), {"mesh.file"}).empty());
}

TEST_CASE("wrong values are reported with their position, the value and the accepted values") {
    expect_whole("[mesh]\ncolumns = 99999\n",
                 "job.toml:2:1: `mesh.columns` = 99999 is out of range; the range is 0 .. 2048 quads");
    expect_whole("[mesh]\ncolumns = \"three\"\n",
                 "job.toml:2:1: `mesh.columns` is \"three\", a string; expected an integer, 0 .. 2048 quads");
    expect_whole("[map]\nsource = \"half-donut\"\n",
                 "job.toml:2:1: `map.source` = \"half-donut\" is not a choice; the choices are half_donut, text, "
                 "noise, constant, ramp, file; did you mean \"half_donut\"?");
    expect_refusals(
        {
            {"[mesh]\ncolumns = 3.0\n", {"is 3.0, a floating-point number"}},
            {"[map]\ntext = \"a\\u0000b\"\n", {"without NUL"}},
            {"[map]\ntext = \"" + std::string(5000, 'x') + "\"\n", {"has 5000 bytes"}},
            {"[output]\nfolder = \"\"\n", {"`output.folder` = \"\" is empty"}},
            {"[output]\nply = 1\n[mesh]\nrows = -1\n", {"job.toml:2:1: `output.ply`", "\njob.toml:4:1: `mesh.rows`"}},
        },
        parse_error_of);
}

TEST_CASE("TOML's own errors carry file, line and column") {
    const std::pair<std::string, std::string> rows[] = {
        {"[mesh]\nrows = \n", "job.toml:2:"},
        {"[mesh]\nrows = 1\nrows = 2\n", "job.toml:3:"},
        {"[mesh]\n[map]\n[mesh]\n", "job.toml:3:"},
        {"[mesh\n", "job.toml:1:"},
        {"[mesh]\nrows = 99999999999999999999\n", "job.toml:2:"},
        {"[mesh]\nwidth = 1e999\n", "job.toml:2:"},
        {std::string("[\0m\0e\0s\0h\0]\0", 12), "job.toml:1:"},
        {"[map]\ntext = \"caf\xe9\"\n", "job.toml:2:"},
    };
    for (const auto& [text, place] : rows) {
        INFO(text);
        CHECK_THAT(parse_error_of(text), StartsWith(place));
    }
    CHECK_THAT(parse_error_of("[mesh]\nrows = \n"), Contains("not TOML"));
}

TEST_CASE("files that are not job files are refused") {
    const TestFolder folder;
    const auto read_error = [](const fs::path& path) { return input_error_of([&] { read_job(path); }); };
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
    for (Random random(1); garbage.size() < 100000;)
        garbage += static_cast<char>(random.bits());
    const fs::path binary = folder.write("garbage.toml", garbage);
    CHECK_THAT(read_error(binary), StartsWith(binary.string() + ":1:"));
    const fs::path not_a_folder = folder.write("file", "") / "job.toml";
    CHECK_FALSE(read_error(not_a_folder).empty());
    CHECK_FALSE(read_error("").empty());
    CHECK_FALSE(read_error(fs::path(std::string(10000, 'x'))).empty());
}

TEST_CASE("keys that contradict each other are refused") {
    expect_refusals(
        {
            {"mesh.source=file", {"`mesh.file` is empty"}},
            {"mesh.source=run", {"`mesh.file` is empty, but `mesh.source` = \"run\""}},
            {"mesh.source=run; mesh.file=a", {}},
            {"mesh.file=a.obj; mesh.source=plane", {"`mesh.file` = \"a.obj\", but `mesh.source` = \"plane\""}},
            {"map.source=file", {"`map.file` is empty"}},
            {"map.file=a.exr; map.source=half_donut", {"`map.source` = \"half_donut\" reads no file"}},
            {"map.source=file; map.file=a.exr; mesh.source=file; mesh.file=a.obj", {}},
            {"mesh.source=file; map.source=file", {"`mesh.file`", "\n`map.file`"}},
            {"mesh.source=cylinder; mesh.columns=2", {"a cylinder needs 3 or more to close"}},
            {"mesh.source=sphere; mesh.rows=1", {"a sphere needs 2 or more"}},
            {"mesh.source=lattice; mesh.spacing=24", {"`mesh.spacing` = 24: a lattice needs a power of two"}},
            {"mesh.source=lattice; mesh.spacing=1", {}},
            {"map.source=text; map.text=", {"`map.text` is empty"}},

            {"hardware.triangulation=greatest_rank",
             {"`hardware.triangulation` = \"greatest_rank\", but `hardware.height_test` = \"summed_height\" has no ranks"}},
            {"hardware.triangulation=greatest_rank; hardware.height_test=rank", {}},
            {"tests.rank_view=per_point",
             {"`tests.rank_view` = \"per_point\" needs ranks",
              "set hardware.height_test = \"rank\" and hardware.test_order = \"cheap_first\""}},
            {"tests.rank_view=per_point; hardware.height_test=rank", {"`tests.rank_view` = \"per_point\" needs ranks"}},
            {"tests.rank_view=per_pixel; hardware.height_test=rank; hardware.test_order=cheap_first", {}},
            {"map.heights=fitted", {}},
            {"map.heights=fitted; hardware.displacement_filter=bilinear",
             {"`hardware.displacement_filter` = \"bilinear\" interpolates between texels"}},
            {"map.heights=fitted; hardware.one_texel_from_map=true",
             {"`hardware.one_texel_from_map` = true", "set hardware.one_texel_from_map = false"}},
            {"map.heights=fitted; hardware.one_texel_from_map=true; hardware.height_test=mipmap", {}},
            {"formats.rank_bits=0", {"`formats.rank_bits` = 0 and `formats.bound_bits` = 0"}},
            {"formats.rank_bits=0; formats.bound_bits=6", {}},

            {"formats.texture_integer=8; map.width=256; map.height=256", {}},
            {"formats.texture_integer=7", {"`formats.texture_integer` = 7 addresses at most 128"}},
            {"formats.position_bits=16", {"`formats.position_fraction` = 16 must be less than"}},
            {"formats.position_bits=17", {}},
            {"formats.screen_bits=8", {"reaches only 0 pixels"}},
            {"formats.screen_bits=18", {"reaches only 512 pixels"}},
            {"formats.normal_bits=15", {"`formats.normal_fraction` = 14 leaves 1"}},
            {"formats.generation_bits=3", {"`formats.generation_bits` = 3 counts to 7"}},
            {"formats.generation_bits=3; tests.generation_limit=7", {}},

            {"camera.eye=[0, 0, 0]; camera.target=[0, 0, 0]",
             {"`camera.eye`", "`camera.target`", "are the same point"}},
            {"camera.eye=[1e6,1e6,1e6]; camera.target=[1e6,1e6,999999.9999999]", {"are the same point"}},
            {"camera.up=[0, 0, 0]", {"`camera.up` = [0.0, 0.0, 0.0] has no direction"}},
            {"camera.eye=[0, 0, 5]; camera.target=[0, 0, 0]; camera.up=[0, 0, 1]",
             {"is parallel to the view direction [0.0, 0.0, -5.0]"}},
            {"camera.eye=[0, 0, 5]; camera.target=[0, 0, 0]; camera.up=[0, 0, -5]", {"is parallel"}},
            {"camera.eye=[0, 0, 5]; camera.up=[0, 1, 0]", {}},
            {"hardware.light=[0, 0, 0]", {"`hardware.light`"}},
            {"hardware.tests_units=3", {}},
            {"hardware.tests_units=3; hardware.work=family",
             {"`hardware.tests_units` = 3", "set hardware.tests_units = 1"}},
            {"hardware.edge_lanes=2", {"`hardware.edge_lanes` = 2", "hardware.work = \"family\""}},
            {"hardware.normal_tests=2; hardware.work=family", {"`hardware.normal_tests` = 2"}},
            {"hardware.normal_tests=2; hardware.work=family; hardware.test_order=cheap_first", {}},
            {"hardware.design=modern; hardware.normal_tests=2", {}},

            {"map.fingerprint=0123456789abcdef", {"`map.file` is empty"}},
            {"map.source=file; map.file=a.exr; map.fingerprint=0123456789ABCDEF", {"expected 16 hexadecimal digits"}},
            {"map.source=file; map.file=a.exr; map.fingerprint=0123456789abcdef", {}},
        },
        settings_error_of);

    Job out_of_range;  // set in code, without the checks of the reader
    out_of_range.tests.normal_threshold = -1;
    out_of_range.camera.viewport_width = 0;
    CHECK_THAT(validate_error_of(out_of_range), Contains("`camera.viewport_width` = 0 is out of range") &&
                                                    Contains("\n`tests.normal_threshold` = -1.0 is out of range"));
    out_of_range.formats.texture_integer = 1000;  // must not reach a shift
    CHECK_THAT(validate_error_of(out_of_range), Contains("`formats.texture_integer` = 1000"));
}

TEST_CASE("validate accepts or refuses random jobs") {
    rc::prop("a verdict, nothing else", [] {
        Job job;
        for (const Key& key : all_keys())
            set_value(job, key, random_value(key));
        validate_error_of(job);
    });
}

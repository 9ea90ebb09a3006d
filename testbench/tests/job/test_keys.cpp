// Every key: how it is read, and that a dumped job reads the same again, in any folder.
#include <rapidcheck/catch.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/job/design_preset.h"
#include "testbench/job/dump_job.h"
#include "testbench/job/job_choices.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/job/toml_text.h"
#include "testbench/job/validate_job.h"
#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/tests/job/job_cases.h"
#include "testbench/tests/support/count_members.h"
#include "testbench/tests/support/expect_section.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using Catch::Equals;

namespace fs = std::filesystem;

namespace {

std::string set_error_of(const std::string& setting) {
    return input_error_of([&] {
        Job job;
        apply_setting(job, setting);
    });
}

/// An allowed value of the key that is not its default.
JobValue another_value(const Key& key) {
    const JobValue given = default_of(key);
    switch (key.kind) {
        case KeyKind::flag: return !std::get<bool>(given);
        case KeyKind::integer: {
            const auto low = static_cast<std::int64_t>(key.range.low);
            return std::get<std::int64_t>(given) == low ? low + 1 : low;
        }
        case KeyKind::number: return given == JobValue(key.range.low) ? key.range.high : key.range.low;
        case KeyKind::vector: return std::array<double, 3>{0.1, -1e-7, 12345.678};
        case KeyKind::span: return std::array<double, 2>{-0.5, 1533.25};
        case KeyKind::numbers: return std::vector<double>{-3.4028234663852886e38, -9999, 0.1};
        case KeyKind::choice:
            return std::string(key.choices.back() == std::get<std::string>(given) ? key.choices.front()
                                                                                  : key.choices.back());
        case KeyKind::text:
        case KeyKind::file:
        case KeyKind::folder: return std::string("a \"quoted\" \\ b\xc3\xa4r\n\t\x01\x7f # = ]");
    }
    return given;
}

}  // namespace

TEST_CASE("every member of Job has a key") {
    const auto keys_in = [](const char* table) { return find_table(table)->keys.size(); };
    CHECK(keys_in("mesh") == count_members<Job::Mesh>() - 1);  // path
    CHECK(keys_in("map") == count_members<Job::Map>() - 1);    // path
    CHECK(keys_in("displacement") == count_members<Job::Displacement>());
    CHECK(keys_in("camera") == count_members<Job::Camera>());
    std::size_t thresholds = 0;
    for (const HeightTestHost* host : height_test_hosts())
        thresholds += host->thresholds().size();
    CHECK(keys_in("tests") == count_members<Job::Tests>() - 1 + thresholds);
    CHECK(keys_in("formats") == count_members<Job::Formats>());
    // A base and a struct within it count as one member each.
    CHECK(keys_in("hardware") == count_members<Job::Hardware>() - 2 + count_members<SceneOptions>() +
                                     count_members<DesignOptions>() - 1 + count_members<QueueDesign>());
    CHECK(keys_in("check") == count_members<Job::Check>());
    CHECK(keys_in("limits") == count_members<Job::Limits>());
    CHECK(keys_in("output") == count_members<Job::Output>());
    // Job itself: its tables, its top-level keys, and `folder`, which is not a key.
    CHECK(job_tables().size() - 1 + keys_in("") + 1 == count_members<Job>());
}

TEST_CASE("every key is described, has a unit and a default it accepts") {
    std::vector<std::string> names;
    for (const Key& key : all_keys()) {
        INFO(key.name);
        names.push_back(key.name);
        CHECK(key.description.size() > 5);
        CHECK(key.description.find('\n') == std::string::npos);
        CHECK(key.description.find('|') == std::string::npos);  // the description is part of a Markdown table
        CHECK_FALSE(key.unit.empty());
        CHECK_FALSE(range_text(key).empty());
        CHECK_FALSE(wanted_text(key).empty());
        CHECK_THAT(complaint(key, default_of(key)), Equals(""));
        CHECK(find_key(key.name)->name == key.name);
        if (key.kind == KeyKind::integer || key.kind == KeyKind::number || key.kind == KeyKind::vector) {
            CHECK(std::isfinite(key.range.low));
            CHECK(std::isfinite(key.range.high));
        }
    }
    std::sort(names.begin(), names.end());
    CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
    for (const KeyTable& table : job_tables()) {
        CHECK_FALSE(table.description.empty());
        CHECK_FALSE(table.keys.empty());
    }
}

TEST_CASE("the default job is valid, and an empty file is the default job") {
    CHECK_NOTHROW(validate(Job{}));
    CHECK(same_settings(parse_job("", "empty.toml"), Job{}));
    CHECK(same_settings(parse_job("# nothing\n[mesh]\n", "empty.toml"), Job{}));
}

TEST_CASE("every key reads, sets itself only, dumps and round-trips") {
    for (const Key& key : all_keys()) {
        INFO(key.name);
        const JobValue value = another_value(key);
        REQUIRE_THAT(complaint(key, value), Equals(""));
        const Job job = parse_job(one_key(key, toml_value(value)), "job.toml");
        CHECK(key.get(job) == value);
        CHECK((key.name != "mesh.file" || job.mesh.source == MeshSource::file));
        CHECK((key.name != "map.file" || job.map.source == MapSource::file));
        const bool only_choice = key.kind == KeyKind::choice && key.choices.size() == 1;
        CHECK(same_settings(job, Job{}) == only_choice);

        Job restored = job;
        key.set(restored, default_of(key));
        if (key.name == "hardware.design")
            apply_design(restored);
        if (key.kind == KeyKind::file) {
            restored.mesh.source = MeshSource::plane;
            restored.map.source = MapSource::half_donut;
        }
        CHECK(same_settings(restored, Job{}));

        const std::string dump = dump_job(job);
        const Job again = parse_job(dump, "dump.toml");
        CHECK(same_settings(again, job));
        CHECK(dump_job(again) == dump);
        CHECK_THAT(dump, Contains("# " + key.description + "\n"));

        Job set;
        if (key.kind != KeyKind::file) {
            apply_setting(set, key.name + " = " + toml_value(value));
            CHECK(same_settings(set, job));
        }
    }
}

TEST_CASE("a preset sets its keys, and keys given beside it override it, in any order") {
    const Job modern = parse_job("[hardware]\ndesign = 'modern'\n", "job.toml");
    CHECK(modern.hardware.work == Work::family);
    CHECK(modern.hardware.edge_lanes == 3);
    CHECK(modern.timing.summed_height_table.interleave == Interleave::exclusive_or);
    CHECK_NOTHROW(validate(modern));
    const Job before = parse_job(
        "[timing]\nsummed_height_table_banks = 1\n[hardware]\nedge_lanes = 2\ndesign = 'modern'\n", "job.toml");
    CHECK(before.hardware.edge_lanes == 2);
    CHECK(before.hardware.work == Work::family);
    CHECK(before.timing.summed_height_table.banks == 1);

    Job job = before;
    apply_setting(job, "hardware.design=modern");
    CHECK(same_settings(job, modern));
    apply_setting(job, "hardware.edge_lanes=1");
    CHECK(job.hardware.edge_lanes == 1);
    const std::string short_text = dump_short_job(job, "", "short");
    CHECK_THAT(short_text, Contains("edge_lanes = 1\n"));
    CHECK(same_settings(parse_job(short_text, "short.toml"), job));
    apply_setting(job, "hardware.design=paper");
    CHECK(same_settings(job, Job{}));

    INFO("on a command line, too");
    for (const std::vector<std::string>& settings :
         {std::vector<std::string>{"hardware.edge_lanes=2", "timing.summed_height_table_banks=1",
                                   " hardware.design = modern"},
          std::vector<std::string>{"hardware.edge_lanes=2", "hardware.design=modern",
                                   "timing.summed_height_table_banks=1"},
          std::vector<std::string>{"hardware.design=paper", "hardware.design=modern", "hardware.edge_lanes=2",
                                   "timing.summed_height_table_banks=1"}}) {
        Job set;
        apply_settings(set, settings);
        CHECK(same_settings(set, before));
    }
}

TEST_CASE("keys with automatic values accept auto, and have it by default") {
    std::vector<std::string> automatic_keys;
    for (const Key& key : all_keys()) {
        INFO(key.name);
        const std::string fault = parse_error_of(one_key(key, "\"auto\""));
        if (!key.range.or_auto) {
            const bool text = key.kind == KeyKind::text || key.kind == KeyKind::file || key.kind == KeyKind::folder;
            const bool choice = std::find(key.choices.begin(), key.choices.end(), "auto") != key.choices.end();
            CHECK(fault.empty() == (text || choice));
            continue;
        }
        automatic_keys.push_back(key.name);
        CHECK_THAT(fault, Equals(""));
        CHECK(toml_value(default_of(key)) == "\"auto\"");
        CHECK_THAT(range_text(key), Contains("auto or "));
        for (const std::string value : {"auto", "\"auto\"", "'auto'"}) {
            Job job;
            key.set(job, another_value(key));
            CHECK(automatic_key(job) != key.name);
            apply_setting(job, key.name + "=" + value);
            CHECK(same_settings(job, Job{}));
        }
        CHECK_THAT(set_error_of(key.name + "=automatic"), Contains("expected auto or "));
    }
    CHECK(automatic_keys == std::vector<std::string>{"displacement.scale", "camera.eye", "camera.target", "camera.up",
                                                     "camera.near_plane"});
    CHECK(automatic_key(Job{}) == "displacement.scale");
    Job set;
    for (const char* const setting : {"displacement.scale=1", "camera.eye=[1, 2, 3]", "camera.target=[0, 0, 0]",
                                      "camera.up=[0, 0, 1]", "camera.near_plane=0.1"}) {
        CHECK_FALSE(automatic_key(set).empty());
        apply_setting(set, setting);
    }
    CHECK(automatic_key(set).empty());
}

TEST_CASE("the map's range is full, data or two values") {
    CHECK(Job{}.map.range.kind == MapRange::Kind::full);
    CHECK(parse_job("map.range = \"data\"", "a").map.range.kind == MapRange::Kind::data);
    CHECK(parse_job("map.range = \"full\"", "a").map.range.kind == MapRange::Kind::full);
    Job job = parse_job("map.range = [-1.5, 2478]", "a");
    CHECK(job.map.range.kind == MapRange::Kind::given);
    CHECK(job.map.range.low == -1.5);
    CHECK(job.map.range.high == 2478);
    apply_setting(job, "map.range=data");
    CHECK(job.map.range.kind == MapRange::Kind::data);
    apply_setting(job, "map.range=[3, 4]");
    CHECK(job.map.range.low == 3);
    CHECK_THAT(set_error_of("map.range=[2, 2]"), Contains("a low end that is not below its high end"));
    CHECK_THAT(set_error_of("map.range=[1, nan]"), Contains("not a finite number"));
    CHECK_THAT(set_error_of("map.range=[1, 2, 3]"), Contains("or two numbers"));
    CHECK_THAT(set_error_of("map.range=\"dat\""), Contains("did you mean \"data\"?"));
    CHECK_THAT(set_error_of("map.range=1"), Contains("one of full, data, or two numbers"));
    apply_setting(job, "hardware.displacement_filter=bilinear");
    CHECK(job.hardware.displacement_filter == MapFilter::bilinear);
    CHECK_THAT(set_error_of("hardware.displacement_filter=bilinaer"), Contains("did you mean \"bilinear\"?"));
}

TEST_CASE("the values of missing data are one number or a list") {
    CHECK(Job{}.map.no_data.empty());
    CHECK(parse_job("map.no_data = -9999", "a").map.no_data == std::vector<double>{-9999});
    Job job = parse_job("map.no_data = [-3.4e38, 1e+20, 65535]", "a");
    CHECK(job.map.no_data == std::vector<double>{-3.4e38, 1e20, 65535});
    apply_setting(job, "map.no_data=-32767.0");
    CHECK(job.map.no_data == std::vector<double>{-32767});
    apply_setting(job, "map.no_data=[]");
    CHECK(job.map.no_data.empty());
    CHECK_THAT(set_error_of("map.no_data=nan"), Contains("has a number that is not finite"));
    CHECK_THAT(set_error_of("map.no_data=[1, -inf]"), Contains("has a number that is not finite"));
    CHECK_THAT(set_error_of("map.no_data=none"), Contains("expected a number, or [up to 16 numbers]"));
    CHECK_THAT(set_error_of("map.no_data=[1, \"2\"]"), Contains("expected a number, or [up to 16 numbers]"));
    CHECK_THAT(set_error_of("map.no_data=[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16]"),
               Contains("has 17 numbers; the limit is 16"));
}

TEST_CASE("a file named without a source is an OBJ file, or an image") {
    const Job job = parse_job("[mesh]\nfile = \"a.obj\"\n[map]\nfile = \"b.png\"\n", "a");
    CHECK(job.mesh.source == MeshSource::file);
    CHECK(job.map.source == MapSource::file);
    Job set;
    apply_setting(set, "mesh.file=a.obj");
    apply_setting(set, "map.file=b.png");
    CHECK(set.mesh.source == MeshSource::file);
    CHECK(set.map.source == MapSource::file);
    CHECK(parse_job("[mesh]\nfile = \"a\"\nsource = \"run\"", "a").mesh.source == MeshSource::run);
    CHECK(parse_job("[mesh]\nfile = \"a.txt\"\nsource = \"sphere\"", "a").mesh.source == MeshSource::sphere);
    CHECK(parse_job("[mesh]\nfile = \"\"", "a").mesh.source == MeshSource::plane);
    Job run;
    apply_setting(run, "mesh.source=run");
    apply_setting(run, "mesh.file=a");
    CHECK(run.mesh.source == MeshSource::run);
}

TEST_CASE("every choice reads and keeps its name") {
    for (const Key& key : all_keys()) {
        for (const std::string_view choice : key.choices) {
            INFO(key.name << " = " << choice);
            Job job;
            apply_setting(job, key.name + "=" + std::string(choice));
            CHECK(std::get<std::string>(key.get(job)) == choice);
        }
    }
    CHECK(names_of<MapSource>().size() == 6);
    CHECK(name_of(parse_job("map.source = \"ramp\"", "job.toml").map.source) == "ramp");
}

TEST_CASE("integers are accepted by keys that take numbers") {
    const Job job = parse_job("[displacement]\nscale = 2\n[camera]\neye = [1, -2, 3.5]\n", "job.toml");
    CHECK(job.displacement.scale == 2.0);
    CHECK(job.camera.eye == std::array<double, 3>{1, -2, 3.5});
}

TEST_CASE("numbers print in their shortest form and read back exactly") {
    CHECK(toml_number(2) == "2.0");
    CHECK(toml_number(-0.0) == "-0.0");
    CHECK(toml_number(0.1) == "0.1");
    CHECK(toml_number(1e300) == "1e+300");
    CHECK(toml_number(1.0 / 3) == "0.3333333333333333");
    for (const double value : {-0.0, 5e-324, 2.2250738585072014e-308, 0.1 + 0.2, 1e6, -1e6, 123456.789e-300}) {
        const Job job = parse_job("displacement.bias = " + toml_number(value), "job.toml");
        CHECK(std::memcmp(&job.displacement.bias, &value, sizeof value) == 0);
    }
}

TEST_CASE("random jobs round-trip") {
    rc::prop("dump, read, dump", [] {
        Job job;
        for (const Key& key : all_keys())
            set_value(job, key, random_value(key));
        const std::string dump = dump_job(job);
        const Job again = parse_job(dump, "dump.toml");
        RC_ASSERT(same_settings(again, job));
        RC_ASSERT(dump_job(again) == dump);
    });
    rc::prop("any double within the range of displacement.bias", [] {
        Job job;
        job.displacement.bias = random_number({-1e6, 1e6, false});
        RC_ASSERT(same_settings(parse_job(dump_job(job), "dump.toml"), job));
    });
}

TEST_CASE("settings of the command line set their keys or are refused") {
    Job job;
    apply_setting(job, "mesh.columns=7");
    apply_setting(job, " map.source = noise ");
    apply_setting(job, "map.address_u=\"repeat\"");
    apply_setting(job, "map.text=two words = one text");
    apply_setting(job, "map.channel='R'");
    apply_setting(job, "camera.eye=[1, 2.5, -3]");
    apply_setting(job, "displacement.scale=-1");
    apply_setting(job, "tests.normal=false");
    CHECK(job.mesh.columns == 7);
    CHECK(job.map.source == MapSource::noise);
    CHECK(job.map.address_u == Addressing::repeat);
    CHECK(job.map.text == "two words = one text");
    CHECK(job.map.channel == "R");
    CHECK(job.camera.eye == std::array<double, 3>{1, 2.5, -3});
    CHECK(job.displacement.scale == -1);
    CHECK_FALSE(job.tests.normal);
    apply_setting(job, "map.text=42");
    CHECK(job.map.text == "42");
    apply_setting(job, "map.text=");
    CHECK(job.map.text.empty());

    CHECK_THAT(set_error_of("mesh.colums=3"),
               Equals("--set mesh.colums=3: unknown key `mesh.colums`; did you mean `mesh.columns`?"));
    CHECK_THAT(set_error_of("mesh.columns=-1"), Contains("out of range; the range is 0 .. 2048 quads"));
    CHECK_THAT(set_error_of("mesh.columns=9223372036854775808"), Contains("`mesh.columns`"));
    CHECK_THAT(set_error_of("mesh.columns=three"), Contains("`mesh.columns` cannot be three; expected an integer"));
    CHECK_THAT(set_error_of("mesh.columns="), Contains("has no value"));
    CHECK_THAT(set_error_of("mesh.columns"), Contains("expected table.key=value"));
    CHECK_THAT(set_error_of("=3"), Contains("unknown key"));
    CHECK_THAT(set_error_of(""), Contains("expected table.key=value"));
    CHECK_THAT(set_error_of("mesh=3"), Contains("`mesh` is a group of keys"));
    CHECK_THAT(set_error_of("camera={eye=[1,2,3]}"), Contains("`camera` is a group of keys") &&
                                                         Contains("as in --set camera.eye=") &&
                                                         Contains("eye, target, up, "));
    CHECK_THAT(set_error_of("mesh.columns=3\n[map]"), Contains("one --set sets one key"));
    CHECK_THAT(set_error_of("mesh.columns=3\nvalue=4"), Contains("--set"));
    CHECK_THAT(set_error_of("map.text=\"open"), Contains("`map.text` cannot be"));
    CHECK_THAT(set_error_of("map.text=\xff\xfe"), Contains("is not UTF-8"));
    CHECK_THAT(set_error_of("map.source=donut"), Contains("the choices are half_donut"));
    CHECK_THAT(set_error_of("displacement.scale=nan"), Contains("not a finite number"));
    CHECK_THAT(set_error_of("mesh.columns=a" + std::string(1000000, '.')), Contains("dots in one line"));
    CHECK_THAT(set_error_of("mesh.columns=" + std::string(1000000, '[')), Contains("cannot be [[["));

    const Job before = job;
    CHECK_THROWS_AS(apply_setting(job, "mesh.columns=-1"), InputError);
    CHECK(same_settings(job, before));
}

TEST_CASE("paths are resolved from the job's folder or the data folder") {
    Job job;
    job.folder = "jobs";
    const auto resolve = [&](const std::string& mesh, const std::string& map) {
        job.mesh.file = mesh;
        job.map.file = map;
        resolve_paths(job, "/data");
        return std::pair(job.mesh.path, job.map.path);
    };
    using Paths = std::pair<fs::path, fs::path>;
    CHECK(resolve("a/b.obj", "/a/b.png") == Paths("jobs/a/b.obj", "/a/b.png"));
    CHECK(resolve("data:a/b.obj", "data:b.png") == Paths("/data/a/b.obj", "/data/b.png"));
    CHECK(resolve("", "") == Paths("", ""));
    for (const std::string text : {"data:", "data:/etc/passwd", "data:../x", "data:a/../../x"}) {
        CHECK_THROWS_AS(resolve(text, ""), InputError);
        CHECK_THROWS_AS(resolve("", text), InputError);
    }
    job.folder = "";
    CHECK(resolve("b.obj", "") == Paths("b.obj", ""));
    CHECK(rebase_path("a/b.obj", "jobs", "runs/one") == "../../jobs/a/b.obj");
    CHECK(rebase_path("../b.obj", "jobs", "runs/one") == "../../b.obj");
    CHECK(rebase_path("data:b.obj", "jobs", "runs/one") == "data:b.obj");
    CHECK(rebase_path("/b.obj", "jobs", "runs/one") == "/b.obj");
    CHECK(rebase_path("", "jobs", "runs/one").empty());
    CHECK(rebase_path("./a.obj", "jobs", "./jobs") == "./a.obj");
}

TEST_CASE("a job dumped into a run folder runs again from there") {
    const TestFolder root;
    root.write("jobs/meshes/head.obj", "mesh");
    root.write("runs/one/x", "");
    root.write("runs/two/deep/x", "");
    const fs::path file = root.write("jobs/head.toml",
                                     "mesh.source = \"file\"\nmesh.file = \"meshes/head.obj\"\n"
                                     "map.source = \"file\"\nmap.file = \"data:head.exr\"\n");
    const auto mesh_path = [](Job of) {
        resolve_paths(of, "data");
        return of.mesh.path;
    };
    const Job job = read_job(file);
    CHECK(job.mesh.file == "meshes/head.obj");
    CHECK(fs::exists(mesh_path(job)));
    CHECK_THAT(dump_job(job), Contains("file = \"meshes/head.obj\""));

    const std::string dump = dump_job(job, root.path() / "runs/one");
    CHECK_THAT(dump, Contains("file = \"../../jobs/meshes/head.obj\"") && Contains("file = \"data:head.exr\""));
    const Job again = read_job(root.write("runs/one/job.toml", dump));
    CHECK(fs::exists(mesh_path(again)));
    CHECK(dump_job(again, root.path() / "runs/one") == dump);
    CHECK_THAT(dump_job(again, root.path() / "runs/two/deep"), Contains("\"../../../jobs/meshes/head.obj\""));

    // Through a link, `..` leads out of the link's target.
    fs::create_directories(root.path() / "disk/a/b/c");
    fs::create_directory_symlink(root.path() / "disk/a/b/c", root.path() / "runs/link");
    const Job linked = read_job(root.write("runs/link/job.toml", dump_job(job, root.path() / "runs/link")));
    CHECK(fs::exists(mesh_path(linked)));

    // --set comes from the current directory.
    Job set = job;
    apply_setting(set, "mesh.file=here.obj");
    CHECK(fs::weakly_canonical(mesh_path(set)) == fs::weakly_canonical(fs::current_path() / "here.obj"));
    apply_setting(set, "output.folder=runs/x");
    CHECK(set.output.folder == "runs/x");
    apply_setting(set, "mesh.file=");
    CHECK(set.mesh.file.empty());
}

TEST_CASE("the key reference names every key, and testbench/job/README.md ends with it") {
    const std::string text = document_keys(), page = summarise_keys();
    for (const Key& key : all_keys()) {
        INFO(key.name);
        CHECK_THAT(text, Contains("| `" + key.name + "` |") && Contains("| " + key.description + " |\n"));
    }
    std::size_t own_rows = 0, shared = 0, owners = 0;
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        const std::string names = line.substr(0, line.find(" | ", 1));
        if (names.rfind("| `*_", 0) == 0) {
            if (names.find(": likewise") == std::string::npos)
                owners = static_cast<std::size_t>(std::count(names.begin(), names.end(), '`')) / 2 - 1;
            shared += owners;
        } else if (names.rfind("| `", 0) == 0) {
            ++own_rows;
        }
    }
    CHECK(own_rows + shared == all_keys().size());
    CHECK(shared > 60);
    expect_section("testbench/job/README.md", "`tessera keys` prints a row for each key.\n\n", page);
}

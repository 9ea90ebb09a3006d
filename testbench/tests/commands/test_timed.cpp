#include <catch2/catch.hpp>
#include <regex>
#include <string>
#include <utility>
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
const Arguments unchecked{"check.golden=false", "check.end_to_end=false", "check.invariants=false",
                          "check.work=false",   "output.picture=false",   "output.ply=false"};

}  // namespace

// Designs that differ in what limits them; those of `none` are bound by latency, or by units that tie.
TEST_CASE("timed run: twice the key that the bottleneck names takes fewer cycles") {
    const TestFolder here;
    const auto none = [](const Arguments& settings) { return std::pair{settings, std::string{}}; };
    const auto ports = [](const Arguments& settings, const std::string& table) {
        return std::pair{settings, "timing." + table + "_ports"};
    };
    const Arguments banks{"timing.summed_height_table_banks=8", "timing.summed_height_table_interleave=xor"};
    for (const auto& [settings, key] : std::vector<std::pair<Arguments, std::string>>{
             ports({}, "summed_height_table"),
             ports({"hardware.tests_units=3"}, "summed_height_table"),
             ports({"timing.summed_height_table_ports=3"}, "summed_height_table"),
             ports(banks, "summed_height_table"),
             none(banks + Arguments{"hardware.test_order=cheap_first"}),
             ports({"hardware.test_order=cheap_first", "hardware.final_edges=true"}, "summed_height_table"),
             ports({"timing.summed_height_table_cache_bytes=16384"}, "summed_height_table"),
             ports({"hardware.queue_capacity=8", "hardware.queue_order=lifo"}, "summed_height_table"),
             ports({"hardware.height_test=mipmap"}, "height_table"),
             none({"hardware.design=modern", "timing.normal_map_ports=1"}),
             ports({"timing.summed_height_table_ports=16", "timing.displacement_map_width=1",
                    "hardware.displacement_filter=bilinear"},
                   "displacement_map"),
             {{"hardware.design=modern"}, "hardware.normal_tests"},
             {{"timing.off_chip_bandwidth=1", "hardware.queue_capacity=4"}, "timing.off_chip_bandwidth"},
             {{"timing.off_chip_bandwidth=1", "timing.summed_height_table_cache_bytes=256"},
              "timing.off_chip_bandwidth"},
             none({"timing.summed_height_table_ports=16"}),
             none({"timing.summed_height_table_ports=8"}),
             none({"timing.normal_map_latency=80"}),
             none({"timing.transform_interval=20"}),
             none({"timing.summed_height_table_cache_bytes=256", "timing.summed_height_table_ports=4"}),
             none({"hardware.height_test=curvature"}),
             none({"hardware.design=modern", "hardware.machines=8"})}) {
        const auto run = [&, &its = settings](const Arguments& more) {
            succeed(timed_run("out", unchecked + its + more), here.path());
            return RunFolder(here.path() / "out");
        };
        const RunFolder once = run({});
        const std::string text = once.statistics["timing"]["bottleneck_in_words"]["value"];
        INFO(text);
        std::smatch named;
        const bool names_one = std::regex_search(text, named, std::regex(R"(((hardware|timing)\.\w+))"));
        CHECK((names_one ? named[1].str() : std::string{}) == key);
        if (!names_one)
            continue;
        const std::string dumped = succeed(Arguments{"run", "--dump-config"} + set(settings), here.path()).out;
        std::smatch found;
        const std::string leaf = key.substr(key.find('.') + 1);
        REQUIRE(std::regex_search(dumped, found, std::regex("\n" + leaf + R"( = (\d+))")));
        const RunFolder twice = run({key + "=" + std::to_string(2 * std::stoul(found[1]))});
        CHECK(twice.count("timing", "cycles") < once.count("timing", "cycles"));
    }
}

// Each value that a note names is set, and is then built as it is: no note, and the same cycles and area, or a larger
// cache.
TEST_CASE("timed run: a size that is rounded is noted with sizes that are not, and these have no note") {
    const TestFolder here;
    const auto run = [&](const Arguments& settings) {
        const ProgramEnd end = succeed(timed_run("out", unchecked + small + settings), here.path());
        std::vector<std::string> notes;
        for (const std::string& line : lines_of(end.out))
            if (line.rfind("  note: timing.", 0) == 0 || line.rfind("  note: hardware.", 0) == 0)
                notes.push_back(line);
        return std::pair{notes, RunFolder(here.path() / "out")};
    };
    const auto settings_in = [](const std::string& text) {
        Arguments settings;
        const std::regex setting(R"((timing\.\w+) = (\d+))");
        for (std::sregex_iterator it(text.begin(), text.end(), setting), end; it != end; ++it)
            settings.push_back((*it)[1].str() + "=" + (*it)[2].str());
        return settings;
    };
    const std::string sums = "timing.summed_height_table_", normals = "timing.normal_map_";
    for (const Arguments& settings : std::vector<Arguments>{{sums + "cache_bytes=320"},
                                                            {sums + "cache_bytes=448"},
                                                            {sums + "cache_bytes=1000"},
                                                            {sums + "cache_bytes=1"},
                                                            {sums + "cache_bytes=200", sums + "cache_ways=64"},
                                                            {sums + "cache_bytes=1024", sums + "line_bytes=30"},
                                                            {sums + "cache_bytes=1073741824"},
                                                            {normals + "cache_bytes=4096"},
                                                            {normals + "cache_bytes=600", normals + "line_bytes=60"},
                                                            {"timing.displacement_map_cache_bytes=100"},
                                                            {sums + "width=3"},
                                                            {sums + "width=64"},
                                                            {normals + "width=5"}}) {
        CAPTURE(settings);
        const auto [notes, rounded] = run(settings);
        REQUIRE(notes.size() == 1);
        INFO(notes[0]);
        const std::size_t larger = notes[0].find("; the next larger: "), same = notes[0].find("; the same: ");
        const std::size_t builds = notes[0].rfind("timing.");
        const std::string advice = same != std::string::npos
                                       ? notes[0].substr(same, larger == std::string::npos ? larger : larger - same)
                                       : notes[0].substr(builds);
        const auto [no_notes, exact] = run(settings + settings_in(advice));
        CHECK(no_notes.empty());
        CHECK(exact.count("timing", "cycles") == rounded.count("timing", "cycles"));
        CHECK(exact.count("area", "total_memory_bits") == rounded.count("area", "total_memory_bits"));
        if (larger == std::string::npos)
            continue;
        const auto [none, next] = run(settings + settings_in(notes[0].substr(larger)));
        CHECK(none.empty());
        CHECK(next.count("area", "total_memory_bits") > rounded.count("area", "total_memory_bits"));
    }
}

TEST_CASE("timed run: where caches share the off-chip channel, more bandwidth helps no more than the bound says") {
    const TestFolder here;
    const auto run = [&](const std::string& bandwidth) {
        succeed(
            timed_run("out", unchecked + small +
                                 Arguments{"timing.summed_height_table_cache_bytes=64",
                                           "timing.normal_map_cache_bytes=64", "timing.displacement_map_cache_bytes=64",
                                           "timing.off_chip_latency=0", "timing.off_chip_bandwidth=" + bandwidth}),
            here.path());
        return RunFolder(here.path() / "out");
    };
    const RunFolder narrow = run("1"), wide = run("64");
    const double bound = narrow.statistics["timing"]["bottleneck_bound"]["value"].get<double>();
    const double faster =
        static_cast<double>(narrow.count("timing", "cycles")) / static_cast<double>(wide.count("timing", "cycles"));
    CHECK_THAT(narrow.statistics["timing"]["bottleneck_in_words"]["value"].get<std::string>(),
               Contains("off_chip_memory") && Contains("a larger timing.off_chip_bandwidth helps"));
    CHECK(faster > 3);
    CHECK(faster <= bound);
}

TEST_CASE("a key of timed mode is noted in functional mode, and machines without a base triangle") {
    const TestFolder here;
    const std::string text =
        succeed(Arguments{"run", "--set", "output.folder=out"} +
                    set(unchecked + small +
                        Arguments{"mode=functional", "timing.summed_height_table_ports=4", "hardware.queue_capacity=4",
                                  "hardware.machines=3", "mesh.columns=1", "mesh.rows=1"}),
                here.path())
            .out;
    for (const char* const key : {"timing.summed_height_table_ports = 4", "hardware.queue_capacity = 4"})
        CHECK_THAT(text, Contains(std::string("note: ") + key + " has no effect: mode = \"functional\""));
    CHECK_THAT(text, Contains("triangles waiting, ") && Contains("; one after another: timed mode has the machine's"));
    CHECK_THAT(text, Contains("note: hardware.machines = 3: only 2 work, since the base mesh has 2 triangles"));
}

TEST_CASE("timed run: a key without effect in the design is noted, and has none") {
    const TestFolder here;
    const auto run = [&](const Arguments& settings) {
        const ProgramEnd end = succeed(timed_run("out", unchecked + small + settings), here.path());
        return std::pair{end.out, RunFolder(here.path() / "out").statistics.dump()};
    };
    const auto without_effect = [&](const Arguments& design, const std::string& key, const std::string& value) {
        INFO(key << " " << value);
        const auto [plain_text, plain] = run(design);
        CHECK_THAT(plain_text, !Contains("has no effect"));
        const auto [text, figures] = run(design + Arguments{key + "=" + value});
        CHECK_THAT(text, Contains("note: " + key + " = " + value + " has no effect: "));
        CHECK(figures == plain);
    };
    without_effect({}, "timing.height_table_ports", "2");
    without_effect({"hardware.height_test=mipmap"}, "timing.summed_height_table_ports", "2");
    without_effect({}, "timing.normal_map_cache_ways", "8");
    without_effect({}, "timing.summed_height_table_line_bytes", "128");
    without_effect({}, "timing.off_chip_bandwidth", "1");
    without_effect({}, "timing.edges_in_sequence", "8");
    without_effect({}, "timing.highlight_test_latency", "7");
    without_effect({}, "timing.stalls_seed", "5");
    without_effect({}, "hardware.off_chip_triangles", "5");
    without_effect({}, "tests.rank_threshold", "0.2");
    without_effect({}, "timing.summed_height_table_interleave", "\"xor\"");
    without_effect({}, "formats.rank_bits", "7");
    without_effect({}, "mesh.spacing", "32");
    without_effect({}, "mesh.radius", "3.0");
    without_effect({"mesh.source=sphere"}, "mesh.width", "3.0");
    without_effect({"mesh.source=lattice"}, "mesh.columns", "5");
    without_effect({}, "map.seed", "7");
    write_all(here.path() / "map.pgm", "P2 4 4 9\n0 9 5 1\n1 2 3 1\n8 2 3 1\n4 2 9 0\n");
    CHECK_THAT(run({"map.file=map.pgm", "map.heights=fitted"}).first,
               !Contains("map.heights = \"fitted\" has no effect: map.source"));
    without_effect({"map.source=noise"}, "map.text", "\"other\"");
    without_effect({}, "map.channel", "\"R\"");
    without_effect({}, "output.trace_from", "5");
    without_effect({}, "hardware.direct_memory", "false");
    without_effect({}, "tests.highlight_angle", "60.0");
    without_effect({"tests.view=false"}, "tests.view_threshold", "9.0");
    without_effect({"mode=functional", "hardware.height_test=curvature"}, "tests.summed_height_unit", "\"area\"");
    without_effect({"hardware.height_test=mipmap", "tests.summed_height=false"}, "tests.mipmap_threshold", "0.5");
    without_effect({"hardware.height_test=rank", "formats.rank_bits=0", "formats.bound_bits=8"}, "tests.rank_threshold",
                   "0.2");
    without_effect({"hardware.design=modern", "hardware.height_test=rank", "mesh.source=lattice", "mesh.spacing=16"},
                   "timing.summed_height_table_latency", "3");
}

// What a report of a deadlock says: modules/test_deadlock.cpp.
TEST_CASE("timed run: a deadlock, no progress within the bound and a full queue end with their exit codes") {
    const TestFolder here;
    struct Row {
        Arguments settings;
        int exit_code;
        std::string says;
    };
    const Arguments queue{"hardware.queue_capacity=8"},
        memory{"hardware.queue_capacity=2", "hardware.off_chip_triangles=5"};
    const std::string full = "hardware.off_chip_triangles = 5";
    for (const Row& row : {Row{queue + Arguments{"hardware.queue_overflow=stall"}, 3, "tessera: deadlock: "},
                           {{"limits.cycles_without_progress=10"}, 3, "limits.cycles_without_progress = 10"},
                           {queue + Arguments{"hardware.queue_overflow=error"}, 4, "hardware.queue_capacity = 8"},
                           {memory + Arguments{"hardware.queue_order=fifo"}, 4, full},
                           {memory + Arguments{"hardware.queue_order=lifo"}, 4, full}}) {
        const ProgramEnd end = run_tessera(timed_run("out", row.settings), here.path());
        INFO(end.text());
        CHECK(end.exit_code == row.exit_code);
        CHECK_THAT(end.err, Contains(row.says));
        CHECK((end.exit_code == 3 || here.names().empty()));
        fs::remove_all(here.path() / "out");
    }
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

TEST_CASE("timed run: a window or units to trace without a trace are refused") {
    const TestFolder here;
    for (const std::vector<std::string>& option :
         std::vector<std::vector<std::string>>{{"--trace", "5:50"}, {"--trace-units", "queue"}})
        refused(timed_run("out", {}) + option, here.path(), {option[0], "--vcd"});
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

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "modules/datapath/rank_view.h"
#include "modules/unit_numbers.h"
#include "testbench/output/trace/recorder.h"
#include "testbench/tests/output/trace/vcd_file.h"
#include "testbench/tests/support/expect_section.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;
using Catch::Contains;
using tessera::testing::expect_section;
namespace fs = std::filesystem;

namespace {

fs::path waveforms() {
    return source_folder() / "waveforms";
}

std::vector<fs::path> files_ending_in(const std::string& extension) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(waveforms()))
        if (entry.path().extension() == extension)
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// The entries of a translate filter: number to text, without colours.
std::map<unsigned, std::string> read_filter(const std::string& name) {
    std::map<unsigned, std::string> names;
    for (const std::string& line : lines_of(read_all(waveforms() / name))) {
        if (line[0] == '#')
            continue;
        std::smatch parts;
        INFO(name << ": " << line);
        REQUIRE(std::regex_match(line, parts, std::regex("([0-9A-F]+) (\\?[a-z0-9 ]+\\?)?(.+)")));
        CHECK(names.emplace(std::stoul(parts[1], nullptr, 16), parts[3]).second);
    }
    return names;
}

/// The signals a save file shows: name and bits.
std::vector<std::pair<std::string, unsigned>> signals_in(const fs::path& save_file) {
    std::vector<std::pair<std::string, unsigned>> signals;
    const std::regex signal("(?:\\+\\{[^}]*\\} )?(tessera\\.[\\w.]+)(?:\\[(\\d+):0\\])?");
    for (const std::string& line : lines_of(read_all(save_file))) {
        std::smatch parts;
        if (std::regex_match(line, parts, signal))
            signals.emplace_back(parts[1], parts[2].matched ? std::stoul(parts[2]) + 1 : 1);
        else
            CHECK_THAT(line, !Contains("tessera."));
    }
    return signals;
}

}  // namespace

TEST_CASE("every signal of a save file is in the default job's waveforms and changes, except thresholds") {
    const TestFolder here;
    const auto traced = [&](const std::string& design) {
        const std::string folder = design.substr(design.find('=') + 1);
        succeed(Arguments{"run", "--vcd"} +
                    set({"output.folder=" + folder, "check.golden=false", "check.end_to_end=false",
                         "output.picture=false", "tests.normal_threshold=0.125", "tests.view_threshold=5",
                         "tests.generation_limit=7", "hardware." + design}),
                here.path());
        return VcdFile(here.path() / folder / "trace.vcd");
    };
    const VcdFile paper = traced("design=paper"), cheap_first = traced("test_order=cheap_first"),
                  modern = traced("design=modern");
    const std::vector<fs::path> views = files_ending_in(".gtkw");
    std::set<std::string> names;
    // Thresholds whose registers are exact: with 14 fraction bits, and with 8.
    const std::map<std::string, std::uint64_t> constant{
        {"tessera.tessellation_tests_0.normal_test.threshold", (1u << 14) / 8},
        {"tessera.tessellation_tests_0.view_test.threshold", 5 << 8},
        {"tessera.tessellation_tests_0.tex_coord_test.generation_limit", 7}};
    std::size_t constants = 0;
    for (const fs::path& view : views) {
        INFO(view);
        names.insert(view.stem());
        const VcdFile& vcd = view.stem() == "sequence" ? cheap_first : view.stem() == "families" ? modern : paper;
        const auto signals = signals_in(view);
        CHECK(signals.size() >= 20);
        for (const auto& [name, bits] : signals) {
            INFO(name);
            CHECK(vcd[name].bits == bits);
            if (constant.count(name) == 0) {
                CHECK_FALSE(vcd[name].changes.empty());
                continue;
            }
            CHECK(vcd[name].changes.empty());
            CHECK(vcd[name].initial == constant.at(name));
            ++constants;
        }
    }
    CHECK(names == std::set<std::string>{"families", "memories", "overview", "queue", "sequence", "tests"});
    CHECK(constants == 2 * constant.size());
}

TEST_CASE("save files depend on no machine and on no other files except filters") {
    const std::regex filter("\\^\\d+ (\\S+)");
    for (const fs::path& view : files_ending_in(".gtkw")) {
        std::set<std::string> filters;
        for (const std::string& line : lines_of(read_all(view))) {
            INFO(view << ": " << line);
            CHECK(line.find('/') == std::string::npos);
            CHECK(line.find('\\') == std::string::npos);
            CHECK(line.rfind("[dumpfile", 0) == std::string::npos);
            CHECK(line.rfind("[savefile", 0) == std::string::npos);
            std::smatch parts;
            if (std::regex_match(line, parts, filter)) {
                filters.insert(parts[1]);
                CHECK(fs::is_regular_file(waveforms() / parts[1].str()));
            }
        }
        CHECK(filters.count("states.txt") == 1);
    }
}

TEST_CASE("filters name every number as in the code") {
    const std::map<unsigned, std::string> state_names = read_filter("states.txt");
    REQUIRE(state_names.size() == states);
    CHECK(state_names ==
          std::map<unsigned, std::string>{{0, "starved"}, {1, "busy"}, {2, "waiting for memory"}, {3, "blocked"}});

    std::string units = fmt::format("{:02X} -\n", UnitNumbers::nobody);
    for (const UnitNumbers::Entry& entry : numbered_units()) {
        if (const std::string line = fmt::format("{:02X} {}\n", entry.number, entry.shown);
            units.find(line) == std::string::npos)  // a height test's number is that of all of them
            units += line;
        CHECK(entry.number < UnitNumbers::other);
    }
    units += fmt::format("{:02X} other\n", UnitNumbers::other);
    expect_section("waveforms/units.txt", "or Normal Test\n", units);

    const std::map<unsigned, std::string> parts = read_filter("parts.txt");
    CHECK(parts.size() == last_edge_part + 1);
    const auto check_parts = [&](Parts mask, const std::string& name) {
        for (unsigned part = 0; part <= last_edge_part; ++part) {
            if ((mask >> part & 1u) == 0)
                continue;
            const unsigned number = part < first_edge_part ? part % 3 : part - first_edge_part;
            CHECK(parts.at(part) == name + std::to_string(number));
        }
    };
    check_parts(vertex_parts, "vertex ");
    check_parts(normal_parts, "normal ");
    check_parts(edge_parts, "edge ");

    CHECK(read_filter("ways.txt") ==
          std::map<unsigned, std::string>{{0, "Tessellation"}, {1, "Lighting"}, {2, "culled"}});
}

TEST_CASE("every unit has its own number in any design") {
    const TestFolder here;
    std::map<std::string, std::size_t> units_of{{"design=paper", 18}, {"tests_units=3", 30}, {"design=modern", 24}};
    for (const datapath::HeightTestFunctions* const test : datapath::height_tests())
        units_of["height_test=" + std::string(test->name)] = test->second_side ? 19 : 18;
    for (const auto& [design, units] : units_of) {
        const ProgramEnd end = run_tessera({"run", "--vcd", "--trace-units", "no_such_unit", "--set",
                                            "hardware." + design, "--set", "output.folder=out"},
                                           here.path());
        INFO(end.text());
        REQUIRE(end.exit_code == 2);
        std::smatch found;
        REQUIRE(std::regex_search(end.err, found, std::regex("the units are (.*)")));
        std::set<std::string> numbered;
        for (const UnitNumbers::Entry& entry : numbered_units())
            numbered.insert(entry.name);
        const std::string list = found[1];
        const std::regex word("[\\w.]+");
        std::size_t count = 0;
        for (std::sregex_iterator it(list.begin(), list.end(), word); it != std::sregex_iterator(); ++it, ++count) {
            INFO(it->str());
            CHECK(numbered.count(it->str()) == 1);
        }
        CHECK(count == units);
    }
}

TEST_CASE("scripts/waves opens a run in a view, from the folder of the filters") {
    const TestFolder here;
    fs::create_directories(here.path() / "run");
    fs::create_directories(here.path() / "tools");
    write_all(here.path() / "run/trace.vcd", "");
    write_all(here.path() / "tools/gtkwave", "#!/bin/sh\npwd\nfor argument; do echo \"$argument\"; done\n");
    fs::permissions(here.path() / "tools/gtkwave", fs::perms::owner_all);
    const Environment environment{{"DISPLAY", ":0"},
                                  {"PATH", (here.path() / "tools").string() + ":" + std::getenv("PATH")}};
    const auto waves = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), (source_folder() / "scripts/waves").string());
        return run_program(arguments, here.path(), {}, environment);
    };
    const ProgramEnd opened = waves({"run", "queue"});
    INFO(opened.text());
    CHECK(opened.exit_code == 0);
    const std::vector<std::string> said = lines_of(opened.out);
    REQUIRE(said.size() > 3);
    CHECK(fs::equivalent(said.front(), waveforms()));
    CHECK(said.back() == "queue.gtkw");
    CHECK(said.at(said.size() - 2) == (here.path() / "run/trace.vcd").string());

    write_all(here.path() / "run/trace.fst", "");
    CHECK_THAT(waves({"run"}).out, Contains("run/trace.fst\noverview.gtkw\n"));
    for (const auto& [arguments, words] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{}, "run's folder"},
             {{"run", "quewe"}, "memories overview queue sequence tests"},
             {{"absent"}, "absent"},
             {{"tools"}, "--vcd"}}) {
        const ProgramEnd refused = waves(arguments);
        INFO(refused.text());
        CHECK(refused.exit_code == 2);
        CHECK_THAT(refused.err, Contains(words));
    }
}

TEST_CASE("waveforms show what the tests in place of the Summed Height Test compare") {
    using Value = std::function<std::int64_t(const char* signal)>;
    struct Row {
        std::string test;
        Arguments settings;
        const char* shown;
        std::function<bool(const Value&)> splits;
    };
    const Arguments lattice{"hardware.triangulation=greatest_rank", "mesh.source=lattice", "mesh.spacing=16",
                            "tests.normal=false"};
    const std::vector<Row> rows{
        {"curvature", {}, "measure", [](const Value& v) { return v("measure") > v("threshold"); }},
        {"mipmap", {}, "difference", [](const Value& v) { return v("difference") > v("threshold"); }},
        {"rank",
         lattice + Arguments{"tests.view=false", "tests.rank_threshold=0.05", "formats.bound_bits=8",
                             "tests.bound_threshold=0.02"},
         "rank", [](const Value& v) { return v("rank") > v("rank_threshold") || v("bound") > v("bound_threshold"); }},
        {"rank",
         lattice + Arguments{"hardware.design=modern", "tests.rank_view=per_pixel", "tests.rank_threshold=20",
                             "formats.rank_bits=10"},
         "rank", [](const Value& v) { return v("rank") != 0 && (v("rank") << 6) > v("rank_threshold") + v("level"); }},
    };
    const TestFolder here;
    for (const Row& row : rows) {
        succeed(Arguments{"run", "--vcd", "--trace", "0:20000", "--trace-units", row.test + "_test"} +
                    set(Arguments{"hardware.height_test=" + row.test, "output.folder=out", "output.picture=false"} +
                        row.settings),
                here.path());
        const VcdFile vcd(here.path() / "out/trace.vcd");
        const std::string unit = "tessera.tessellation_tests_0." + row.test + "_test.";
        std::size_t wrong = 0;
        std::set<bool> decisions;
        for (const auto& [time, value] : vcd[unit + row.shown].changes) {
            const bool splits = row.splits([&, at = time](const char* signal) {
                const VcdFile::Signal& its = vcd[unit + signal];
                const bool is_signed = its.bits == datapath::rank_limit_bits;  // as the viewer sees it
                const unsigned above = is_signed ? 64 - its.bits : 0;
                return static_cast<std::int64_t>(its.at(at) << above) >> above;
            });
            decisions.insert(splits);
            wrong += splits != (vcd[unit + "out.summed_height"].at(time) == 1);
        }
        INFO(row.test << ", " << row.settings.size() << " settings");
        CHECK(wrong == 0);
        CHECK(decisions.size() == 2);
    }
}

TEST_CASE("waveforms of a cache count its requests, hits and lines") {
    const TestFolder here;
    succeed(Arguments{"run", "--vcd", "--trace", "0:1000000", "--trace-units", "summed_height_table_cache"} +
                set({"tests.generation_limit=3", "timing.summed_height_table_cache_bytes=1024", "output.folder=out",
                     "output.picture=false"}),
            here.path());
    const VcdFile vcd(here.path() / "out/trace.vcd");
    const nlohmann::json statistics = nlohmann::json::parse(read_all(here.path() / "out/statistics.json"));
    const auto cache = [&](const char* name) -> const VcdFile::Signal& {
        return vcd["tessera.summed_height_table_cache." + std::string(name)];
    };
    const auto counted = [&](const std::string& group, const char* figure) {
        return statistics.at(group).at(figure).at("value").get<std::uint64_t>();
    };
    CHECK(cache("requests").at(vcd.end) == counted("timing.summed_height_table_cache", "items"));
    CHECK(cache("hits").at(vcd.end) == counted("summed_height_table", "cache_hits"));
    CHECK(cache("fills").at(vcd.end) == counted("summed_height_table", "cache_fills"));
    CHECK(cache("lines_to_come").at(vcd.end) == 0);
    CHECK(cache("lines_to_come").changes.size() > cache("fills").changes.size());
}

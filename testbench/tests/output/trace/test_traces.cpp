#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "testbench/tests/output/trace/vcd_file.h"
#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t period = 5;  // ns per cycle; the VCD's time unit is 1 ns

/// A timed run of a smaller half donut into the folder "out", with these additional arguments.
Arguments small_run(const Arguments& more) {
    return Arguments{"run", "--set", "tests.generation_limit=4", "--set", "output.folder=out"} + more;
}

ProgramEnd run_small(const TestFolder& here, const Arguments& more) {
    return succeed(small_run(more), here.path());
}

nlohmann::json statistics_of(const TestFolder& here) {
    return nlohmann::json::parse(read_all(here.path() / "out/statistics.json"));
}

std::uint64_t count(const nlohmann::json& statistics, const std::string& group, const std::string& name) {
    return statistics.at(group).at(name).at("value").get<std::uint64_t>();
}

}  // namespace

TEST_CASE("tracing changes only its own files, and these are the same every time") {
    const TestFolder here;
    run_small(here, {});
    const std::map<std::string, std::string> plain = RunFolder(here.path() / "out").files();
    run_small(here, {"--vcd"});
    const std::map<std::string, std::string> traced = RunFolder(here.path() / "out").files();
    run_small(here, {"--vcd"});
    require_same_files(traced, RunFolder(here.path() / "out").files());
    CHECK(traced.size() == plain.size() + 1);
    for (const auto& [name, content] : plain) {
        INFO(name);
        if (name != "job.toml")  // which says that traces were asked for
            CHECK((content == traced.at(name)));
    }
    run_small(here, {});
    CHECK_FALSE(fs::exists(here.path() / "out/trace.vcd"));
    require_same_files(plain, RunFolder(here.path() / "out").files());
}

TEST_CASE("a window shows its cycles with their values in the whole run") {
    const TestFolder here;
    // Also with random stalls, and with three Tessellation Tests units.
    const auto design =
        GENERATE(std::vector<std::string>{},
                 std::vector<std::string>{"--set", "timing.stalls_per_mille=200", "--set", "hardware.tests_units=3"});
    const auto trace = [&](std::vector<std::string> arguments) {
        const ProgramEnd end = run_small(here, arguments + design);
        CHECK_THAT(end.out, Contains("trace.vcd"));
        return VcdFile(here.path() / "out/trace.vcd");
    };
    const VcdFile whole = trace({"--vcd", "--trace", "0:1000000"});
    const std::uint64_t cycles = count(statistics_of(here), "timing", "cycles");
    CHECK(whole.begin == 0);
    CHECK(whole.end == cycles * period);
    for (const auto& [first, last] : std::vector<std::pair<std::uint64_t, std::uint64_t>>{
             {0, 0}, {100, 100}, {1000, 1500}, {1001, 1007}, {cycles - 50, cycles + 50}}) {
        INFO(first << " to " << last);
        const VcdFile part = trace({"--vcd", "--trace", std::to_string(first) + ":" + std::to_string(last)});
        CHECK(part.begin == first * period);
        CHECK(part.end == std::min(last + 1, cycles) * period);
        REQUIRE(part.signals.size() == whole.signals.size());
        for (const auto& [name, signal] : part.signals) {
            INFO(name);
            const VcdFile::Signal& its = whole[name];
            // Operands from before the window are shown only while they are still in the unit.
            const bool operand = signal.initial != its.at(first * period);
            std::vector<std::pair<std::uint64_t, std::uint64_t>> expected;
            for (const auto& change : its.changes)
                if (change.first > first * period && change.first < (last + 1) * period)
                    expected.push_back(change);
            if (!operand) {
                CHECK(signal.changes == expected);
                continue;
            }
            CHECK(signal.initial == 0);
            for (const char* const exact :
                 {"state", "blocked_by", "occupancy", "valid", "ready", "stalled", "waiting", "level", "request",
                  "requests", "reads", "under_way", "served", "held_up", "threshold"})
                CHECK_FALSE(name.substr(name.rfind('.') + 1) == exact);
        }
    }
}

TEST_CASE("a window after the end of the run shows how the run ends") {
    const TestFolder here;
    const ProgramEnd end = run_small(here, {"--vcd", "--trace", "1000000:1000010"});
    CHECK_THAT(end.out, Contains("before cycle 1000000"));
    const VcdFile vcd(here.path() / "out/trace.vcd");
    CHECK(vcd.begin == vcd.end);
    CHECK(vcd["tessera.pass_or_tessellate.finished"].initial ==
          count(statistics_of(here), "run", "triangles_finished"));
}

TEST_CASE("waveforms and statistics have the same counts") {
    const TestFolder here;
    run_small(here, {"--vcd", "--trace", "0:1000000", "--set", "timing.summed_height_table_ports=4"});
    const VcdFile vcd(here.path() / "out/trace.vcd");
    const nlohmann::json statistics = statistics_of(here);
    const auto high = [&](const std::string& name) { return vcd["tessera." + name].high_cycles(period, vcd.end); };
    const auto cycles_in = [&](const std::string& unit, std::uint64_t state) {
        const VcdFile::Signal& signal = vcd["tessera." + unit + ".state"];
        VcdFile::Signal is{1, signal.initial == state, {}};
        for (const auto& [time, value] : signal.changes)
            is.changes.emplace_back(time, value == state);
        return is.high_cycles(period, vcd.end);
    };
    CHECK(high("triangle_queue.ready") == count(statistics, "triangle_queue", "taken"));
    CHECK(high("tessellation_tests_0.collect_tests.edge") == count(statistics, "run", "edges_tested"));
    CHECK(high("pass_or_tessellate.decided") ==
          count(statistics, "pass_or_tessellate", "passes") + count(statistics, "pass_or_tessellate", "normal_passes"));
    CHECK(high("calculate_new_p.ready") == count(statistics, "timing.calculate_new_p", "items"));
    CHECK(high("displace_vertex.request") == count(statistics, "displacement_map", "reads"));
    const char* const names[] = {"starved", "busy", "waiting_for_memory", "blocked"};
    for (const auto& [group, members] : statistics.items()) {
        if (group.rfind("timing.", 0) != 0 || !members.contains("busy"))
            continue;
        INFO(group);
        for (std::uint64_t state = 0; state < 4; ++state)
            CHECK(cycles_in(group.substr(7), state) == members.at(names[state]).at("value"));
    }
}

TEST_CASE("every read request is counted in the waveforms") {
    const TestFolder here;
    const std::string ports = GENERATE("1", "2", "4");
    const std::string banks = GENERATE("1", "2", "4");
    INFO(ports << " ports, " << banks << " banks");
    Arguments settings;
    for (const char* const table : {"displacement_map", "normal_map", "summed_height_table"}) {
        settings.push_back("timing." + std::string(table) + "_ports=" + ports);
        settings.push_back("timing." + std::string(table) + "_banks=" + banks);
    }
    run_small(here, Arguments{"--vcd", "--trace", "0:1000000"} + set(settings));
    const VcdFile vcd(here.path() / "out/trace.vcd");
    const nlohmann::json statistics = statistics_of(here);
    // The value a signal has counted to; each change is an increment by one, or by several in one cycle.
    const auto counted = [&](const std::string& name) {
        const VcdFile::Signal& signal = vcd["tessera." + name];
        std::uint64_t value = signal.initial;
        CHECK(value == 0);
        for (const auto& change : signal.changes)
            value += change.second > value ? change.second - value : UINT64_MAX / 2;
        return value;
    };
    for (const auto& [unit, memory] :
         {std::pair{"displace_vertex", "displacement_map"}, std::pair{"tessellation_tests_0.normal_test", "normal_map"},
          std::pair{"tessellation_tests_0.summed_height_test", "summed_height_table"}}) {
        const std::string its = unit, of_memory = memory;
        INFO(its);
        const std::uint64_t reads = count(statistics, of_memory, "reads");
        const std::uint64_t requests = counted(its + ".requests");
        CHECK(counted(its + ".reads") == reads);
        CHECK(counted(of_memory + ".reads") == reads);
        CHECK(counted(of_memory + ".requests") == requests);
        // A rectangle of the Summed Height Table is one request.
        CHECK(requests == (of_memory == "summed_height_table" ? 3 * count(statistics, "run", "edges_tested") : reads));
        CHECK(vcd["tessera." + its + ".requests"].changes.size() ==
              vcd["tessera." + its + ".request"].high_cycles(period, vcd.end));
    }
}

TEST_CASE("waveforms show the two operands that each test compares") {
    const TestFolder here;
    const std::string unit = GENERATE("sum", "area");
    run_small(here, {"--vcd", "--trace", "0:1000000", "--set", "tests.summed_height_unit=" + unit, "--set",
                     "tests.summed_height_threshold=" + std::string(unit == "sum" ? "1" : "0.01")});
    const VcdFile vcd(here.path() / "out/trace.vcd");
    const auto signal = [&](const std::string& test, const std::string& name) -> const VcdFile::Signal& {
        return vcd["tessera.tessellation_tests_0." + test + "." + name];
    };
    const auto sign_extended = [](std::uint64_t value, unsigned bits) {
        return static_cast<std::int64_t>(value << (64 - bits)) >> (64 - bits);
    };
    const auto distance = [](std::int64_t a, std::int64_t b) { return static_cast<std::uint64_t>(std::abs(a - b)); };
    std::uint64_t time = 0;
    const auto at = [&](const std::string& test, const std::string& name) {
        const VcdFile::Signal& its = signal(test, name);
        const bool is_signed = name.rfind("n_", 0) == 0 || name.rfind("screen_", 0) == 0;
        return is_signed ? sign_extended(its.at(time), its.bits) : static_cast<std::int64_t>(its.at(time));
    };
    std::set<bool> normal, summed_height, view, generation;
    for (const auto& change : signal("normal_test", "difference").changes) {
        time = change.first;
        std::uint64_t largest = 0;
        for (const char* const axis : {"x", "y", "z"}) {
            const std::int64_t middle = at("normal_test", std::string("n_ij_") + axis);
            for (const char* const end : {"n_i_", "n_j_"})
                largest = std::max(largest, distance(middle, at("normal_test", std::string(end) + axis)));
        }
        if (at("normal_test", "out.part") < 6) {
            CHECK(change.second == 0);
            continue;
        }
        CHECK(change.second == largest);
        const bool differs = change.second > signal("normal_test", "threshold").at(time);
        CHECK(differs == (at("normal_test", "out.normal") == 1));
        normal.insert(differs);
    }
    for (const auto& change : signal("summed_height_test", "difference").changes) {
        time = change.first;
        const char* const test = "summed_height_test";
        CHECK(change.second == distance(2 * at(test, "sum_ij"), at(test, "sum_i") + at(test, "sum_j")));
        const std::uint64_t limit = signal(test, "limit").at(time);
        const bool differs = change.second > limit;
        CHECK(differs == (at(test, "out.summed_height") == 1));
        summed_height.insert(differs);
        // The rectangle shown is that of the item started last; with the unit `area` its size changes the limit.
        CHECK((limit == signal(test, "threshold").at(time) || unit == "area"));
    }
    CHECK((signal("summed_height_test", "limit").changes.size() > 1) == (unit == "area"));
    for (const auto& change : signal("view_test", "length").changes) {
        time = change.first;
        CHECK(change.second == distance(at("view_test", "screen_i_x"), at("view_test", "screen_j_x")) +
                                   distance(at("view_test", "screen_i_y"), at("view_test", "screen_j_y")));
        const bool is_long = change.second > signal("view_test", "threshold").at(time);
        CHECK(is_long == (at("view_test", "out.view") == 1));
        view.insert(is_long);
    }
    for (const auto& change : signal("tex_coord_test", "generation_ij").changes) {
        time = change.first;
        CHECK(change.second == 1 + static_cast<std::uint64_t>(std::max(at("tex_coord_test", "in.generation_i"),
                                                                       at("tex_coord_test", "in.generation_j"))));
        const bool allowed = change.second <= signal("tex_coord_test", "generation_limit").at(time);
        CHECK(allowed == (at("tex_coord_test", "out.generation") == 1));
        generation.insert(allowed);
    }
    CHECK(normal.size() == 2);
    CHECK(summed_height.size() == 2);
    CHECK(view.size() + generation.size() >= 3);
}

TEST_CASE("waveforms of off-chip memory show the spills and refills of a queue of four triangles") {
    const TestFolder here;
    run_small(here, {"--vcd", "--trace", "0:1000000", "--set", "hardware.queue_capacity=4"});
    const VcdFile vcd(here.path() / "out/trace.vcd");
    const nlohmann::json statistics = statistics_of(here);
    const auto& of_memory = [&](const std::string& name) -> const VcdFile::Signal& {
        return vcd["tessera.off_chip_memory." + name];
    };
    const std::uint64_t bytes = count(statistics, "timing.triangle_queue", "spill_bytes");
    REQUIRE(bytes > 0);
    CHECK(of_memory("bytes_written").at(vcd.end) == bytes / 2);
    CHECK(of_memory("bytes_read").at(vcd.end) == bytes / 2);
    CHECK(of_memory("answers_due").at(vcd.end) == 0);
    CHECK(of_memory("served").high_cycles(period, vcd.end) ==
          2 * count(statistics, "timing.triangle_queue", "spilled"));
    CHECK(of_memory("write").changes.size() > 1);
    std::set<std::uint64_t> addresses;
    for (const auto& [time, address] : of_memory("address").changes)
        addresses.insert(address);
    CHECK(addresses.size() > 4);

    // A window that starts while the memory is in use starts with the request it served last.
    const std::uint64_t middle = of_memory("address").changes[addresses.size()].first / period + 1;
    run_small(here, {"--vcd", "--trace", std::to_string(middle) + ":1000000", "--set", "hardware.queue_capacity=4"});
    const VcdFile rest(here.path() / "out/trace.vcd");
    for (const char* name : {"address", "write", "bytes_written"})
        CHECK(rest["tessera.off_chip_memory." + std::string(name)].initial == of_memory(name).at(middle * period));
}

TEST_CASE("only the named units are traced") {
    const TestFolder here;
    run_small(here, {"--vcd", "--trace-units", "normal,  triangle_queue"});
    for (const auto& [name, signal] : VcdFile(here.path() / "out/trace.vcd").signals) {
        INFO(name);
        CHECK((name == "tessera.passes_under_way" || name == "tessera.clock.cycle" ||
               name.rfind("tessera.tessellation_tests_0.normal_test.", 0) == 0 ||
               name.rfind("tessera.normal_map.", 0) == 0 || name.rfind("tessera.triangle_queue.", 0) == 0));
    }
}

TEST_CASE("a deadlock leaves its traces and no files of an earlier run") {
    const TestFolder here;
    const std::vector<std::string> stall{"--set", "hardware.queue_capacity=4", "--set", "hardware.queue_overflow=stall",
                                         "--vcd"};
    run_small(here, {});
    const ProgramEnd end = run_tessera(small_run(stall), here.path());
    INFO(end.text());
    REQUIRE(end.exit_code == 3);
    CHECK_THAT(end.err, Contains("trace.vcd") && Contains("out"));
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(here.path() / "out"))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    CHECK(names == std::vector<std::string>{"job.toml", "trace.vcd"});
    const VcdFile vcd(here.path() / "out/trace.vcd");
    CHECK(vcd["tessera.triangle_queue.stalled"].at(vcd.end) == 1);
}

TEST_CASE("invalid traces are refused, and nothing is written") {
    const TestFolder here;
    const auto trace_refused = [&](const Arguments& arguments, const std::vector<std::string>& words) {
        refused(Arguments{"run", "--set", "output.folder=out/of/it"} + arguments, here, words);
    };
    for (const auto& [option, key] :
         std::vector<std::pair<std::string, std::string>>{{"--vcd", "output.vcd"}, {"--fst", "output.vcd"}})
        trace_refused({option, "--set", "mode=functional"}, {key, "mode = \"timed\""});
    const auto refused_timed = [&](const Arguments& arguments, const std::vector<std::string>& words) {
        trace_refused(Arguments{"--vcd"} + arguments, words);
    };
    refused_timed({"--trace", "20:10"}, {"output.trace_from", "20", "output.trace_to", "10"});
    refused_timed({"--trace", "20"}, {"--trace 20", "FROM:TO"});
    refused_timed({"--trace", ":20"}, {"FROM:TO"});
    refused_timed({"--trace", "1:2:3"}, {"output.trace_to"});
    refused_timed({"--trace", "-1:3"}, {"output.trace_from"});
    refused_timed({"--trace-units", "transform queue_level"},
                  {"output.trace_units", "\"queue_level\"", "triangle_queue", "tessellation_tests_0.view_test"});
}

TEST_CASE("a limit that ends a traced run leaves no trace") {
    const TestFolder here;
    const ProgramEnd end = run_tessera(small_run({"--vcd", "--set", "limits.triangles=100"}), here.path());
    INFO(end.text());
    CHECK(end.exit_code == 4);
    CHECK(here.names().empty());

    ProgramLimits limits;
    limits.file_bytes = 2'000'000;
    const ProgramEnd full = run_tessera(small_run({"--vcd", "--trace", "0:1000000"}), here.path(), limits);
    INFO(full.text());
    CHECK(full.signal == 0);
    CHECK(full.exit_code == 4);
    CHECK(lines_of(full.err).size() == 1);
    CHECK_THAT(full.err, Contains("out/trace.vcd"));
    CHECK(here.names().empty());
}

TEST_CASE("trace.fst: --fst compresses the waveforms, or names the missing package") {
    const TestFolder here;
    fs::create_directory(here.path() / "tools");
    const auto run = [&] {
        ProgramEnd end = run_program(
            {tessera_program(), "run", "--fst", "--set", "tests.generation_limit=2", "--set", "output.folder=out"},
            here.path(), {}, {{"PATH", (here.path() / "tools").string()}});
        INFO(end.text());
        REQUIRE(end.exit_code == 0);
        return end;
    };
    const ProgramEnd without = run();
    CHECK_THAT(without.out, Contains("package gtkwave"));
    CHECK(fs::exists(here.path() / "out/trace.vcd"));
    CHECK_FALSE(fs::exists(here.path() / "out/trace.fst"));

    const auto make_tool = [&](const std::string& script) {
        write_all(here.path() / "tools/vcd2fst", script);
        fs::permissions(here.path() / "tools/vcd2fst", fs::perms::owner_all);
    };
    make_tool(
        "#!/bin/sh\nread line < \"$1\" && echo \"$line\" > \"$2\"\n"
        "while read key value; do if [ $key = SigBlk: ]; then echo $value > blocked; fi; done "
        "< /proc/self/status\n");
    run();
    CHECK(read_all(here.path() / "out/trace.fst") == "$version tessera $end\n");
    CHECK(read_all(here.path() / "blocked") == "0000000000000000\n");  // Ctrl-C ends it too
    make_tool("#!/bin/sh\nexit 1\n");
    const ProgramEnd failed = run();
    CHECK_THAT(failed.out, Contains("vcd2fst failed"));
    CHECK_FALSE(fs::exists(here.path() / "out/trace.fst"));
}

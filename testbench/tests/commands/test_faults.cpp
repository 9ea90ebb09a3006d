#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "testbench/tests/support/program_runner.h"

// A run with a fault, as a user asks for it: what it says, what it leaves, and its exit code.

using namespace tessera;
using Catch::Contains;

namespace {

ProgramEnd run_with(const TestFolder& here, const std::vector<std::string>& settings) {
    std::vector<std::string> arguments{"run"};
    for (const std::string& setting :
         {std::string("mesh.columns=1"), std::string("mesh.rows=1"), std::string("output.folder=out")})
        arguments.insert(arguments.end(), {"--set", setting});
    for (const std::string& setting : settings)
        arguments.insert(arguments.end(), {"--set", setting});
    return run_tessera(arguments, here.path());
}

}  // namespace

TEST_CASE("a flipped bit of a table is a failed run that says who caught it and leaves no mesh") {
    for (const char* mode : {"mode=functional", "mode=timed"}) {
        const TestFolder here;
        const ProgramEnd end = run_with(
            here,
            {mode, "fault.kind=bit_flip", "fault.place=displace_vertex.displacement_map", "fault.bit=15"});
        INFO(end.text());
        CHECK(end.exit_code == 1);
        CHECK_THAT(
            end.out,
            Contains("fault injected: bit_flip at displace_vertex.displacement_map, transaction 1, bit 15") &&
                Contains("caught by: read check: displace_vertex.displacement_map: a read at address"));
        const std::string report = read_all(here.path() / "out/conformance.txt");
        CHECK_THAT(report, Catch::StartsWith("Conformance report: FAILED") && Contains("fault injected: "));
        CHECK_THAT(read_all(here.path() / "out/conformance.json"), Contains("\"by\": \"read check\""));
        CHECK_FALSE(std::filesystem::exists(here.path() / "out/mesh.ply"));
    }
}

TEST_CASE("a lost answer is the watchdog's, with its exit code") {
    const TestFolder here;
    const ProgramEnd end = run_with(here, {"fault.kind=dropped", "fault.place=displace_vertex.to_transform"});
    INFO(end.text());
    CHECK(end.exit_code == 3);
    CHECK_THAT(end.out, Contains("caught by: watchdog: deadlock"));
    CHECK_THAT(end.err, Contains("tessera.pass_or_tessellate") && Contains("waiting for"));
}

TEST_CASE("a fault that nobody notices has an exit code of its own") {
    const TestFolder here;
    const ProgramEnd end = run_with(here, {"fault.kind=dropped", "fault.place=lighting.to_rasteriser",
                                           "check.work=false", "mode=functional"});
    INFO(end.text());
    CHECK(end.exit_code == 5);
    CHECK_THAT(end.out, Contains("caught by: NOBODY"));
}

TEST_CASE("faults that cannot be are bad input") {
    const TestFolder here;
    CHECK_THAT(run_with(here, {"fault.kind=response_lost"}).err, Contains("`fault.place` is empty"));
    const ProgramEnd timed = run_with(here, {"mode=functional", "fault.kind=response_doubled",
                                             "fault.place=displace_vertex.displacement_map"});
    CHECK(timed.exit_code == 2);
    CHECK_THAT(timed.err, Contains("which only timed mode has"));
    const ProgramEnd never =
        run_with(here, {"fault.kind=dropped", "fault.place=host.to_get_triangle", "fault.transaction=1000"});
    CHECK(never.exit_code == 2);
    CHECK_THAT(never.err, Contains("fault.transaction = 1000 was never reached"));
}

TEST_CASE("a fault that this mode does nothing for is refused, not reported as injected") {
    const TestFolder here;
    const std::vector<std::string> settings{"mode=functional", "fault.kind=doubled",
                                            "fault.place=displace_vertex.displacement_map"};
    const ProgramEnd end = run_with(here, settings);
    INFO(end.text());
    CHECK(end.exit_code == 2);
    CHECK(end.out.empty());
    CHECK_THAT(end.err, Contains("`fault.kind` = \"doubled\" at a memory") && Contains("mode = \"timed\""));
    CHECK(here.names().empty());
}

TEST_CASE("the last transaction has none to change places with: dropped is not reported as reordered") {
    const TestFolder here;
    const auto refused_at_last = [&](const std::string& mode, const std::string& kind,
                                     const std::string& place, const std::string& last) {
        const ProgramEnd end =
            run_with(here, {mode, "fault.kind=" + kind, "fault.place=" + place, "fault.transaction=" + last});
        INFO(end.text());
        CHECK(end.exit_code == 2);
        CHECK_THAT(end.err,
                   Contains("no later transaction came at " + place + " for fault.transaction = " + last));
    };
    for (const char* mode : {"mode=functional", "mode=timed"})
        refused_at_last(mode, "reordered", "host.to_get_triangle", "2");

    const std::string memory = "displace_vertex.displacement_map";
    const ProgramEnd beyond = run_with(
        here, {"fault.kind=response_reordered", "fault.place=" + memory, "fault.transaction=1000000"});
    const std::string before = "saw ";
    const std::size_t count = beyond.err.find(before);
    REQUIRE(count != std::string::npos);
    refused_at_last("mode=timed", "response_reordered", memory,
                    std::to_string(std::stoul(beyond.err.substr(count + before.size()))));
}

TEST_CASE("how a job ends without the fault is not taken for its being caught") {
    const TestFolder here;
    const auto refused = [&](const std::vector<std::string>& settings) {
        std::vector<std::string> all{"fault.kind=reordered", "fault.place=host.to_get_triangle"};
        all.insert(all.end(), settings.begin(), settings.end());
        const ProgramEnd end = run_with(here, all);
        INFO(end.text());
        CHECK(end.exit_code == 2);
        CHECK(end.out.empty());
        CHECK(lines_of(end.err).size() == 1);
        CHECK_THAT(end.err, Contains("fails without its fault already"));
        CHECK(here.names().empty());
        return end.err;
    };
    CHECK_THAT(refused({"hardware.queue_capacity=1", "hardware.queue_overflow=stall"}),
               Contains("watchdog: deadlock"));
    for (const char* mode : {"mode=functional", "mode=timed"})
        CHECK_THAT(refused({"limits.triangles=100", mode}),
                   Contains("resource limit: limits.triangles = 100"));
}

TEST_CASE("a fault is for a run alone: no frames, no traces, nothing tuned, swept, compared or drawn") {
    const TestFolder here;
    const std::vector<std::string> fault{"fault.kind=dropped", "fault.place=host.to_get_triangle"};
    const auto refused = [&](const std::string& setting, const std::vector<std::string>& words) {
        const ProgramEnd end = run_with(here, {fault[0], fault[1], setting});
        INFO(end.text());
        CHECK(end.exit_code == 2);
        for (const std::string& word : words)
            CHECK_THAT(end.err, Contains(word));
        CHECK(here.names().empty());
    };
    refused("frames.count=3", {"`fault.kind` = \"dropped\"", "`frames.count` = 3"});
    refused("output.vcd=true", {"`fault.kind` = \"dropped\"", "`output.vcd` = true"});
    refused("output.timeline=true", {"`fault.kind` = \"dropped\"", "`output.timeline` = true"});
    for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
             {"tune", "--triangles", "300"}, {"widths", "--quantity", "normal"}}) {
        std::vector<std::string> arguments = command;
        for (const std::string& setting : fault)
            arguments.insert(arguments.end(), {"--set", setting});
        const ProgramEnd end = run_tessera(arguments, here.path());
        INFO(end.text());
        CHECK(end.exit_code == 2);
        CHECK_THAT(end.err, Contains("fault.kind = \"dropped\"") && Contains("--set fault.kind=none"));
        CHECK(here.names().empty());
    }
    const ProgramEnd placed = run_with(here, {"fault.place=host.to_get_triangle"});
    CHECK(placed.exit_code == 2);
    CHECK_THAT(placed.err, Contains("`fault.place` = \"host.to_get_triangle\", but `fault.kind` = \"none\""));

    REQUIRE(run_with(here, {fault[0], fault[1]}).exit_code == 1);
    for (const char* command : {"compare", "render"}) {
        const ProgramEnd end = run_tessera({command, "out"}, here.path());
        INFO(end.text());
        CHECK(end.exit_code == 2);
        CHECK_THAT(end.err, Contains("job.toml has fault.kind = \"dropped\""));
    }
}

TEST_CASE("a run with the read check alone was checked") {
    const TestFolder here;
    const std::vector<std::string> off{"check.golden=false", "check.end_to_end=false",
                                       "check.invariants=false", "check.work=false", "mode=functional"};
    CHECK_THAT(run_with(here, off).out, Contains("nothing was checked"));
    std::vector<std::string> reads = off;
    reads.emplace_back("check.reads=true");
    CHECK_THAT(run_with(here, reads).out, Contains("all checks passed"));
}

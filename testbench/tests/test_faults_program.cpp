#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "testbench/tests/program_runner.h"

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
    CHECK_THAT(end.err, Contains("tessera.pass_or_tessellate") && Contains("lacks its parts"));
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

#include <catch2/catch.hpp>
#include <string>

#include "testbench/tests/commands/crater_lake.h"

// Crater Lake through the machine with a Rank Test, as a user runs it, from 24 base triangles.

using namespace tessera;
using Catch::Contains;

namespace {

/// With a Rank Test.
CraterLakeRun ranked(const TestFolder& here, const Arguments& settings) {
    return {here, Arguments{"--set", "hardware.height_test=rank", "--set", "hardware.triangulation=greatest_rank"} +
                      settings};
}

}  // namespace

TEST_CASE("rank: Crater Lake's error at 4,800 triangles, with entries of 8 bits") {
    const TestFolder here;
    const CraterLakeRun found = ranked(here, {"--set", "tests.rank_threshold=0.038"});
    CHECK(found.triangles < 4800);
    CHECK(found.rms < 5.5);
}

TEST_CASE("rank: no grid point is farther from the mesh than the bound says") {
    const TestFolder here;
    for (const char* const bits : {"6", "16"}) {
        const CraterLakeRun found =
            ranked(here, {"--set", "formats.rank_bits=0", "--set", std::string("formats.bound_bits=") + bits, "--set",
                          "tests.bound_threshold=0.04"});
        INFO(bits << " bits, " << found.triangles << " triangles");
        CHECK(found.largest < 0.04 * CraterLakeRun::depth);
        CHECK(found.largest > 0.02 * CraterLakeRun::depth);
    }
}

TEST_CASE("rank: a base mesh that the test cannot split is named, with one that it can") {
    const TestFolder here;
    const ProgramEnd end = succeed({"run", "--set", "hardware.height_test=rank", "--set", "mode=functional", "--set",
                                    "mesh.columns=8", "--set", "output.picture=false", "--set", "output.folder=run"},
                                   here.path());
    CHECK_THAT(end.out, Contains("the Rank Test never splits them") && Contains("mesh.source = \"lattice\""));
}

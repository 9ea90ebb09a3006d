#include <catch2/catch.hpp>
#include <string>

#include "testbench/tests/commands/crater_lake.h"

// The program with a Curvature Test: Crater Lake's error from 24 base triangles, and other base meshes.

using namespace tessera;

namespace {

const Arguments with_the_test = {"--set", "hardware.height_test=curvature"};

}  // namespace

TEST_CASE("curvature: Crater Lake's error at 2,400 to 19,200 triangles") {
    const TestFolder here;
    struct Row {
        const char* threshold;
        std::uint64_t most_triangles;
        double rms;
    };
    for (const Row& row :
         {Row{"0.29", 2400, 9.8}, Row{"0.14", 4800, 6.5}, Row{"0.067", 9600, 4.3}, Row{"0.032", 19200, 2.7}}) {
        const CraterLakeRun found(
            here, with_the_test + Arguments{"--set", std::string("tests.curvature_threshold=") + row.threshold});
        INFO(row.threshold << ": " << found.triangles << " triangles, RMS " << found.rms << " m");
        CHECK(found.triangles <= row.most_triangles);
        CHECK(found.rms <= row.rms);
    }
}

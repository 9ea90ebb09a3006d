#include "testbench/output/report/error_report.h"

#include <catch2/catch.hpp>
#include <string>

using namespace tessera;
using Catch::Contains;

// The reports of `tessera compare`: every column has its unit.

TEST_CASE("error.txt: every figure is below its heading, in both units") {
    MeshError error;
    error.texel = 0.5;
    error.interpolated.reference_to_mesh.max = 2;
    error.interpolated.reference_to_mesh.rms = 0.25;
    error.vertical.emplace();
    error.vertical->max = 3;
    error.vertical->rms = 1;
    error.vertical->map_unit = 0.125;
    const std::string text = error_text({}, {}, error);
    INFO(text);
    const auto line = [](std::string name, const std::string& columns) {
        name.resize(34, ' ');
        return "\n  " + name + columns + "\n";
    };
    CHECK_THAT(text, Contains(line("", " max, model units RMS, model units     max, texels     RMS, texels")));
    CHECK_THAT(text, Contains(line("  reference to mesh",
                                   "                2             0.25               4             0.5")));
    CHECK_THAT(text, Contains(line("", " max, model units RMS, model units  max, map units  RMS, map units")));
    CHECK_THAT(text, Contains(line("vertical, at grid points",
                                   "                3                1              24               8")));
}

TEST_CASE("error.txt: fewer than one sample per texel is noted beside the density") {
    MeshError error;
    error.reference_density = 4;
    error.mesh_density = 1;
    const std::string few = " (fewer than one: detail between them is not measured)";
    CHECK_THAT(error_text({}, {}, error), Contains("reference 0, 4 per texel and axis; mesh 0, 1 per texel\n"));
    error.mesh_density = 0.125;
    CHECK_THAT(error_text({}, {}, error),
               Contains("reference 0, 4 per texel and axis; mesh 0, 0.125 per texel" + few + "\n"));
    error.reference_density = 0.75;
    CHECK_THAT(error_text({}, {}, error),
               Contains("reference 0, 0.75 per texel and axis" + few + "; mesh 0, 0.125 per texel" + few + "\n"));
}

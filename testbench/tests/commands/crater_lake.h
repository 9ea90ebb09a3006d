#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

namespace tessera {

/// Runs Crater Lake from 24 base triangles, as a user does.
struct CraterLakeRun {
    std::uint64_t triangles;
    double rms;         // m, vertically at grid points
    double rms_pixels;  // the same in pixels, of the points in the picture

    /// Figures of the mesh with these additional settings; both commands must succeed.
    CraterLakeRun(const TestFolder& here, const Arguments& settings) {
        const std::string job = (source_folder() / "testbench/examples/jobs/crater_lake_24.toml").string();
        succeed(Arguments{"run", job} +
                    set({"mesh.source=lattice", "mesh.spacing=128", "map.range=data", "displacement.scale=0.945",
                         "tests.normal=false", "tests.view=false", "tests.generation_limit=15", "mode=functional",
                         "output.picture=false", "output.folder=run"}) +
                    settings,
                here.path());
        succeed({"compare", "run"}, here.path());
        const auto error = read_json(here.path() / "run/error.json");
        const auto vertical = [&](const char* name) { return error["vertical"][name]["value"].get<double>(); };
        triangles = RunFolder(here.path() / "run").count("run", "triangles_finished");
        rms = 1000 * vertical("rms");
        rms_pixels = vertical("rms_pixels");
    }
};

}  // namespace tessera

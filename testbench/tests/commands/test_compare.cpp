#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "testbench/compare/measure_error.h"
#include "testbench/machine/inputs.h"
#include "testbench/run_folder/read_run.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;
using Catch::Contains;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

void run_job(const fs::path& folder, const Arguments& more) {
    succeed(Arguments{"run"} + more +
                set({"mode=functional", "output.picture=false", "output.obj=false", "check.golden=false",
                     "check.end_to_end=false"}),
            folder);
}

/// Compares a run and returns error.json, in which every figure must have a value, a unit and a description.
json compare(const fs::path& folder, const std::string& run) {
    const ProgramEnd end = succeed({"compare", run}, folder);
    CHECK_THAT(end.out, Catch::StartsWith("measurement\n") && Contains("\ninterpolated\n"));
    const json error = json::parse(read_all(folder / run / "error.json"));
    for (const auto& [group, figures] : error.items())
        for (const auto& [name, figure] : figures.items()) {
            INFO(group << '.' << name);
            CHECK(figure.contains("value"));
            CHECK_FALSE(figure.at("unit").get<std::string>().empty());
            CHECK_FALSE(figure.at("description").get<std::string>().empty());
        }
    return error;
}

double value(const json& error, const char* group, const char* name) {
    return error.at(group).at(name).at("value").get<double>();
}

}  // namespace

TEST_CASE("compare reports the default run's error") {
    const TestFolder here;
    run_job(here.path(), {});
    const json error = compare(here.path(), "runs/half_donut");
    // A texel is 2 / 264. The mesh follows the donut within about a texel.
    const double texel = value(error, "measurement", "texel");
    CHECK(texel == Approx(2.0 / 264));
    CHECK(value(error, "measurement", "reference_density") == 4);
    for (const char* const group : {"interpolated", "nearest_texel"})
        for (const char* const direction : {"reference_to_mesh", "mesh_to_reference"}) {
            const std::string name = direction;
            const double max = value(error, group, (name + "_max").c_str());
            const double rms = value(error, group, (name + "_rms").c_str());
            CHECK(rms > 0);
            CHECK(rms < max);
            CHECK(rms < texel);
            CHECK(max < 4 * texel);
            CHECK(value(error, group, (name + "_max_texels").c_str()) == Approx(max / texel));
        }
    CHECK(value(error, "vertical", "grid_points") == 69696);
    CHECK(value(error, "vertical", "covered") == 69696);
    CHECK(value(error, "vertical", "rms") < 0.005);
    CHECK(value(error, "vertical", "max_map") == Approx(value(error, "vertical", "max") / 0.25));
    CHECK(value(error, "worst_reference_to_mesh", "distance") == value(error, "interpolated", "reference_to_mesh_max"));
    CHECK(value(error, "worst_mesh_to_reference", "base") < 18);
    CHECK_FALSE(error.at("worst_vertical").at("why_whole").at("value").get<std::string>().empty());

    // A second comparison writes the same bytes. A new run in the folder removes the outdated files.
    const std::string first = read_all(here.path() / "runs/half_donut/error.json");
    compare(here.path(), "runs/half_donut");
    CHECK((first == read_all(here.path() / "runs/half_donut/error.json")));
    run_job(here.path(), {"--set", "tests.normal_threshold=1"});
    CHECK_FALSE(fs::exists(here.path() / "runs/half_donut/error.json"));
    const json coarse = compare(here.path(), "runs/half_donut");
    CHECK(value(coarse, "interpolated", "reference_to_mesh_rms") >
          value(error, "interpolated", "reference_to_mesh_rms"));
}

TEST_CASE("if all edges split, a bilinear filter leaves a third of the error, in either design") {
    const TestFolder here;
    const auto rms = [&](const std::string& filter, const std::string& design) {
        run_job(here.path(), {"--set", "map.width=96", "--set", "map.height=96", "--set", "tests.normal_threshold=0",
                              "--set", "tests.summed_height_threshold=0", "--set", "tests.view=false", "--set",
                              "hardware.displacement_filter=" + filter, "--set", "hardware.design=" + design});
        return value(compare(here.path(), "runs/half_donut"), "interpolated", "reference_to_mesh_rms");
    };
    const double nearest = rms("nearest", "paper"), bilinear = rms("bilinear", "paper");
    CHECK(3 * bilinear < nearest);
    CHECK(rms("bilinear", "modern") == bilinear);
}

TEST_CASE("a run of a constant map on a plane has no error beyond rounding") {
    const TestFolder here;
    run_job(here.path(), {"--set", "map.source=constant", "--set", "displacement.bias=0.25"});
    const json error = compare(here.path(), "runs/half_donut");
    CHECK(value(error, "interpolated", "hausdorff") < 1e-4);  // 0.25 + 0.25 / 2, rounded to the position's format
    CHECK(value(error, "vertical", "max") < 1e-4);
    run_job(here.path(), {"--set", "mesh.source=cylinder", "--set", "map.address_u=repeat", "--set",
                          "displacement.scale=0.05", "--set", "output.folder=runs/round"});
    const json round = compare(here.path(), "runs/round");
    CHECK(round.at("vertical").at("none").at("value") == "the base mesh is not planar");
    CHECK(value(round, "interpolated", "reference_to_mesh_max_texels") < 6);
}

TEST_CASE("a run whose triangles were all culled has no mesh to compare") {
    const TestFolder here;
    run_job(here.path(), {"--set", "hardware.culling=back", "--set", "camera.eye=[0,0,-9]", "--set",
                          "camera.target=[0,0,0]", "--set", "camera.up=[0,1,0]", "--set", "displacement.scale=0"});
    const json error = compare(here.path(), "runs/half_donut");
    CHECK(value(error, "measurement", "triangles") == 0);
    CHECK(error.at("interpolated").at("reference_to_mesh_max").at("value").is_null());
    CHECK(value(error, "vertical", "covered") == 0);
    CHECK_THAT(error.at("measurement").at("triangles").at("description").get<std::string>(), Contains("culling"));
}

// Measured with fewer samples than the program takes.
TEST_CASE("fitted heights raise neither the root mean square nor the largest distance, in either direction") {
    const TestFolder here;
    const std::string job =
        GENERATE("half_donut", "crater_lake_24", "crater_lake_704", "crater_lake_rank", "teapot", "head");
    INFO(job);
    const auto error_with = [&](const char* heights) {
        run_job(here.path(), Arguments{(source_folder() / "testbench/examples/jobs" / (job + ".toml")).string()} +
                                 set({std::string("map.heights=") + heights, "output.folder=run"}));
        const RecordedRun run = read_run(here.path() / "run", fs::path());
        const HeightMap map = load_map(run.job);
        MeasureLimits limits;
        limits.reference_samples = 1 << 20;
        limits.mesh_samples = 1 << 18;
        return measure_error(load_mesh(run.job), map, DisplacementOf::from(run.job, map), run.mesh, limits);
    };
    const MeshError given = error_with("given"), fitted = error_with("fitted");
    constexpr double rounding = 1 + 1e-12;
    const auto no_larger = [](const DirectedError& error, const DirectedError& than) {
        CHECK(error.max <= than.max * rounding);
        CHECK(error.rms <= than.rms * rounding);
    };
    for (const auto sampling : {&MeshError::interpolated, &MeshError::nearest_texel}) {
        no_larger((fitted.*sampling).reference_to_mesh, (given.*sampling).reference_to_mesh);
        no_larger((fitted.*sampling).mesh_to_reference, (given.*sampling).mesh_to_reference);
    }
    CHECK(fitted.interpolated.mesh_to_reference.rms > 0);
}

// Others that name a remedy: remedies.h.
TEST_CASE("compare refuses a folder that is not a run, and writes nothing") {
    const TestFolder here;
    refused({"compare"}, here.path(), {"RUN", "--help"});
    refused({"compare", "a", "b"}, here.path(), {"--help"});
    refused({"compare", "absent"}, here.path(), {"absent", "no such folder"});
    run_job(here.path(), {"--set", "tests.normal_threshold=1"});
    const fs::path mesh = here.path() / "runs/half_donut/mesh.ply";
    const std::string bytes = read_all(mesh);
    write_all(mesh, bytes.substr(0, bytes.size() - 7));
    refused({"compare", "runs/half_donut"}, here.path(), {"mesh.ply", "announces"});
    CHECK_FALSE(fs::exists(here.path() / "runs/half_donut/error.json"));
}

TEST_CASE("compare reports Crater Lake's error in metres") {
    const TestFolder here;
    const auto run = [&](const std::string& name, const std::vector<std::string>& more) {
        run_job(here.path(),
                Arguments{(source_folder() / "testbench/examples/jobs" / (name + ".toml")).string()} + more);
        return compare(here.path(), "runs/" + name);
    };
    // The grid of 704 triangles itself, without splits.
    const json base = run("crater_lake_704", {"--set", "tests.normal=false", "--set", "tests.summed_height=false"});
    CHECK(value(base, "measurement", "triangles") == 704);
    CHECK(value(base, "vertical", "grid_points") == 336 * 459);
    CHECK(value(base, "vertical", "covered") == 336 * 459);
    CHECK(value(base, "vertical", "rms_map") == Approx(26.52).epsilon(0.01));  // another program's figure
    CHECK(value(base, "vertical", "max_map") == Approx(219.2).epsilon(0.01));
    CHECK(value(base, "vertical", "rms_map") == Approx(1000 * value(base, "vertical", "rms")));
    for (const char* const name : {"crater_lake_24", "crater_lake_704"}) {
        const json error = run(name, {});
        CHECK(value(error, "vertical", "covered") == 336 * 459);
        CHECK(value(error, "vertical", "rms_map") > 2);
        CHECK(value(error, "vertical", "rms_map") < 12);
        CHECK(value(error, "vertical", "max_map") < 150);
        CHECK(value(error, "interpolated", "reference_to_mesh_rms_texels") < 0.5);
    }
}

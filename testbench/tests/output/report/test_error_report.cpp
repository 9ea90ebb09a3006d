#include "testbench/output/report/error_report.h"

#include <catch2/catch.hpp>
#include <map>
#include <string>
#include <variant>

#include "modules/datapath/height_tests.h"

using namespace tessera;

// The report of `tessera compare`.

namespace {

RecordedMesh two_triangles() {
    RecordedMesh mesh;
    mesh.triangles.resize(2);
    mesh.triangles[1].base = 7;
    mesh.triangles[1].generation = 5;
    mesh.triangles[1].split_by = 2;
    return mesh;
}

/// Distinct values everywhere.
MeshError distinct_error() {
    MeshError error;
    error.texel = 0.5;
    error.reference_density = 3;
    error.mesh_density = 0.75;
    error.beyond_map = 9;
    const auto directed = [](double first) {
        WorstSpot spot;
        spot.position = {first + 1, first + 2, first + 3};
        spot.texture = {first + 4, first + 5};
        spot.triangle = 1;
        return DirectedError{static_cast<std::uint64_t>(first), first + 6, first + 7, spot};
    };
    error.interpolated.reference_to_mesh = directed(10);
    error.interpolated.mesh_to_reference = directed(20);
    error.nearest_texel.reference_to_mesh = directed(30);
    error.nearest_texel.mesh_to_reference = directed(40);
    VerticalError& vertical = error.vertical.emplace();
    vertical = {101, 102, 103, 104, 105, 106, 107, 0.25, {108, 109}, {110, 111, 112}, 1};
    return error;
}

}  // namespace

TEST_CASE("error.json: every figure is under its name") {
    std::map<std::string, double> numbers;
    for (const Figure& figure : error_figures({}, two_triangles(), distinct_error())) {
        double number = 0;
        if (const auto* const value = std::get_if<double>(&figure.value))
            number = *value;
        else if (const auto* const count = std::get_if<std::uint64_t>(&figure.value))
            number = static_cast<double>(*count);
        else
            continue;
        numbers[figure.group + "." + figure.name] = number;
    }
    std::map<std::string, double> expected = {{"measurement.triangles", 2},
                                              {"measurement.texel", 0.5},
                                              {"measurement.reference_density", 3},
                                              {"measurement.mesh_density", 0.75},
                                              {"measurement.beyond_map", 9},
                                              {"interpolated.hausdorff", 26},
                                              {"interpolated.hausdorff_texels", 52},
                                              {"nearest_texel.hausdorff", 46},
                                              {"nearest_texel.hausdorff_texels", 92},
                                              {"vertical.grid_points", 101},
                                              {"vertical.covered", 102},
                                              {"vertical.max", 103},
                                              {"vertical.rms", 104},
                                              {"vertical.max_map", 412},
                                              {"vertical.rms_map", 416},
                                              {"vertical.seen", 105},
                                              {"vertical.max_pixels", 106},
                                              {"vertical.rms_pixels", 107},
                                              {"worst_vertical.distance", 103},
                                              {"worst_vertical.u", 108},
                                              {"worst_vertical.v", 109},
                                              {"worst_vertical.x", 110},
                                              {"worst_vertical.y", 111},
                                              {"worst_vertical.z", 112}};
    double first = 0;
    for (const char* const group : {"interpolated", "nearest_texel"})
        for (const char* const direction : {"reference_to_mesh", "mesh_to_reference"}) {
            first += 10;
            const std::string name = std::string(group) + "." + direction;
            expected[name + "_samples"] = first;
            expected[name + "_max"] = first + 6;
            expected[name + "_rms"] = first + 7;
            expected[name + "_max_texels"] = 2 * (first + 6);
            expected[name + "_rms_texels"] = 2 * (first + 7);
            if (group == std::string("nearest_texel"))
                continue;
            const std::string worst = std::string("worst_") + direction + ".";
            expected[worst + "distance"] = first + 6;
            expected[worst + "x"] = first + 1;
            expected[worst + "y"] = first + 2;
            expected[worst + "z"] = first + 3;
            expected[worst + "s"] = first + 4;
            expected[worst + "t"] = first + 5;
        }
    for (const char* const group : {"worst_reference_to_mesh.", "worst_mesh_to_reference.", "worst_vertical."})
        for (const auto& [name, value] :
             {std::pair{"triangle", 1}, {"base", 7}, {"generation", 5}, {"split_by", 2}, {"stopped_by", 0}})
            expected[group + std::string(name)] = value;
    CHECK(numbers == expected);
}

TEST_CASE("error.json names the tests that the job has") {
    Job job;
    const auto named = [&](const std::string& why, const std::string& splits) {
        INFO(why);
        for (const Figure& figure : error_figures(job, two_triangles(), distinct_error())) {
            if (figure.name == "why_whole")
                CHECK(std::get<std::string>(figure.value) == "none: " + why);
            if (figure.name == "split_by")
                CHECK(figure.description == "tests that split its parent: " + splits);
        }
    };
    named("neither Normal Test nor Summed Height Test requested a split",
          "1 Normal Test, 2 Summed Height Test, 3 both, 0 base");
    job.hardware.height_test = HeightTest::rank;
    named("neither Normal Test nor Rank Test requested a split", "1 Normal Test, 2 Rank Test, 3 both, 0 base");
    job.tests.normal = false;
    job.hardware.height_test = datapath::number_of<datapath::CurvatureTest>();
    named("not even the Curvature Test requested a split", "1 Normal Test, 2 Curvature Test, 3 both, 0 base");
    job.hardware.height_test = datapath::number_of<datapath::MipmapTest>();
    job.tests.highlight = true;
    named("neither Mipmap Test nor Highlight Test requested a split", "1 Normal Test, 2 Mipmap Test, 3 both, 0 base");
    job.tests.highlight = job.tests.summed_height = false;
    named("every test that requests splits is off", "1 Normal Test, 2 Mipmap Test, 3 both, 0 base");
}

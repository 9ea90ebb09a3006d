#include "testbench/output/report/error_report.h"

#include <fmt/format.h>

#include "modules/datapath/height_tests.h"

namespace tessera {

namespace {

std::string height_test_of(const Job& job) {
    return functions_of(job.hardware.height_test).title();
}

/// The job's tests that request splits.
std::string requesting_tests(const Job& job) {
    std::string text;
    const auto add = [&](bool on, const std::string& name) {
        if (on)
            text += (text.empty() ? "" : " nor ") + std::string(name);
    };
    add(job.tests.normal, "Normal Test");
    add(job.tests.summed_height, height_test_of(job));
    add(job.tests.highlight, "Highlight Test");
    return text;
}

std::string why_whole(const Job& job, unsigned stopped_by) {
    std::string text;
    const auto add = [&](unsigned bit, const std::string& name) {
        if ((stopped_by & bit) != 0)
            text += (text.empty() ? "" : ", ") + std::string(name);
    };
    add(4, "View Test");
    add(8, "Tex Coord Test");
    add(16, "Generation Test");
    if (!text.empty())
        return text;
    const std::string tests = requesting_tests(job);
    if (tests.empty())
        return "none: every test that requests splits is off";
    return fmt::format("none: {}{} requested a split",
                       tests.find(" nor ") == std::string::npos ? "not even the " : "neither ", tests);
}

void add_direction(FigureGroup& figures, const std::string& name, const char* words, const DirectedError& error,
                   double texel) {
    figures.add(name + "_max", error.max, "model unit",
                fmt::format("largest distance from {}; infinite without a mesh", words));
    figures.add(name + "_rms", error.rms, "model unit",
                fmt::format("root mean square of the distance from {}, weighted by area", words));
    figures.add(name + "_max_texels", error.max / texel, "texel", "the largest, in texels");
    figures.add(name + "_rms_texels", error.rms / texel, "texel", "the root mean square, in texels");
    figures.add(name + "_samples", error.samples, "sample", "points measured");
}

void add_surface(std::vector<Figure>& all, const char* group, const SurfaceError& error, double texel) {
    FigureGroup figures(all, group);
    add_direction(figures, "reference_to_mesh", "the reference surface to the emitted mesh", error.reference_to_mesh,
                  texel);
    add_direction(figures, "mesh_to_reference", "the emitted mesh to the reference surface", error.mesh_to_reference,
                  texel);
    figures.add("hausdorff", error.hausdorff(), "model unit", "the larger of the two largest distances");
    figures.add("hausdorff_texels", error.hausdorff() / texel, "texel", "the same, in texels");
}

void add_place(FigureGroup& figures, const glm::dvec3& position) {
    figures.add("x", position.x, "model unit", "position on the surface measured from");
    figures.add("y", position.y, "model unit", "likewise");
    figures.add("z", position.z, "model unit", "likewise");
}

void add_triangle(FigureGroup& figures, const Job& job, std::uint64_t number, const RecordedMesh::Triangle& triangle) {
    figures.add("triangle", number, "-", "the emitted triangle there, its index in mesh.ply");
    figures.add("base", triangle.base, "-", "its base triangle");
    figures.add("generation", triangle.generation, "-", "its generation");
    figures.add("split_by", triangle.split_by, "-",
                fmt::format("tests that split its parent: {}1 Normal Test, 2 {}, 3 both{}",
                            triangle.split_by < 32 ? "" : "32 Highlight Test, plus ", height_test_of(job),
                            triangle.split_by < 32 ? ", 0 base" : ""));
    figures.add(
        "stopped_by", triangle.stopped_by, "-",
        "tests that stopped one of its edges from being split: sum of 4 View Test, 8 Tex Coord Test, 16 Generation Test");
    figures.add("why_whole", why_whole(job, triangle.stopped_by), "-", "the same in words");
}

void add_worst(std::vector<Figure>& all, const char* group, const Job& job, const RecordedMesh& mesh,
               const DirectedError& error) {
    if (!error.worst)
        return;
    FigureGroup figures(all, group);
    figures.add("distance", error.max, "model unit", "the largest distance");
    add_place(figures, error.worst->position);
    figures.add("s", error.worst->texture.x, "-", "texture coordinate, 0..1 spans the map");
    figures.add("t", error.worst->texture.y, "-", "likewise; 0 is the bottom row");
    add_triangle(figures, job, error.worst->triangle, mesh.triangles[error.worst->triangle]);
}

void add_vertical(std::vector<Figure>& all, const Job& job, const RecordedMesh& mesh, const MeshError& error) {
    FigureGroup figures(all, "vertical");
    if (!error.vertical) {
        figures.add("none", error.no_vertical, "-", "why this is not a height field");
        return;
    }
    const VerticalError& vertical = *error.vertical;
    figures.add("grid_points", vertical.grid_points, "texel", "texel centres on the base mesh");
    figures.add("covered", vertical.covered, "texel", "of these, those that the emitted mesh covers; only they count");
    figures.add("max", vertical.max, "model unit", "largest difference of heights at a grid point");
    figures.add("rms", vertical.rms, "model unit", "its root mean square, every grid point weighted equally");
    if (vertical.map_unit > 0) {
        figures.add("max_map", vertical.max / vertical.map_unit, "map unit",
                    "the largest, in the units of the map's file (PGM, PNG: its integers)");
        figures.add("rms_map", vertical.rms / vertical.map_unit, "map unit", "the root mean square likewise");
    }
    if (vertical.seen > 0) {
        figures.add("seen", vertical.seen, "texel", "covered grid points in the camera's picture, hidden or not");
        figures.add("max_pixels", vertical.max_pixels, "pixel",
                    "largest distance in the picture between a grid point and the mesh above or below it");
        figures.add("rms_pixels", vertical.rms_pixels, "pixel",
                    "its root mean square, every grid point weighted equally");
    }
    if (vertical.covered == 0)
        return;
    FigureGroup worst(all, "worst_vertical");
    worst.add("distance", vertical.max, "model unit", "the largest difference");
    add_place(worst, vertical.worst_position);
    worst.add("u", vertical.worst_texel.x, "texel", "the grid point");
    worst.add("v", vertical.worst_texel.y, "texel", "likewise; row 0 is the bottom row");
    add_triangle(worst, job, vertical.worst_triangle, mesh.triangles[vertical.worst_triangle]);
}

}  // namespace

std::vector<Figure> error_figures(const Job& job, const RecordedMesh& mesh, const MeshError& error) {
    std::vector<Figure> all;
    FigureGroup figures(all, "measurement");
    figures.add("triangles", mesh.triangles.size(), "triangle",
                job.hardware.culling == Culling::back
                    ? "of the emitted mesh, mesh.ply, without culled ones (hardware.culling): reference to mesh "
                      "measures the holes"
                    : "of the emitted mesh, mesh.ply");
    figures.add("texel", error.texel, "model unit",
                "a texel's length: mean over both axes of its area-weighted mean on the base surface");
    figures.add("reference_density", error.reference_density, "sample/texel",
                "samples of the reference along each axis, at least; 4 unless the limit of samples lowered it; "
                "with fewer than 1, detail between them is not measured");
    figures.add("mesh_density", error.mesh_density, "sample/texel",
                "samples of the emitted mesh along each edge, at least; 1 unless the limit of samples lowered it");
    figures.add("beyond_map", error.beyond_map, "sample", "of the reference beyond the map, which do not count");
    add_surface(all, "interpolated", error.interpolated, error.texel);
    add_surface(all, "nearest_texel", error.nearest_texel, error.texel);
    add_worst(all, "worst_reference_to_mesh", job, mesh, error.interpolated.reference_to_mesh);
    add_worst(all, "worst_mesh_to_reference", job, mesh, error.interpolated.mesh_to_reference);
    add_vertical(all, job, mesh, error);
    return all;
}

}  // namespace tessera

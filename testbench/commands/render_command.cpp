#include "testbench/commands/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <string>

#include "testbench/commands/progress.h"
#include "testbench/commands/run_files.h"
#include "testbench/common/atomic_file.h"
#include "testbench/common/atomic_set.h"
#include "testbench/compare/measure_error.h"
#include "testbench/input/map/map_file.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/inputs.h"
#include "testbench/render/error_range.h"
#include "testbench/render/png_writer.h"
#include "testbench/render/view_picture.h"
#include "testbench/run_folder/read_run.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

/// Output location of the pictures.
struct Output {
    fs::path folder;
    std::string file;  ///< file name of a single picture; empty: named after the view

    fs::path path_of(PictureView view) const {
        return folder / (file.empty() ? std::string(name_of(view)) + ".png" : file);
    }
};

Output choose_output(const RenderRequest& request) {
    Output output{request.output.empty() ? request.run : request.output, {}};
    std::error_code error;
    if (request.output.empty() || fs::is_directory(request.output, error) || !request.output.has_filename() ||
        request.output.extension().empty())
        return output;
    if (lower_case_extension(request.output) != ".png")
        throw InputError(
            fmt::format("--output {}: pictures are written as FILE.png; to name a new folder, end it with a /",
                        request.output.string()));
    if (request.views.size() > 1)
        throw InputError(fmt::format("--output {}: {} views need {} files; name a folder", request.output.string(),
                                     request.views.size(), request.views.size()));
    output.folder = folder_of(request.output);
    output.file = request.output.filename().string();
    return output;
}

/// A message about camera keys, with render's options in their place.
std::string in_options(const std::string& message) {
    static const std::regex key(R"(`?camera\.(eye|target|up|field_of_view)`?(?: =)?)"),
        point(R"(\[(\S+), (\S+), (\S+)\])");
    const std::string text = std::regex_replace(std::regex_replace(message, key, "--$1"), point, "$1 $2 $3");
    return std::regex_replace(text, std::regex("--field_of_view"), "--field-of-view");
}

View choose_camera(const RenderRequest& request, Job job) {
    if (!request.eye && !request.target && !request.up && !request.field_of_view)
        return make_view(job.camera);
    job.camera.eye = request.eye.value_or(job.camera.eye);
    job.camera.target = request.target.value_or(job.camera.target);
    job.camera.up = request.up.value_or(job.camera.up);
    job.camera.field_of_view = request.field_of_view.value_or(job.camera.field_of_view);
    try {
        validate(job);
    } catch (const InputError& error) {
        throw InputError(
            fmt::format("invalid camera from --eye, --target, --up and --field-of-view (default: the run's): {}",
                        in_options(error.what())));
    }
    return make_view(job.camera);
}

void check_size(const RenderRequest& request, const RenderMesh& mesh, const View& camera) {
    std::int64_t pixels = 0;
    for (const PictureView view : request.views)
        pixels += std::int64_t{request.picture.width} * picture_height(mesh, camera, view, request.picture);
    if (pixels > most_picture_pixels)
        throw InputError(
            fmt::format("--size: {} pixels in {} picture{}; the limit for all views together is {}: make the pictures "
                        "smaller or render fewer views at once",
                        pixels, request.views.size(), request.views.size() == 1 ? "" : "s", most_picture_pixels));
}

bool asks_for(const RenderRequest& request, PictureView view) {
    return std::find(request.views.begin(), request.views.end(), view) != request.views.end();
}

/// Measures the run's mesh against the interpolated map, as `tessera compare` does: for each triangle the largest
/// distance in either direction. About 5 s for 200,000 triangles. The darkest colour stands for --error-scale or, by
/// default, the error exceeded by 1 % of the area: with the largest errors, those of a few triangles on a step of the
/// map, no colours would be left for the rest.
void add_errors(const RecordedRun& run, RenderMesh& mesh, ErrorScale& scale) {
    const BaseMesh base = load_mesh(run.job);
    const HeightMap map = load_map(run.job);
    const SurfaceError error =
        measure_surface_error(base, map, DisplacementOf::from(run.job, map), run.mesh, Sampling::interpolated);
    for (const TriangleError& triangle : error.triangles)
        mesh.triangle_errors.push_back(std::max(triangle.max, triangle.reference_max));
    scale.texel = texel_length(base, map);
    scale.beyond = largest_of(mesh.triangle_errors);
    if (scale.largest == 0)
        scale.largest = error_of_most(mesh, 0.99);
    if (scale.largest == 0)
        scale.largest = scale.beyond;
}

}  // namespace

ExitCode render_command(const RenderRequest& asked, const fs::path& data_folder) {
    RenderRequest request = asked;
    const Output output = choose_output(request);
    const RecordedRun run = read_run(request.run, data_folder);
    const View camera = choose_camera(request, run.job);
    check_output_folder(output.folder, "--output");
    RenderMesh mesh = make_render_mesh(run.mesh);
    mesh.height_test = run.job.hardware.height_test;
    check_size(request, mesh, camera);

    Progress progress;
    if (asks_for(request, PictureView::error)) {
        progress.show("measuring", 0);
        add_errors(run, mesh, request.picture.errors);
    }
    progress.show("rendering", 0);
    const std::vector<Picture> pictures = render_views(mesh, camera, request.views, request.picture);
    AtomicSet files;
    files.make_folder(output.folder, "--output");
    for (std::size_t i = 0; i < pictures.size(); ++i)
        write_file(output.path_of(request.views[i]), encode_png(pictures[i].image));
    files.commit();
    progress.clear();

    for (std::size_t i = 0; i < pictures.size(); ++i)
        fmt::print("  {}: {} x {} pixels\n", output.path_of(request.views[i]).lexically_normal().string(),
                   pictures[i].image.width, pictures[i].image.height);
    const bool in_sight =
        std::any_of(pictures.begin(), pictures.end(), [](const Picture& picture) { return picture.mesh_in_sight; });
    if (!in_sight)
        fmt::print("  {}\n", mesh.triangles.empty() ? "the run's mesh is empty: all triangles were culled"
                                                    : "no part of the mesh is in this camera's view");
    return ExitCode::fine;
}

std::vector<std::string> picture_names() {
    std::vector<std::string> names;
    for (const PictureView view : picture_views)
        names.push_back(std::string(name_of(view)) + ".png");
    return names;
}

}  // namespace tessera

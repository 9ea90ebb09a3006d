#include "testbench/commands/bake_command.h"

#include <fmt/format.h>

#include <algorithm>

#include "testbench/bake/bake.h"
#include "testbench/commands/progress.h"
#include "testbench/commands/run_files.h"
#include "testbench/common/atomic_file.h"
#include "testbench/common/atomic_set.h"
#include "testbench/job/dump_job.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/job/toml_text.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/inputs.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

/// The job whose base mesh the map is baked for: the given one, or the default job on a plane of the surface's size. Of
/// its map it keeps what does not belong to another map's values; a lattice has the new map's size.
Job base_job(const BakeRequest& request, const Surface& surface, const fs::path& data_folder) {
    Job job;
    if (request.mesh_job.empty()) {
        job.mesh.width = surface.high.x - surface.low.x;
        job.mesh.depth = surface.high.y - surface.low.y;
        return job;
    }
    job = load_job(request.mesh_job.string(), {}, data_folder);
    Job::Map map;
    map.source = MapSource::constant;
    map.width = request.width;
    map.height = request.height;
    map.heights = job.map.heights;
    map.address_u = job.map.address_u;
    map.address_v = job.map.address_v;
    job.map = map;
    return job;
}

/// What becomes of the surface file's rectangle.
std::string domain_text(const BakeRequest& request, const Surface& surface) {
    const glm::dvec2 centre = (surface.low + surface.high) / 2.0;
    if (!request.mesh_job.empty())
        return surface.has_domain ? "  note: [domain] is not used: the base mesh of --mesh gives the region\n" : "";
    return centre == glm::dvec2(0)
               ? ""
               : fmt::format(
                     "  note: the job's plane is centred at the origin: the surface is moved by ({:.6g}, {:.6g})\n",
                     -centre.x, -centre.y);
}

BakedMap bake(const BakeRequest& request, const Surface& surface, const Job& job) {
    const auto* const quadric = std::get_if<QuadricSurface>(&surface.shape);
    if (quadric == nullptr || request.mesh_job.empty())
        return bake_heights(surface, request.width, request.height);
    return bake_over_mesh(*quadric, load_mesh(job), job.map, request.width, request.height);
}

/// Refuses to write the job over one of its inputs.
void check_job_file(const BakeRequest& request, const fs::path& job_file) {
    for (const fs::path& read : {request.surface, request.mesh_job}) {
        std::error_code absent;
        if (!read.empty() && fs::equivalent(job_file, read, absent))
            throw InputError(fmt::format("--output {}: the job {} beside it would overwrite {}: choose another name",
                                         request.output.string(), job_file.filename().string(), read.string()));
    }
}

std::string share(std::size_t texels, const BakedMap& map) {
    return fmt::format("{} texel{} ({:.1f} %)", texels, texels == 1 ? "" : "s",
                       100 * static_cast<double>(texels) / static_cast<double>(map.values.size()));
}

std::string summary(const BakedMap& map, const EncodedMap& file) {
    const auto [low, high] = std::minmax_element(map.values.begin(), map.values.end());
    std::string text = fmt::format("  map               {} x {} texels, displacements {:.6g} .. {:.6g} model units\n",
                                   map.width, map.height, *low, *high);
    text += file.step > 0
                ? fmt::format("  rounding          16 bits, to half a step of {:.3g} model units\n", file.step)
            : *low < *high ? "  rounding          to 32-bit floats\n"
                           : "  rounding          none: all displacements are the same\n";
    if (map.absent > 0)
        text += fmt::format("  surface absent    at {}: {:.6g} there\n", share(map.absent, map), map.floor);
    if (map.raised > 0)
        text += fmt::format("  below the floor   {}: {:.6g} there\n", share(map.raised, map), map.floor);
    if (map.uncovered > 0)
        text += fmt::format(
            "  no base triangle  at {}: {} at most {:g} from one hold the surface continued past it, the others "
            "their nearest neighbours' values\n",
            share(map.uncovered, map), map.continued, bake_margin);
    if (map.overlaps > 0)
        text += fmt::format("  note: {} lie in several base triangles; the map holds the first one's surface\n",
                            share(map.overlaps, map));
    text += fmt::format("  for a job         displacement.scale = {}, displacement.bias = {}\n",
                        toml_number(file.scale), toml_number(file.bias));
    return text;
}

}  // namespace

ExitCode bake_command(const BakeRequest& request, const fs::path& data_folder) {
    const Surface surface = read_surface(request.surface);
    Job job = base_job(request, surface, data_folder);
    const fs::path folder = folder_of(request.output);
    check_output_folder(folder, "--output");
    const std::string name = request.output.stem().string();
    const fs::path job_file = folder / (name + ".job.toml");
    check_job_file(request, job_file);

    Progress progress;
    progress.show("baking", 0);
    const BakedMap map = bake(request, surface, job);
    const EncodedMap file = encode_height_map(map.width, map.height, map.values, request.format);
    progress.clear();

    const Job::Map built_in;
    job.map.source = MapSource::file;
    job.map.file = rebase_path(request.output.string(), "", job.folder);
    job.map.path = request.output;
    job.map.width = built_in.width;
    job.map.height = built_in.height;
    job.displacement = {file.scale, file.bias};
    job.output.folder = "runs/" + name;
    validate(job);
    require_inputs_stay(job);
    const std::string job_text = dump_short_job(
        job, folder, fmt::format("Written by `tessera bake` from {}.", printable(request.surface.filename().string())));

    AtomicSet files;
    files.make_folder(folder, "--output");
    write_file(request.output, file.bytes);
    write_file(job_file, job_text);
    files.commit();
    fmt::print("{}{}  {} and {}: tessera run {}\n", summary(map, file), domain_text(request, surface),
               request.output.lexically_normal().string(), job_file.filename().string(),
               job_file.lexically_normal().string());
    return ExitCode::fine;
}

}  // namespace tessera

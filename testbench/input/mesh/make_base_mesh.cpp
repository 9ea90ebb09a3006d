#include "testbench/input/mesh/make_base_mesh.h"

#include <fmt/core.h>

#include <cstdint>

#include "testbench/common/error.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/input/mesh/obj_reader.h"
#include "testbench/input/mesh/run_mesh.h"
#include "testbench/job/job_choices.h"

namespace tessera {

namespace {

/// Defaults for 0 in a job: the paper's plane of 18 triangles; round surfaces of 32 quads per side, a power of two so
/// that their texture coordinates are exact on any map.
std::int64_t quads(std::int64_t wanted, MeshSource source) {
    if (wanted != 0)
        return wanted;
    return source == MeshSource::plane ? 3 : 32;
}

}  // namespace

std::array<std::int64_t, 2> quads_of(const Job::Mesh& mesh) {
    if (mesh.source == MeshSource::file || mesh.source == MeshSource::run || mesh.source == MeshSource::lattice)
        return {0, 0};
    return {quads(mesh.columns, mesh.source), quads(mesh.rows, mesh.source)};
}

BaseMesh make_base_mesh(const Job::Mesh& job, const std::string& file) {
    if (reads_file(job.source) && file.empty())
        throw InputError(fmt::format("mesh.file is empty: with mesh.source = \"{}\" it must name {}",
                                     name_of(job.source),
                                     job.source == MeshSource::file ? "an OBJ file" : "a run's folder"));
    const std::int64_t columns = quads(job.columns, job.source);
    const std::int64_t rows = quads(job.rows, job.source);
    switch (job.source) {
        case MeshSource::plane: return make_plane(columns, rows, job.width, job.depth);
        case MeshSource::cylinder: return make_cylinder(columns, rows, job.radius, job.height);
        case MeshSource::sphere: return make_sphere(columns, rows, job.radius);
        case MeshSource::lattice: throw InputError("mesh.source = \"lattice\" depends on the map (load_mesh)");
        case MeshSource::file: return read_obj(file);
        case MeshSource::run: return read_run_mesh(file);
    }
    throw InputError("mesh.source is not one of plane, cylinder, sphere, file, run");
}

}  // namespace tessera

#include "testbench/machine/inputs.h"

#include "testbench/input/map/built_in_maps.h"
#include "testbench/input/map/map_displacement.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/input/mesh/make_base_mesh.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/fingerprint.h"

namespace tessera {

BaseMesh load_mesh(const Job& job, const std::filesystem::path& data_folder) {
    check_mesh_fingerprint(job, data_folder);
    std::string file;
    if (reads_file(job.mesh.source))
        file = resolve_path(job.mesh.file, job.folder, data_folder).string();
    return make_base_mesh(job.mesh, file);
}

namespace {

HeightMap make_map(const Job& job, const std::filesystem::path& data_folder) {
    const Job::Map& map = job.map;
    switch (map.source) {
        case MapSource::half_donut:
            return half_donut_map(map.width, map.height);
        case MapSource::text:
            return text_map(map.width, map.height, map.text);
        case MapSource::noise:
            return noise_map(map.width, map.height, map.seed);
        case MapSource::constant:
            return constant_map(map.width, map.height, map.value);
        case MapSource::ramp:
            return ramp_map(map.width, map.height);
        case MapSource::file:
            break;
    }
    return read_height_map(resolve_path(map.file, job.folder, data_folder), map.channel);
}

}  // namespace

HeightMap load_map(const Job& job, const std::filesystem::path& data_folder) {
    check_map_fingerprint(job, data_folder);
    HeightMap map = make_map(job, data_folder);
    span_values(map, job.map.range);
    return map;
}

Inputs load_inputs(const Job& job, const std::filesystem::path& data_folder) {
    Inputs inputs{load_mesh(job, data_folder), load_map(job, data_folder), {}};
    inputs.resolved = resolve_job(job, inputs.mesh, inputs.map);
    validate(inputs.resolved.job);
    return inputs;
}

}  // namespace tessera

#include "testbench/machine/inputs.h"

#include "testbench/common/error.h"
#include "testbench/input/map/built_in_maps.h"
#include "testbench/input/map/map_range.h"
#include "testbench/input/map/no_data.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/input/mesh/make_base_mesh.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/fingerprint.h"

namespace tessera {

BaseMesh load_mesh(const Job& job) {
    check_mesh_fingerprint(job);
    if (job.mesh.source == MeshSource::lattice) {
        const HeightMap map = load_map(job);
        return make_lattice({map.width, map.height},
                            {job.map.address_u == Addressing::repeat, job.map.address_v == Addressing::repeat},
                            job.mesh.spacing, job.mesh.width, job.mesh.depth);
    }
    return make_base_mesh(job.mesh, job.mesh.path.string());
}

namespace {

HeightMap make_map(const Job& job) {
    const Job::Map& map = job.map;
    switch (map.source) {
        case MapSource::half_donut: return half_donut_map(map.width, map.height);
        case MapSource::text: return text_map(map.width, map.height, map.text);
        case MapSource::noise: return noise_map(map.width, map.height, map.seed);
        case MapSource::constant: return constant_map(map.width, map.height, map.value);
        case MapSource::ramp: return ramp_map(map.width, map.height);
        case MapSource::file: break;
    }
    return read_height_map(map.path, map.channel, map.no_data);
}

}  // namespace

HeightMap load_map(const Job& job) {
    check_map_fingerprint(job);
    HeightMap map = make_map(job);
    if (job.map.source == MapSource::file)
        suspect_no_data(map, job.map.no_data);
    else if (!job.map.no_data.empty() && !replace_missing(map, job.map.no_data))
        throw InputError("map.no_data: every texel of the built-in map has one of its values; set map.no_data = []");
    if (!map.no_data_hint.empty())
        map.repairs.push_back(map.no_data_hint + '.');
    span_values(map, job.map.range);
    return map;
}

std::vector<std::string> repairs_of(const BaseMesh& mesh, const HeightMap& map) {
    std::vector<std::string> repairs;
    for (const std::string& repair : mesh.repairs)
        repairs.push_back("mesh: " + repair);
    for (const std::string& repair : map.repairs)
        repairs.push_back("map: " + repair);
    return repairs;
}

Inputs load_inputs(const Job& job) {
    Inputs inputs{load_mesh(job), load_map(job), {}};
    inputs.resolved = resolve_job(job, inputs.mesh, inputs.map);
    validate(inputs.resolved.job);
    return inputs;
}

}  // namespace tessera

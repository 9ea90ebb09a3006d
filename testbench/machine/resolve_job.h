#pragma once
#include <string>
#include <vector>

#include "testbench/job/job.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// An automatic value.
struct FoundValue {
    std::string key;    ///< camera.eye
    std::string value;  ///< as in a job file
    std::string rule;   ///< the rule that determined it, in words
};

/// A job without `automatic` values.
struct ResolvedJob {
    Job job;
    std::vector<FoundValue> found;
};

/// Determines the automatic values of camera and displacement's scale from mesh and map, by the rules given in
/// job_keys.cpp. Numbers are rounded to six digits. Throws InputError if a value is out of its key's range. An
/// impossible camera is found later, by validate().
ResolvedJob resolve_job(const Job& job, const BaseMesh& mesh, const HeightMap& map);

/// Throws std::logic_error that names `user` if the job still has an `automatic` value.
void require_resolved(const Job& job, const char* user);

}  // namespace tessera

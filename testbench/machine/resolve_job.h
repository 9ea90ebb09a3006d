#pragma once
#include <string>
#include <vector>

#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/job/job.h"

namespace tessera {

/// A value that the job left to the program.
struct FoundValue {
    std::string key;    ///< camera.eye
    std::string value;  ///< as a job file writes it
    std::string rule;   ///< what it follows from, in words
};

/// A job without `automatic` values.
struct ResolvedJob {
    Job job;
    std::vector<FoundValue> found;
};

/// Finds camera and displacement's scale from mesh and map, by the rules that job_keys.cpp states, where the job leaves
/// them automatic. Numbers are rounded to six digits. Throws InputError if a value lies beyond its key's
/// range. An impossible camera is found later, by validate().
ResolvedJob resolve_job(const Job& job, const BaseMesh& mesh, const HeightMap& map);

/// Throws std::logic_error that names `user` if the job has an `automatic` value left.
void require_resolved(const Job& job, const char* user);

}  // namespace tessera

#pragma once
#include "testbench/common/random.h"
#include "testbench/job/job.h"

namespace tessera {

/// What the job must be compatible with.
struct JobContext {
    double size = 1;                         ///< half the mesh's largest extent, model units
    std::array<double, 3> centre{};          ///< of the mesh
    std::int64_t least_texture_integer = 1;  ///< bits needed by the mesh's texture coordinates, in texels
};

/// Draws everything of a job but its mesh and map: formats from narrow to the widest, thresholds from nothing to
/// everything, tests on and off, any camera (far, inside, looking away), all kinds of designs: queues that spill, one
/// or three Tessellation Tests units, ports, banks, latencies, buffers, random stalls.
void make_random_job(Random& random, const JobContext& context, Job& job);

/// Draws the maps' filter, and a Rank Test in place of the Summed Height Test.
void choose_mesh_options(Random& random, Job& job);

/// Draws the work that the design omits, banks, and caches. Separate and last: a seed's mesh does not depend on it.
void choose_evaluations(Random& random, Job& job);

}  // namespace tessera

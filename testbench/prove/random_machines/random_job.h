#pragma once
#include "testbench/common/random.h"
#include "testbench/job/job.h"

namespace tessera {

/// What a job has to suit.
struct JobContext {
    double size = 1;                         ///< half the mesh's largest extent, model units
    std::array<double, 3> centre{};          ///< of the mesh
    std::int64_t least_texture_integer = 1;  ///< bits the mesh's texture coordinates need, in texels
};

/// Everything of a job but its mesh and map: formats from narrow to the widest there are, thresholds from nothing to
/// everything, tests off and on, the camera anywhere (far, inside, looking away), designs of all kinds: queues that
/// spill, one or three Tessellation Tests units, ports, banks, latencies, buffers, random stalls.
void make_random_job(Random& random, const JobContext& context, Job& job);

/// The maps' filter; a Rank Test in the Summed Height Test's place.
void choose_mesh_options(Random& random, Job& job);

/// Which work the design leaves out, banks, and caches. Apart, and drawn last: a seed's mesh does not depend on it.
void choose_evaluations(Random& random, Job& job);

}  // namespace tessera

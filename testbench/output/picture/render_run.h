#pragma once
#include <string>

#include "testbench/job/job.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// The default picture of a run (PictureView::overview) from the run's own camera: a PNG file's bytes. About a second
/// for each half million pixels, little more for a million triangles than for a thousand.
std::string picture_file(const EmittedMesh& mesh, const MachineSetup& setup, const Job& job);

}  // namespace tessera

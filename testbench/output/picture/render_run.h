#pragma once
#include <filesystem>

#include "testbench/job/job.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// The default picture of a run (PictureView::overview) from the run's own camera, as a PNG file that appears complete
/// or not at all. About a second for each half million pixels, little more for a million triangles than for a thousand.
void write_picture(const std::filesystem::path& path, const EmittedMesh& mesh, const MachineSetup& setup,
                   const Job& job);

}  // namespace tessera

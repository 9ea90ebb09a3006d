#pragma once
#include <filesystem>

#include "testbench/common/error.h"
#include "testbench/input/map/encode_height_map.h"

namespace tessera {

/// What `tessera bake` is to do.
struct BakeRequest {
    std::filesystem::path surface;   ///< surface file (surface_file.h)
    std::filesystem::path mesh_job;  ///< job whose base mesh the surface lies over; empty: the plane z = 0
    std::filesystem::path output;    ///< the map
    MapFormat format = MapFormat::pgm;
    int width = 256, height = 256;  ///< texels
};

/// Samples a curved surface into a displacement map, and writes the map and, beside it, OUTPUT's name ending
/// in .job.toml, a job that displaces the base mesh by it: the one given, or a plane as large as the
/// surface's domain. Prints scale and bias and what became of texels without surface. A NURBS patch is the
/// same map over whatever base mesh.
///
/// Throws what reading the surface, the job and the mesh throws, and what bake.h throws; InputError and
/// ResourceError where a file cannot be written.
ExitCode bake_command(const BakeRequest& request, const std::filesystem::path& data_folder);

}  // namespace tessera

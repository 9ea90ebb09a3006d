#pragma once
#include <filesystem>

#include "testbench/common/error.h"
#include "testbench/input/map/encode_height_map.h"

namespace tessera {

/// The arguments of `tessera bake`.
struct BakeRequest {
    std::filesystem::path surface;   ///< surface file (surface_file.h)
    std::filesystem::path mesh_job;  ///< job with the base mesh under the surface; empty: the plane z = 0
    std::filesystem::path output;    ///< the map
    MapFormat format = MapFormat::pgm;
    int width = 256, height = 256;  ///< texels
};

/// Samples a curved surface into a displacement map. Writes the map and, beside it, a job of the same name ending in
/// .job.toml that displaces a base mesh by it: the given one, or a plane as large as the surface's domain. Prints
/// scale, bias and how texels without surface were filled. A NURBS patch gives the same map over any base mesh.
///
/// Throws the errors of reading surface, job and mesh, and of bake.h; InputError or ResourceError if a file cannot be
/// written.
ExitCode bake_command(const BakeRequest& request, const std::filesystem::path& data_folder);

}  // namespace tessera

#pragma once
#include <filesystem>

#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// Reads a mesh.ply written by tessera (ply_writer.h): binary little-endian, exactly those properties in exactly that
/// order; comments may differ. It is not a general PLY reader.
///
/// Anything else is an InputError with file, problem and remedy: another header; a size that does not match the header
/// (so memory is allocated only for data that exists); a face that is not a triangle or refers to a missing vertex; a
/// number that is not finite or beyond 1e40; bits of no test. Memory: 52 bytes per vertex, 20 per triangle.
RecordedMesh read_ply(const std::filesystem::path& path);

}  // namespace tessera

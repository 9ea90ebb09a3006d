#pragma once
#include <filesystem>

#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// Reads a mesh.ply that tessera wrote (ply_writer.h): binary little-endian, exactly those properties in exactly that
/// order; comments may differ. It is not a general PLY reader.
///
/// Anything else is an InputError with the file, what is wrong and what to do: another header; a size that does not
/// match the header (so memory is allocated only for what is there); a face that is not a triangle or names a missing
/// vertex; a number that is not finite or beyond 1e40; bits that no test has. Memory: 52 bytes a vertex, 20 a
/// triangle.
RecordedMesh read_ply(const std::filesystem::path& path);

}  // namespace tessera

#pragma once
#include <filesystem>

#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// Reads a mesh.ply that tessera wrote (ply_writer.h): binary little-endian, exactly those properties in exactly that
/// order; comments may differ. No other program's PLY is meant to be read.
///
/// Every other byte is one InputError with the file, what is wrong and what to do: a header that says something else,
/// a size that is not the header's (so memory is only taken for what is there), a face that is no triangle or names a
/// vertex that is not there, a number that is not finite or beyond 1e40, bits that no test has. Memory: 52
/// bytes a vertex, 20 a triangle.
RecordedMesh read_ply(const std::filesystem::path& path);

}  // namespace tessera

#pragma once
#include <filesystem>
#include <string>

#include "testbench/input/map/height_map.h"

namespace tessera {

/// Reads a displacement map from an EXR, PNG or PGM file. The content's magic number decides the reader, not
/// the name's extension; a name that claims another format is remarked on in `repairs`.
///
/// channel: EXR only. Empty: "Y", else "R", else the only channel.
/// Sides: 1..largest_map_side, checked before anything of that size is allocated. Peak memory of a file that
///        claims more than it holds: below 256 MiB.
/// Throws InputError (file, what is wrong, value, limit, what to do), ResourceError when memory runs out.
///
/// Formats, what becomes of samples, and remarks: exr_reader.h, png_reader.h, pgm_reader.h.
HeightMap read_height_map(const std::filesystem::path& path, const std::string& channel = {});

}  // namespace tessera

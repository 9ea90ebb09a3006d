#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "testbench/setup/height_map.h"

namespace tessera {

/// Reads a displacement map from an EXR, PNG or PGM file. The reader is selected by the content's magic number; an
/// extension of another format causes a remark in `repairs`.
///
/// channel: EXR only. Empty: "Y", else "R", else the only channel.
/// no_data: values that are no heights, map.no_data (no_data.h).
/// Sides: 1..largest_map_side, checked before allocation. Peak memory for a file with a false header: below 256 MiB.
/// Throws InputError (file, problem, value, limit, remedy), ResourceError when memory runs out.
///
/// Formats, conversion of samples, and remarks: exr_reader.h, png_reader.h, pgm_reader.h.
HeightMap read_height_map(const std::filesystem::path& path, const std::string& channel = {},
                          const std::vector<double>& no_data = {});

}  // namespace tessera

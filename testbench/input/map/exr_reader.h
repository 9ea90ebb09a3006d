#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "testbench/setup/height_map.h"

namespace tessera {

/// Reads one channel of an OpenEXR file (single part, scan lines or tiles, every compression of OpenEXR 3.1)
/// through OpenEXR, single-threaded, after check_exr().
///
/// The map is the display window, as renderers use an image: texels outside the data window are 0, data outside the
/// display window are cropped, and a remark says so. Of several levels (mip or rip map) the finest is read.
/// Channel: the named one, else "Y", else "R", else the only one; unless it was named, a remark lists channels that
/// hold other values. It may be half, float or uint and keeps its values; uint is rounded to float (exact up to 2^24).
/// Range: lowest to highest finite value, equal for a constant map. Subnormal numbers are kept and counted. no_data:
/// see no_data.h.
///
/// Refused: files that check_exr() refuses, a subsampled or missing channel, pixels that cannot be decoded, a map
/// without a finite value. EXR has no checksum: a changed byte in uncompressed pixels is not detected.
HeightMap read_exr(const std::filesystem::path& path, const std::string& channel, const std::vector<double>& no_data);

}  // namespace tessera

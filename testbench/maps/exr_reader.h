#pragma once
#include <filesystem>
#include <string>

#include "testbench/maps/height_map.h"

namespace tessera {

/// Reads one channel of an OpenEXR file (single part, scan lines or tiles, every compression of OpenEXR 3.1)
/// through OpenEXR's core library, which checks what a header claims against the file before it allocates.
///
/// The map is the data window, wherever it lies; the display window is of no interest. Of several levels
/// (mip or rip map) the finest is read.
/// Channel: the named one, else "Y", else "R", else the only one. It may be half, float or uint and keeps its
/// values; uint is rounded to float (exact up to 2^24). Range: lowest to highest finite value, see
/// repair_non_finite.h for the others; equal for a constant map. Subnormal numbers are kept and counted.
///
/// Refused: deep data, several parts, a subsampled channel, missing channel, pixels missing or undecodable, no finite
/// value, chunks of more than 32 MiB or an image of more than 1 GiB when decoded, all channels together. Read, with a
/// remark in `repairs`: an offset table that its writer did not finish, a header without an attribute that the format
/// requires but the map does not need. EXR has no checksum: a changed byte in uncompressed pixels goes unnoticed.
HeightMap read_exr(const std::filesystem::path& path, const std::string& channel);

}  // namespace tessera

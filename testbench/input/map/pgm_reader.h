#pragma once
#include <filesystem>

#include "testbench/setup/height_map.h"

namespace tessera {

/// Reads a PGM greymap (netpbm's pgm(5)): P2 (text) or P5 (binary), maxval 1..65535, 16-bit samples
/// big-endian. Values are sample / maxval, range 0..1.
///
/// Comments (# to the end of the line) are allowed anywhere in the header and between P2 samples. CRLF line
/// ends are allowed in header and P2 body; a P5 file has its raster after one white-space character, or after
/// CRLF if the file's size shows that the LF is not the first sample.
///
/// Refused: sides, maxval or samples out of range, non-numeric text, too few samples. Read, with a remark in `repairs`:
/// content after the last sample (only the first image of several is read); a P2 file that ends directly after its last
/// digit and may be truncated; a header over 4096 bytes.
HeightMap read_pgm(const std::filesystem::path& path);

}  // namespace tessera

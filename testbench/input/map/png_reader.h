#pragma once
#include <filesystem>

#include "testbench/setup/height_map.h"

namespace tessera {

/// Reads a PNG file through libpng: grey of 1, 2, 4, 8, 16 bits, grey with alpha, RGB, RGBA, palette;
/// interlaced or not. Values are sample / maximum sample, range 0..1. They are not gamma-corrected: heights are not
/// colours, so gAMA, sRGB and iCCP do not apply.
///
/// Colour: grey = (2126 R + 7152 G + 722 B) / 10000 (Rec. 709 luma, on the stored samples), which is exactly R if
/// R = G = B; other texels are counted in `repairs`. Alpha is ignored; texels that are not opaque are counted in
/// `repairs`.
///
/// Refused: a CRC error in a chunk needed for the pixels; a missing end; sides out of range; a file shorter than its
/// header claims. Read, with a remark in `repairs`: warnings of libpng, such as a CRC error in another chunk; bytes
/// after the end.
HeightMap read_png(const std::filesystem::path& path);

}  // namespace tessera

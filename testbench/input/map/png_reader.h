#pragma once
#include <filesystem>

#include "testbench/input/map/height_map.h"

namespace tessera {

/// Reads a PNG file through libpng: grey of 1, 2, 4, 8, 16 bits, grey with alpha, RGB, RGBA, palette;
/// interlaced or not. Values are sample / maximum sample, range 0..1, and never gamma-corrected: a height is
/// not a colour, so gAMA, sRGB and iCCP say nothing about it.
///
/// Colour: grey = (2126 R + 7152 G + 722 B) / 10000 (Rec. 709 luma, on the samples as stored), which is
/// exactly R where R = G = B; other texels are counted in `repairs`. Alpha is ignored; texels that are not
/// opaque are counted in `repairs`.
///
/// Refused: a CRC error in a chunk that the pixels need; a missing end; sides out of range; a file too short for what
/// it claims. Read, with a remark in `repairs`: whatever libpng warns of, a CRC error in another chunk for example;
/// bytes after the end.
HeightMap read_png(const std::filesystem::path& path);

}  // namespace tessera

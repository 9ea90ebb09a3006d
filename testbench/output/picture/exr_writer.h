#pragma once
#include <string>

#include "testbench/output/picture/image.h"

namespace tessera {

enum class ExrSamples { half, single };

/// Encodes the image as an OpenEXR file: scan lines from the top, (0, 0) the upper left pixel, channels R, G and B in
/// linear light with sRGB's primaries, lossless compression (ZIP). No time stamp: the same image gives the same bytes.
/// A half has 11 significant bits, ample for the 8 of a PNG; values above 65504 become infinite.
std::string encode_exr(const LinearImage& image, ExrSamples samples);

}  // namespace tessera

#pragma once
#include <string>

#include "testbench/output/picture/image.h"

namespace tessera {

enum class ExrSamples { half, single };

/// The image as an OpenEXR file's bytes: scan lines from the top, (0, 0) the upper left pixel, channels R, G and B in
/// linear light with sRGB's primaries, compressed without loss (ZIP). No time stamp: the same image gives the same
/// bytes. A half keeps 11 bits, ample for the 8 of a PNG; more than 65504 becomes infinite.
std::string encode_exr(const LinearImage& image, ExrSamples samples);

}  // namespace tessera

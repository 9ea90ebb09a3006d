#pragma once
#include <string>

#include "testbench/output/picture/image.h"

namespace tessera {

/// The image as a PNG file's bytes: 8-bit RGB, marked sRGB, no time stamp. The same image gives the same
/// bytes.
std::string encode_png(const Image& image);

}  // namespace tessera

#pragma once
#include <string>

#include "testbench/render/image.h"

namespace tessera {

/// Encodes the image as a PNG file: 8-bit RGB, marked sRGB, no time stamp. The same image gives the same bytes.
std::string encode_png(const Image& image);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <vector>

namespace tessera {

/// An image as a PNG file's bytes: `format` is a PNG_FORMAT_ of libpng's simplified interface, samples come row by row
/// from the top. No time stamp: the same image gives the same bytes.
std::vector<std::uint8_t> encode_png_samples(int width, int height, std::uint32_t format,
                                             const void* samples);

}  // namespace tessera

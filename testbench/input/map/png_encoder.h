#pragma once
#include <cstdint>
#include <string>

namespace tessera {

/// Encodes an image as a PNG file: `format` is a PNG_FORMAT_ of libpng's simplified interface, `flags` its
/// PNG_IMAGE_FLAG_s; samples are in rows from the top. No time stamp: the same image gives the same bytes.
std::string encode_png_samples(int width, int height, std::uint32_t format, const void* samples,
                               std::uint32_t flags = 0);

}  // namespace tessera

#pragma once
#include <ImfHeader.h>
#include <ImfPixelType.h>

#include <string>
#include <vector>

namespace tessera {

/// Encodes an image as an OpenEXR file: scan lines from the top, the header's attributes, and these channels with
/// interleaved samples. No time stamp: the same image gives the same bytes.
std::string encode_exr_samples(Imf::Header header, const std::vector<const char*>& channels, Imf::PixelType type,
                               const void* samples);

}  // namespace tessera

#pragma once
#include <ImfHeader.h>
#include <ImfPixelType.h>

#include <string>
#include <vector>

namespace tessera {

/// An image as an OpenEXR file's bytes: scan lines from the top, the header's own attributes, and these channels, whose
/// samples lie side by side. No time stamp: the same image gives the same bytes.
std::string encode_exr_samples(Imf::Header header, const std::vector<const char*>& channels,
                               Imf::PixelType type, const void* samples);

}  // namespace tessera

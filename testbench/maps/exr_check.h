#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace tessera {

/// Whether an EXR file holds what its header claims, before OpenEXR's C++ library reads it: that library allocates what
/// a header claims, and takes what a chunk lacks for zeros. Asked is OpenEXR's core library, which does neither, but
/// decodes neither DWA nor (in version 3.1) all of B44.
///
/// Checked: header, offset table, every chunk's place and size; the pixels of chunks without compression or with RLE,
/// ZIPS or ZIP (the C++ library notices a shortfall of the others); sides against largest_map_side; no chunk larger than
/// 32 MiB and no image larger than 1 GiB when decoded, all channels together. Refused with a sentence: deep data,
/// several parts. Throws InputError; returns remarks on what the format requires and the pixels can do without.
std::vector<std::string> check_exr(const std::filesystem::path& path);

}  // namespace tessera

#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace tessera {

/// Checks that an EXR file holds what its header claims, before OpenEXR's C++ library reads it. That library (3.1)
/// allocates what a header claims, and takes missing pixels for zeros. OpenEXR's core library does neither, but cannot
/// replace it: it decodes no DWA, and some B44 wrongly.
///
/// Checked: header, offset table, every chunk's place and size; whether chunks without compression or with RLE, ZIPS or
/// ZIP hold all their pixels (of other chunks the C++ library notices it); sides against largest_map_side; at most
/// 32 MiB a chunk and 1 GiB an image when decoded, all channels together. Deep data and several parts are refused.
/// Throws InputError. Returns remarks on what the format requires but the pixels do not need: an offset table that its
/// writer did not finish, an absent attribute.
std::vector<std::string> check_exr(const std::filesystem::path& path);

}  // namespace tessera

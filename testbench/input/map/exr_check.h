#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace tessera {

/// Checks an EXR file against its header before OpenEXR's C++ library reads it. That library (3.1) allocates the size
/// claimed in a header, and reads missing pixels as zeros. OpenEXR's core library does neither, but cannot replace it:
/// it does not decode DWA, and decodes some B44 wrongly.
///
/// Checked: header, offset table, every chunk's position and size; whether chunks without compression or with RLE, ZIPS
/// or ZIP contain all their pixels (for other chunks the C++ library detects it); sides against largest_map_side; at
/// most 32 MiB per chunk and 1 GiB per image when decoded, all channels together. Deep data and multi-part files are
/// refused. Throws InputError. Returns remarks on violations of the format that do not affect the pixels: an unfinished
/// offset table, a missing attribute.
std::vector<std::string> check_exr(const std::filesystem::path& path);

}  // namespace tessera

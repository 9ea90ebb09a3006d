#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tessera {

/// Pixels of a plane, borders included.
struct PixelWindow {
    int left = 0, top = 0, right = 0, bottom = 0;

    std::int64_t width() const { return std::int64_t{right} - left + 1; }
    std::int64_t height() const { return std::int64_t{bottom} - top + 1; }
};

struct ExrCheck {
    PixelWindow image;  ///< the display window; if the file lacks it, the data window
    std::vector<std::string> remarks;
};

/// Checks an EXR file against its header before OpenEXR's C++ library reads it. That library (3.1) allocates the size
/// claimed in a header, and reads missing pixels as zeros. OpenEXR's core library does neither, but cannot replace it:
/// it does not decode DWA, and decodes some B44 wrongly.
///
/// Checked: header, offset table, every chunk's position and size; whether chunks without compression or with RLE, ZIPS
/// or ZIP contain all their pixels (for other chunks the C++ library detects it); the display window's sides against
/// largest_map_side, the data window's against twice that; that the two overlap; at
/// most 32 MiB per chunk and 1 GiB per image when decoded, all channels together. Deep data and multi-part files are
/// refused. Throws InputError. Returns remarks on violations of the format that do not affect the pixels (an unfinished
/// offset table, a missing attribute), and on a data window that is not the display window.
ExrCheck check_exr(const std::filesystem::path& path);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tessera {

struct ExrChannel {
    std::string name;
    int type = 0;  // Imf::PixelType: 0 uint, 1 half, 2 float
    std::int32_t x_sampling = 1;
    std::int32_t y_sampling = 1;
};

/// What an EXR file claims, read from its header alone.
struct ExrHeader {
    std::int64_t width = 0;  // of the data window
    std::int64_t height = 0;
    std::int32_t left = 0;  // data window's origin
    std::int32_t top = 0;
    bool tiled = false;
    std::uint32_t tile_width = 0;
    std::uint32_t tile_height = 0;
    int compression = 0;
    std::vector<ExrChannel> channels;
    std::vector<std::string> absent;  // required by the format, but without influence on the map
};

/// Largest scan-line block or tile, decoded, all channels. libOpenEXR keeps about three of them.
inline constexpr std::uint64_t largest_exr_block = 32ULL << 20;

/// Largest whole image, decoded, all channels: 16 float channels of 4096 x 4096 texels, some seconds of work.
/// Every channel is decoded, wanted or not, and a few megabytes of file can hold very many.
inline constexpr std::uint64_t largest_exr_image = 1ULL << 30;

/// Reads and checks the header before libOpenEXR sees the file: the library allocates what a header claims
/// (attributes, offset table, line and tile buffers) before it finds that the file holds nothing of it.
/// Format: openexr.com, "OpenEXR File Layout".
///
/// Checked: version; structure and sizes of the attributes; data window against largest_map_side; block size
/// against largest_exr_block, all channels together against largest_exr_image; offset table and best possible
/// compression against the file's size; scan lines' offsets; that chunks do not overlap, and that none holds less than
/// its pixels. Refused with a sentence: deep data, several parts. Throws InputError.
ExrHeader read_exr_header(const std::filesystem::path& path);

}  // namespace tessera

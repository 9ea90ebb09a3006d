#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/tests/support/test_folder.h"

namespace tessera::map_test {

/// PNG through libpng. colour_type: PNG_COLOR_TYPE_*; rows are top first, raw PNG samples (16 bit big-endian,
/// small depths packed); palette: RGB triples.
struct PngImage {
    std::uint32_t width, height;
    int depth;
    int colour_type;
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint8_t> palette;
    bool interlaced = false;
};
void write_png(const std::filesystem::path& path, const PngImage& image);

enum class Pixels { uint, half, float_ };

/// EXR through libOpenEXR. values: row by row from the top (smallest y of the data window first).
struct ExrImage {
    int width, height;
    std::vector<float> values;
    Pixels pixels = Pixels::float_;
    int compression = 3;  // Imf::ZIP_COMPRESSION
    bool tiled = false;
    bool mip_map = false;
    int left = 0, top = 0;
    std::vector<std::string> channels{"Y"};  // channel number i holds values + i, or planes[i]
    std::vector<std::vector<float>> planes{};
    struct Window {
        int left, top, right, bottom;
    };
    std::optional<Window> display{};  // nothing: the data window
};
void write_exr(const std::filesystem::path& path, const ExrImage& image);

/// The result of read_height_map() for a file.
struct Outcome {
    enum class Kind { loaded, loaded_with_remark, refused, wrong_exception } kind;
    std::string message;
};
Outcome outcome_of(const std::filesystem::path& path);

}  // namespace tessera::map_test

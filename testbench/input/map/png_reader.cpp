#include "testbench/input/map/png_reader.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/input/map/map_file.h"

namespace tessera {
namespace {

// libpng reports errors and warnings through these functions. The first must not return.
struct Messages {
    std::string error;
    std::vector<std::string> warnings;
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    static_cast<Messages*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}

void on_warning(png_structp png, png_const_charp message) {
    constexpr std::size_t most = 8;
    auto& warnings = static_cast<Messages*>(png_get_error_ptr(png))->warnings;
    if (warnings.size() < most)
        warnings.emplace_back(message);
}

struct Decoder {
    explicit Decoder(Messages& messages)
        : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &messages, on_error, on_warning)),
          info(png == nullptr ? nullptr : png_create_info_struct(png)) {}
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
    ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
    png_structp png;
    png_infop info;
};

// Returns false if libpng left by longjmp after an error. No object here may have a destructor.
bool decode(png_structp png, png_infop info, std::FILE* file) {
    if (setjmp(png_jmpbuf(png)) != 0)
        return false;
    png_init_io(png, file);
    // Of the ancillary chunks only tRNS is used, so a file with a damaged colour profile or comment is accepted.
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_WARN_DISCARD);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_read_png(png, info, PNG_TRANSFORM_EXPAND, nullptr);
    return true;
}

void convert(const Decoder& decoder, HeightMap& map) {
    const bool wide = png_get_bit_depth(decoder.png, decoder.info) == 16;
    const std::size_t channels = png_get_channels(decoder.png, decoder.info);
    const bool colour = channels >= 3, alpha = channels % 2 == 0;
    const std::uint32_t maximum = wide ? 65535 : 255;
    std::int64_t coloured = 0, not_opaque = 0;
    map.source_units = maximum;
    for (int y = 0; y < map.height; ++y) {
        const png_bytep row = png_get_rows(decoder.png, decoder.info)[map.height - 1 - y];
        const auto sample = [row, wide](std::size_t k) -> std::uint32_t {
            return wide ? png_get_uint_16(row + 2 * k) : row[k];
        };
        for (int x = 0; x < map.width; ++x) {
            const std::size_t first = static_cast<std::size_t>(x) * channels;
            const std::uint32_t r = sample(first), g = colour ? sample(first + 1) : r,
                                b = colour ? sample(first + 2) : r;
            coloured += r != g || g != b ? 1 : 0;
            not_opaque += alpha && sample(first + channels - 1) != maximum ? 1 : 0;
            map.at(x, y) = static_cast<float>(static_cast<double>(2126 * r + 7152 * g + 722 * b) /
                                              (10000.0 * static_cast<double>(maximum)));
        }
    }
    if (coloured > 0)
        map.repairs.push_back(fmt::format(
            "{} texels of the PNG file are coloured; their height is 0.2126 R + 0.7152 G + 0.0722 B.", coloured));
    if (not_opaque > 0)
        map.repairs.push_back(fmt::format("{} texels of the PNG file are not opaque; alpha was ignored.", not_opaque));
}

}  // namespace

HeightMap read_png(const std::filesystem::path& path) {
    const std::string name = path.string();
    const std::uint64_t size = map_file_size(path);
    // Checked before libpng, whose message lacks the sizes: signature, IHDR's length and name, width, height.
    const std::string start = map_file_start(path, 24);
    if (start.size() == 24) {
        const auto* const bytes = reinterpret_cast<png_const_bytep>(start.data());
        check_map_sides(name, png_get_uint_32(bytes + 16), png_get_uint_32(bytes + 20));
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name.c_str(), "rb"), std::fclose);
    if (file == nullptr)
        throw InputError(fmt::format("{}: the map file cannot be opened.", name));
    Messages messages;
    const Decoder decoder(messages);
    if (decoder.info == nullptr)
        throw std::bad_alloc();
    if (!decode(decoder.png, decoder.info, file.get()))
        throw InputError(
            fmt::format("{}: libpng cannot read the PNG file: {}. It is damaged: save or download it again.", name,
                        printable_ascii(messages.error)));
    HeightMap map;
    map.width = static_cast<int>(png_get_image_width(decoder.png, decoder.info));
    map.height = static_cast<int>(png_get_image_height(decoder.png, decoder.info));
    map.values.resize(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
    convert(decoder, map);
    for (const std::string& warning : messages.warnings)
        map.repairs.push_back(fmt::format("libpng warning: {}.", printable_ascii(warning)));
    const std::uint64_t read = static_cast<std::uint64_t>(std::ftell(file.get()));
    if (read < size)
        map.repairs.push_back(fmt::format("{} bytes after the PNG file's end were ignored.", size - read));
    return map;
}

}  // namespace tessera

#include "testbench/maps/png_reader.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/maps/map_file.h"

namespace tessera {
namespace {

constexpr std::size_t most_warnings = 8;

std::uint32_t big_endian_32(const std::uint8_t* bytes) {
    return static_cast<std::uint32_t>(bytes[0]) << 24 | static_cast<std::uint32_t>(bytes[1]) << 16 |
           static_cast<std::uint32_t>(bytes[2]) << 8 | static_cast<std::uint32_t>(bytes[3]);
}

// libpng reports errors by longjmp. Every libpng call that can do so goes through guarded(), so no C++ frame
// with a destructor is jumped over; its callbacks keep the words for later.
class PngDecoder {
  public:
    explicit PngDecoder(const std::filesystem::path& path)
        : name_(path.string()), bytes_(map_file_bytes(path)) {}
    PngDecoder(const PngDecoder&) = delete;
    PngDecoder& operator=(const PngDecoder&) = delete;
    ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

    HeightMap decode();

  private:
    [[noreturn]] void refuse(std::string_view why) const {
        throw InputError(fmt::format("{}: {}", name_, why));
    }

    [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
        auto* const self = static_cast<PngDecoder*>(png_get_error_ptr(png));
        self->error_ = message;
        png_longjmp(png, 1);
    }

    static void on_warning(png_structp png, png_const_charp message) {
        auto* const self = static_cast<PngDecoder*>(png_get_error_ptr(png));
        if (self->warnings_.size() < most_warnings) {
            self->warnings_.push_back(printable_ascii(message));
        }
    }

    static void on_read(png_structp png, png_bytep target, std::size_t count) {
        auto* const self = static_cast<PngDecoder*>(png_get_io_ptr(png));
        if (count > self->bytes_.size() - self->position_) {
            png_error(png, "the file ends too early");
        }
        std::memcpy(target, self->bytes_.data() + self->position_, count);
        self->position_ += count;
    }

    template <class Call>
    bool jumped(Call& call) {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return true;
        }
        call();
        return false;
    }

    template <class Call>
    void guarded(Call call) {
        if (jumped(call)) {
            refuse(
                fmt::format("libpng cannot read the PNG file: {}. It is damaged: save or download it anew.",
                            printable_ascii(error_)));
        }
    }

    void check_claims() const;
    void check_chunk_lengths() const;
    void convert_row(const std::vector<std::uint8_t>& rows, std::size_t row_start, float* line);
    void add_remarks(HeightMap& map) const;

    std::string name_;
    std::vector<std::uint8_t> bytes_;
    std::size_t position_ = 0;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::string error_;
    std::vector<std::string> warnings_;

    std::size_t width_ = 0;
    std::size_t channels_ = 0;
    bool wide_ = false;  // 16-bit samples
    std::int64_t coloured_ = 0;
    std::int64_t not_opaque_ = 0;
    bool transparency_chunk_ = false;
};

// Before libpng sees the file: its own limit messages name no numbers.
void PngDecoder::check_claims() const {
    constexpr std::size_t header_end = 33;  // signature, IHDR
    if (bytes_.size() < header_end || std::memcmp(bytes_.data() + 12, "IHDR", 4) != 0) {
        refuse("the PNG file does not begin with a whole IHDR chunk. It was cut off or is damaged.");
    }
    const std::int64_t width = big_endian_32(bytes_.data() + 16);
    const std::int64_t height = big_endian_32(bytes_.data() + 20);
    check_map_sides(name_, width, height);

    const int depth = bytes_[24];
    const int colour_type = bytes_[25];
    const int samples = (colour_type & PNG_COLOR_MASK_PALETTE) != 0 ? 1
                        : (colour_type & PNG_COLOR_MASK_COLOR) != 0 ? 3
                                                                    : 1;
    const int alpha = (colour_type & PNG_COLOR_MASK_ALPHA) != 0 ? 1 : 0;
    const std::int64_t raw = (width * (samples + alpha) * depth / 8 + 1) * height;
    // Deflate shrinks to 1/1032 at best, so a small file cannot hold a large image.
    constexpr std::int64_t best_ratio = 1032;
    if (raw / best_ratio > static_cast<std::int64_t>(bytes_.size())) {
        refuse(fmt::format(
            "the PNG file claims {} x {} texels, but its {} bytes can hold no more than {} bytes of the {} "
            "needed. It was cut off, or its header is wrong.",
            width, height, bytes_.size(), static_cast<std::int64_t>(bytes_.size()) * best_ratio, raw));
    }
}

// libpng allocates an ancillary chunk's stated length, up to 2 GiB, before it reads the chunk, whatever
// png_set_chunk_malloc_max() says.
void PngDecoder::check_chunk_lengths() const {
    constexpr std::size_t frame = 12;  // length, name, CRC
    for (std::size_t at = 8; bytes_.size() - at >= frame;) {
        const std::size_t length = big_endian_32(bytes_.data() + at);
        const std::string_view name(reinterpret_cast<const char*>(bytes_.data()) + at + 4, 4);
        const std::size_t left = bytes_.size() - at - frame;
        if (length > left) {
            refuse(fmt::format(
                "the PNG file's chunk {} claims {} bytes, but {} are left in the file. It was cut off or is "
                "damaged.",
                printable_ascii(name), length, left));
        }
        if (name == "IEND") {
            return;
        }
        at += frame + length;
    }
    refuse("the PNG file has no IEND chunk. It was cut off.");
}

void PngDecoder::convert_row(const std::vector<std::uint8_t>& rows, std::size_t row_start, float* line) {
    const std::size_t sample_size = wide_ ? 2 : 1;
    const std::uint32_t maximum = wide_ ? 65535 : 255;
    const auto sample = [&](std::size_t index) -> std::uint32_t {
        const std::uint8_t* const at = rows.data() + row_start + index * sample_size;
        return wide_ ? static_cast<std::uint32_t>(at[0]) << 8 | at[1] : at[0];
    };
    const bool colour = channels_ >= 3;
    const bool alpha = channels_ % 2 == 0;
    for (std::size_t x = 0; x < width_; ++x) {
        const std::size_t first = x * channels_;
        if (alpha && sample(first + channels_ - 1) != maximum) {
            ++not_opaque_;
        }
        std::uint32_t weighted = 10000 * sample(first);
        if (colour) {
            const std::uint32_t r = sample(first);
            const std::uint32_t g = sample(first + 1);
            const std::uint32_t b = sample(first + 2);
            weighted = 2126 * r + 7152 * g + 722 * b;
            coloured_ += r != g || g != b ? 1 : 0;
        }
        line[x] =
            static_cast<float>(static_cast<double>(weighted) / (10000.0 * static_cast<double>(maximum)));
    }
}

void PngDecoder::add_remarks(HeightMap& map) const {
    if (coloured_ > 0) {
        map.repairs.push_back(fmt::format(
            "{} texels of the PNG file are coloured; their height is 0.2126 R + 0.7152 G + 0.0722 B.",
            coloured_));
    }
    if (not_opaque_ > 0) {
        map.repairs.push_back(
            fmt::format("{} texels of the PNG file are not opaque; alpha was ignored.", not_opaque_));
    } else if (transparency_chunk_) {
        map.repairs.push_back("The PNG file's transparent colour (tRNS) was ignored.");
    }
    for (const std::string& warning : warnings_) {
        map.repairs.push_back(fmt::format("libpng warns: {}.", warning));
    }
    if (position_ < bytes_.size()) {
        map.repairs.push_back(
            fmt::format("{} bytes after the PNG file's end were ignored.", bytes_.size() - position_));
    }
}

HeightMap PngDecoder::decode() {
    check_claims();
    check_chunk_lengths();
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ != nullptr) {
        info_ = png_create_info_struct(png_);
    }
    if (info_ == nullptr) {
        throw std::bad_alloc();
    }
    int passes = 1;
    std::size_t row_bytes = 0;
    guarded([&] {
        png_set_read_fn(png_, this, on_read);
        png_set_user_limits(png_, largest_map_side, largest_map_side);
        png_set_chunk_malloc_max(png_, 8U << 20);
        // Of ancillary chunks only tRNS is looked at: a damaged colour profile, or comment, is no reason to refuse.
        png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_WARN_DISCARD);
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_read_info(png_, info_);
        transparency_chunk_ = png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
        if (png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE) {
            png_set_palette_to_rgb(png_);
        } else if (png_get_bit_depth(png_, info_) < 8) {
            png_set_expand_gray_1_2_4_to_8(png_);
        }
        passes = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        row_bytes = png_get_rowbytes(png_, info_);
    });
    HeightMap map;
    map.width = static_cast<int>(png_get_image_width(png_, info_));
    map.height = static_cast<int>(png_get_image_height(png_, info_));
    width_ = static_cast<std::size_t>(map.width);
    channels_ = png_get_channels(png_, info_);
    wide_ = png_get_bit_depth(png_, info_) == 16;
    map.source_units = wide_ ? 65535 : 255;
    const auto height = static_cast<std::size_t>(map.height);
    map.values.resize(width_ * height);

    // Only an interlaced image needs all its rows at once.
    const bool all_rows = passes > 1;
    std::vector<std::uint8_t> rows(row_bytes * (all_rows ? height : 1));
    for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t row = 0; row < height; ++row) {
            const std::size_t row_start = all_rows ? row * row_bytes : 0;
            guarded([&] { png_read_row(png_, rows.data() + row_start, nullptr); });
            if (pass == passes - 1) {
                convert_row(rows, row_start, map.values.data() + (height - 1 - row) * width_);
            }
        }
    }
    guarded([&] { png_read_end(png_, nullptr); });
    add_remarks(map);
    return map;
}

}  // namespace

HeightMap read_png(const std::filesystem::path& path) {
    return PngDecoder(path).decode();
}

}  // namespace tessera

#include "testbench/input/map/exr_check.h"

#include <fmt/format.h>
#include <openexr.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "testbench/common/error.h"
#include "testbench/input/map/map_file.h"
#include "testbench/setup/height_map.h"

namespace tessera {
namespace {

// Limits on decoded bytes of all channels, since all are decoded. OpenEXR keeps about three copies of a chunk (a block
// of scan lines or a tile); the largest image, 16 float channels of 4096 x 4096 texels, takes some seconds.
constexpr std::int64_t largest_chunk = 32 << 20, largest_image = 1 << 30;

struct DecodePipeline : exr_decode_pipeline_t {
    DecodePipeline() : exr_decode_pipeline_t{} {}
    DecodePipeline(const DecodePipeline&) = delete;
    DecodePipeline& operator=(const DecodePipeline&) = delete;
    ~DecodePipeline() { exr_decoding_destroy(context, this); }
};

class ExrFile {
  public:
    ExrFile(const std::filesystem::path& path, int flags);
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;
    ~ExrFile() { exr_finish(&file_); }

    void check_header(bool has_display_window);
    void check_chunks() const;

    const PixelWindow& image() const { return image_; }
    /// What the windows mean for the map; empty if they are the same.
    std::string windows_remark() const;

  private:
    void read_windows(bool has_display_window);

    [[noreturn]] void refuse(std::string_view why) const { throw InputError(fmt::format("{}: {}", name_, why)); }

    // Keeps the first message: later ones report where the library stopped, not why.
    static void on_error(exr_const_context_t file, exr_result_t, const char* message) {
        void* kept = nullptr;
        if (exr_get_user_data(file, &kept) == EXR_ERR_SUCCESS && static_cast<std::string*>(kept)->empty())
            *static_cast<std::string*>(kept) = message;
    }

    void check(exr_result_t result) const {
        if (result != EXR_ERR_SUCCESS)
            refuse(fmt::format(
                "OpenEXR cannot read the file: {}. It is damaged or was cut off: save or download it again.",
                printable_ascii(message_.empty() ? exr_get_default_error_message(result) : message_)));
    }

    std::string name_;
    std::string message_;
    exr_context_t file_ = nullptr;
    bool tiled_ = false;
    PixelWindow data_, image_;
    std::int64_t width_ = 0, height_ = 0;  // of the data
    std::int64_t chunk_width_ = 0, chunk_height_ = 0;
};

std::string text_of(const PixelWindow& window) {
    return fmt::format("{} x {} at ({}, {})", window.width(), window.height(), window.left, window.top);
}

PixelWindow common(const PixelWindow& a, const PixelWindow& b) {
    return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

ExrFile::ExrFile(const std::filesystem::path& path, int flags) : name_(path.string()) {
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    settings.error_handler_fn = on_error;
    settings.user_data = &message_;
    settings.max_tile_width = settings.max_tile_height = largest_map_side;
    settings.flags = flags;
    check(exr_start_read(&file_, name_.c_str(), &settings));
}

void ExrFile::check_header(bool has_display_window) {
    int parts = 0;
    exr_storage_t storage{};
    const exr_attr_chlist_t* channels = nullptr;
    check(exr_get_count(file_, &parts));
    check(exr_get_storage(file_, 0, &storage));
    check(exr_get_channels(file_, 0, &channels));
    if (parts != 1)
        refuse("the EXR file has several parts. Save the part with the heights as a separate file.");
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        refuse(
            "the EXR file holds deep data, several samples per pixel. Flatten it and save one scan-line or "
            "tiled image.");
    tiled_ = storage == EXR_STORAGE_TILED;
    read_windows(has_display_window);
    if (tiled_) {
        std::uint32_t across = 0, down = 0;
        exr_tile_level_mode_t levels{};
        exr_tile_round_mode_t rounding{};
        check(exr_get_tile_descriptor(file_, 0, &across, &down, &levels, &rounding));
        chunk_width_ = across;
        chunk_height_ = down;
    } else {
        std::int32_t lines = 0;
        check(exr_get_scanlines_per_chunk(file_, 0, &lines));
        chunk_width_ = width_;
        chunk_height_ = lines;
    }
    std::int64_t texel = 0;
    for (int k = 0; k < channels->num_channels; ++k)
        texel += channels->entries[k].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    for (const auto& [what, bytes, limit] :
         {std::tuple{"one chunk", chunk_width_ * chunk_height_ * texel, largest_chunk},
          std::tuple{"the image", width_ * height_ * texel, largest_image}})
        if (bytes > limit)
            refuse(
                fmt::format("{} of the EXR file has {} bytes when decoded, in {} channels; the limit is {}. Save the "
                            "channel with the heights only, as scan lines.",
                            what, bytes, channels->num_channels, limit));
}

void ExrFile::read_windows(bool has_display_window) {
    const auto window = [](const exr_attr_box2i_t& box) {
        return PixelWindow{box.min.x, box.min.y, box.max.x, box.max.y};
    };
    exr_attr_box2i_t box{};
    check(exr_get_data_window(file_, 0, &box));
    data_ = image_ = window(box);
    width_ = data_.width();
    height_ = data_.height();
    if (has_display_window) {  // else OpenEXR returns a default
        check(exr_get_display_window(file_, 0, &box));
        image_ = window(box);
    }
    check_map_sides(name_, image_.width(), image_.height());
    constexpr std::int64_t overscan = 2;
    if (width_ < 1 || height_ < 1 || width_ > overscan * largest_map_side || height_ > overscan * largest_map_side)
        refuse(
            fmt::format("the EXR file's data window is {}; each side must be 1 to {}. Save it cropped to its display "
                        "window, {}.",
                        text_of(data_), overscan * largest_map_side, text_of(image_)));
    const PixelWindow both = common(data_, image_);
    if (both.width() < 1 || both.height() < 1)
        refuse(
            fmt::format("the EXR file's data window, {}, lies outside its display window, {}, which is the image: it "
                        "has no pixel. Save it with a display window around its pixels.",
                        text_of(data_), text_of(image_)));
}

std::string ExrFile::windows_remark() const {
    const PixelWindow both = common(data_, image_);
    const std::int64_t stored = both.width() * both.height();
    const std::int64_t empty = image_.width() * image_.height() - stored, cropped = width_ * height_ - stored;
    if (empty == 0 && cropped == 0)
        return {};
    return fmt::format("The map is the EXR file's display window, {}; its data window is {}: {}{}{}.", text_of(image_),
                       text_of(data_), empty > 0 ? fmt::format("{} texels without data are 0", empty) : "",
                       empty > 0 && cropped > 0 ? ", " : "",
                       cropped > 0 ? fmt::format("{} pixels outside were cropped", cropped) : "");
}

void ExrFile::check_chunks() const {
    exr_chunk_info_t chunk{};
    for (std::int64_t y = 0; y * chunk_height_ < height_; ++y)
        for (std::int64_t x = 0; x * chunk_width_ < width_; ++x) {
            check(tiled_ ? exr_read_tile_chunk_info(file_, 0, static_cast<int>(x), static_cast<int>(y), 0, 0, &chunk)
                         : exr_read_scanline_chunk_info(file_, 0, data_.top + static_cast<int>(y * chunk_height_),
                                                        &chunk));
            if (chunk.compression == EXR_COMPRESSION_NONE && chunk.packed_size != chunk.unpacked_size)
                refuse(
                    fmt::format("a chunk of the EXR file holds {} bytes of pixels of {}. It is damaged: save or "
                                "download it again.",
                                chunk.packed_size, chunk.unpacked_size));
            if (chunk.compression == EXR_COMPRESSION_RLE || chunk.compression == EXR_COMPRESSION_ZIPS ||
                chunk.compression == EXR_COMPRESSION_ZIP) {
                DecodePipeline pipeline;
                check(exr_decoding_initialize(file_, 0, &chunk, &pipeline));
                check(exr_decoding_choose_default_routines(file_, 0, &pipeline));
                check(exr_decoding_run(file_, 0, &pipeline));
            }
        }
}

}  // namespace

ExrCheck check_exr(const std::filesystem::path& path) {
    const auto check = [&path](int flags, const std::string& remark = {}, bool has_display_window = true) {
        ExrFile file(path, flags);
        file.check_header(has_display_window);
        file.check_chunks();
        ExrCheck result{file.image(), {}};
        for (const std::string& text : {remark, file.windows_remark()})
            if (!text.empty())
                result.remarks.push_back(text);
        return result;
    };
    std::string problem;
    try {
        return check(EXR_CONTEXT_FLAG_STRICT_HEADER | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION);
    } catch (const InputError& error) {
        problem = error.what();
    }
    const auto says = [&problem](const std::string& words) { return problem.find(words) != std::string::npos; };
    if (says("recorded at file offset 0."))
        return check(EXR_CONTEXT_FLAG_STRICT_HEADER,
                     "The EXR file's offset table is incomplete (its writer did not finish); the pixels were all "
                     "found.");
    for (const char* const name : {"displayWindow", "pixelAspectRatio", "screenWindowCenter", "screenWindowWidth"})
        if (says(fmt::format("'{}' attribute not found", name)))
            return check(EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION,
                         fmt::format("The EXR header lacks the required attribute {}; {}.", name,
                                     name == std::string_view("displayWindow") ? "the map is the data window"
                                                                               : "the map does not depend on it"),
                         name != std::string_view("displayWindow"));
    throw InputError(problem);
}

}  // namespace tessera

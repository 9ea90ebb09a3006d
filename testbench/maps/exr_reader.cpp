#include "testbench/maps/exr_reader.h"

#include <fmt/format.h>
#include <half.h>
#include <openexr.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/maps/map_file.h"
#include "testbench/maps/repair_non_finite.h"

namespace tessera {
namespace {

// Decoded bytes, of all channels: every one is decoded, wanted or not. OpenEXR keeps three copies of a chunk (a block of
// scan lines, a tile); the largest image, 16 float channels of 4096 x 4096 texels, takes some seconds.
constexpr std::int64_t largest_chunk = 32 << 20, largest_image = 1 << 30;

struct DecodePipeline : exr_decode_pipeline_t {
    explicit DecodePipeline(exr_const_context_t file) : exr_decode_pipeline_t{}, file(file) {}
    DecodePipeline(const DecodePipeline&) = delete;
    DecodePipeline& operator=(const DecodePipeline&) = delete;
    ~DecodePipeline() { exr_decoding_destroy(file, this); }
    exr_const_context_t file;
};

class ExrFile {
  public:
    ExrFile(const std::filesystem::path& path, int flags);
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;
    ~ExrFile() { exr_finish(&file_); }

    HeightMap read(const std::string& wanted);

  private:
    [[noreturn]] void refuse(std::string_view why) const {
        throw InputError(fmt::format("{}: {}", name_, why));
    }

    // Keeps the first message: those that follow say where the library gave up, not why.
    static void on_error(exr_const_context_t file, exr_result_t, const char* message) {
        void* kept = nullptr;
        if (exr_get_user_data(file, &kept) == EXR_ERR_SUCCESS && static_cast<std::string*>(kept)->empty())
            *static_cast<std::string*>(kept) = message;
    }

    void check(exr_result_t result) const {
        if (result != EXR_ERR_SUCCESS)
            refuse(fmt::format(
                "OpenEXR cannot read the file: {}. It is damaged or was cut off: save or download it anew.",
                printable_ascii(message_.empty() ? exr_get_default_error_message(result) : message_)));
    }

    int choose_channel(const exr_attr_chlist_t& channels, const std::string& wanted) const;
    void check_size(const exr_chunk_info_t& chunk) const;
    void decode(const exr_chunk_info_t& chunk, int channel, int left, int top, HeightMap& map) const;

    std::string name_;
    std::string message_;
    exr_context_t file_ = nullptr;
};

ExrFile::ExrFile(const std::filesystem::path& path, int flags) : name_(path.string()) {
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    settings.error_handler_fn = on_error;
    settings.user_data = &message_;
    settings.flags = flags;
    check(exr_start_read(&file_, name_.c_str(), &settings));
}

int ExrFile::choose_channel(const exr_attr_chlist_t& channels, const std::string& wanted) const {
    std::vector<std::string> names;
    for (int k = 0; k < channels.num_channels; ++k)
        names.emplace_back(channels.entries[k].name.str);
    const auto list = [&names] { return printable_ascii(fmt::format("{}", fmt::join(names, ", "))); };
    for (const std::string& name :
         wanted.empty() ? std::vector<std::string>{"Y", "R"} : std::vector<std::string>{wanted}) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found != names.end())
            return static_cast<int>(found - names.begin());
    }
    if (!wanted.empty())
        refuse(fmt::format("the EXR file has no channel \"{}\"; it has: {}. Set map.channel to one of these.",
                           printable_ascii(wanted), list()));
    if (names.size() != 1)
        refuse(
            fmt::format("the EXR file has neither a channel Y nor R, and more than one: {}. Set map.channel "
                        "to the one with the heights.",
                        list()));
    return 0;
}

void ExrFile::check_size(const exr_chunk_info_t& chunk) const {
    if (chunk.unpacked_size > std::uint64_t{largest_chunk})
        refuse(
            fmt::format("one chunk of the EXR file has {} bytes when decoded, all channels together; the "
                        "limit is {}. Save it with one channel, as scan lines.",
                        chunk.unpacked_size, largest_chunk));
    // The one shortfall that OpenEXR 3.1 does not notice: it would take what lies in memory for the pixels.
    if (chunk.compression == EXR_COMPRESSION_NONE && chunk.packed_size != chunk.unpacked_size)
        refuse(
            fmt::format("a chunk of the EXR file holds {} bytes of pixels of {}. It is damaged: save or "
                        "download it anew.",
                        chunk.packed_size, chunk.unpacked_size));
}

float float_of(std::uint32_t sample, exr_pixel_type_t type) {
    float value = 0;
    switch (type) {
        case EXR_PIXEL_UINT:
            return static_cast<float>(sample);
        case EXR_PIXEL_HALF:
            return Imath::half(Imath::half::FromBits, static_cast<std::uint16_t>(sample));
        default:
            std::memcpy(&value, &sample, sizeof value);
            return value;
    }
}

// left, top: the chunk's first texel, rows counted from the top.
void ExrFile::decode(const exr_chunk_info_t& chunk, int channel, int left, int top, HeightMap& map) const {
    check_size(chunk);
    // One sample every four bytes in its own type: where OpenEXR 3.1 converts half to float, it wants all channels.
    std::vector<std::uint32_t> samples(static_cast<std::size_t>(chunk.width) *
                                       static_cast<std::size_t>(chunk.height));
    DecodePipeline pipeline(file_);
    check(exr_decoding_initialize(file_, 0, &chunk, &pipeline));
    exr_coding_channel_info_t& wanted = pipeline.channels[channel];
    wanted.decode_to_ptr = reinterpret_cast<std::uint8_t*>(samples.data());
    wanted.user_pixel_stride = sizeof(std::uint32_t);
    wanted.user_line_stride = chunk.width * wanted.user_pixel_stride;
    check(exr_decoding_choose_default_routines(file_, 0, &pipeline));
    check(exr_decoding_run(file_, 0, &pipeline));
    const std::uint32_t* sample = samples.data();
    for (int y = 0; y < chunk.height; ++y)
        for (int x = 0; x < chunk.width; ++x)
            map.at(left + x, map.height - 1 - top - y) =
                float_of(*sample++, static_cast<exr_pixel_type_t>(wanted.data_type));
}

void add_remarks(const exr_attr_chlist_entry_t& channel, HeightMap& map) {
    if (channel.pixel_type == EXR_PIXEL_UINT) {
        map.repairs.push_back(
            fmt::format("Channel {} holds 32-bit unsigned integers; they were converted to float, which is "
                        "exact up to 16777216.",
                        printable_ascii(channel.name.str)));
        return;
    }
    const float smallest_normal = channel.pixel_type == EXR_PIXEL_HALF ? 0x1p-14F : 0x1p-126F;
    const auto subnormal = std::count_if(
        map.values.begin(), map.values.end(),
        [smallest_normal](float value) { return value != 0 && std::fabs(value) < smallest_normal; });
    if (subnormal > 0)
        map.repairs.push_back(
            fmt::format("{} texel{} hold{} subnormal numbers (below {:.3g}); kept as they are.", subnormal,
                        subnormal == 1 ? "" : "s", subnormal == 1 ? "s" : "", smallest_normal));
}

HeightMap ExrFile::read(const std::string& wanted) {
    int parts = 0;
    check(exr_get_count(file_, &parts));
    exr_storage_t storage{};
    check(exr_get_storage(file_, 0, &storage));
    if (parts != 1)
        refuse("the EXR file has several parts. Save the part with the heights as a file of its own.");
    const bool tiled = storage == EXR_STORAGE_TILED;
    if (!tiled && storage != EXR_STORAGE_SCANLINE)
        refuse(
            "the EXR file holds deep data, several samples per pixel. Flatten it and save one scan-line or "
            "tiled image.");
    exr_attr_box2i_t window{};
    check(exr_get_data_window(file_, 0, &window));
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    check_map_sides(name_, width, height);
    const exr_attr_chlist_t* channels = nullptr;
    check(exr_get_channels(file_, 0, &channels));
    const int number = choose_channel(*channels, wanted);
    const exr_attr_chlist_entry_t& channel = channels->entries[number];
    if (channel.x_sampling != 1 || channel.y_sampling != 1)
        refuse(fmt::format(
            "the EXR file's channel {} holds only every {} x {} pixel; a map needs one value per texel. "
            "Save it without subsampling.",
            printable_ascii(channel.name.str), channel.x_sampling, channel.y_sampling));
    std::int64_t texel = 0;  // bytes
    for (int k = 0; k < channels->num_channels; ++k)
        texel += channels->entries[k].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    if (width * height * texel > largest_image)
        refuse(fmt::format(
            "the EXR file's {} channels have {} bytes when decoded; the limit is {}. Save the channel with "
            "the heights alone.",
            channels->num_channels, width * height * texel, largest_image));

    HeightMap map;
    map.width = static_cast<int>(width);
    map.height = static_cast<int>(height);
    map.values.resize(static_cast<std::size_t>(width * height));
    exr_chunk_info_t chunk{};
    if (tiled) {
        std::uint32_t tile_width = 0, tile_height = 0;
        exr_tile_level_mode_t levels{};
        exr_tile_round_mode_t rounding{};
        check(exr_get_tile_descriptor(file_, 0, &tile_width, &tile_height, &levels, &rounding));
        for (std::int64_t top = 0; top < height; top += tile_height)
            for (std::int64_t left = 0; left < width; left += tile_width) {
                check(exr_read_tile_chunk_info(file_, 0, static_cast<int>(left / tile_width),
                                               static_cast<int>(top / tile_height), 0, 0, &chunk));
                decode(chunk, number, static_cast<int>(left), static_cast<int>(top), map);
            }
    } else {
        std::int32_t lines = 0;
        check(exr_get_scanlines_per_chunk(file_, 0, &lines));
        for (int top = 0; top < map.height; top += lines) {
            check(exr_read_scanline_chunk_info(file_, 0, window.min.y + top, &chunk));
            decode(chunk, number, 0, top, map);
        }
    }
    if (!repair_non_finite(map))
        refuse(fmt::format(
            "all {} texels of the EXR file's channel {} are NaN or infinite; a map needs finite heights.",
            map.values.size(), printable_ascii(channel.name.str)));
    add_remarks(channel, map);
    return map;
}

}  // namespace

HeightMap read_exr(const std::filesystem::path& path, const std::string& channel) {
    constexpr int strict = EXR_CONTEXT_FLAG_STRICT_HEADER;
    try {
        return ExrFile(path, strict | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION).read(channel);
    } catch (const InputError&) {
        // A writer that did not finish leaves an offset table of zeros: OpenEXR then looks for the chunks.
        HeightMap map = ExrFile(path, strict).read(channel);
        map.repairs.emplace_back(
            "The EXR file's offset table is damaged (or its writer did not finish); the pixels were all "
            "found.");
        return map;
    }
}

}  // namespace tessera

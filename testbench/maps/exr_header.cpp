#include "testbench/maps/exr_header.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "testbench/common/error.h"
#include "testbench/maps/height_map.h"
#include "testbench/maps/map_file.h"

namespace tessera {
namespace {

constexpr std::uint32_t flag_tiled = 0x200;
constexpr std::uint32_t flag_deep = 0x800;
constexpr std::uint32_t flag_multi_part = 0x1000;

// Attribute types of fixed size. libOpenEXR reads these many bytes whatever size the file states, and from
// then on takes values for names and sizes if the two differ.
struct FixedSize {
    std::string_view type;
    std::uint32_t size;
};
constexpr FixedSize fixed_sizes[] = {
    {"box2f", 16},
    {"box2i", 16},
    {"chromaticities", 32},
    {"compression", 1},
    {"deepImageState", 1},
    {"double", 8},
    {"envmap", 1},
    {"float", 4},
    {"int", 4},
    {"keycode", 28},
    {"lineOrder", 1},
    {"m33d", 72},
    {"m33f", 36},
    {"m44d", 128},
    {"m44f", 64},
    {"rational", 8},
    {"tiledesc", 9},
    {"timecode", 8},
    {"v2d", 16},
    {"v2f", 8},
    {"v2i", 8},
    {"v3d", 24},
    {"v3f", 12},
    {"v3i", 12},
};

struct Required {
    std::string_view name;
    std::string_view type;
    bool decides;  // the pixels cannot be read without it
};
constexpr Required required_attributes[] = {
    {"channels", "chlist", true},         {"compression", "compression", true},
    {"dataWindow", "box2i", true},        {"lineOrder", "lineOrder", true},
    {"displayWindow", "box2i", false},    {"pixelAspectRatio", "float", false},
    {"screenWindowCenter", "v2f", false}, {"screenWindowWidth", "float", false},
};

// best_ratio: how far a block can shrink at best; 0: no useful bound.
struct Compression {
    std::string_view name;
    std::uint32_t lines;
    std::uint64_t best_ratio;
};
constexpr Compression compressions[] = {
    {"none", 1, 1},      {"RLE", 1, 64}, {"ZIPS", 1, 1032}, {"ZIP", 16, 1032}, {"PIZ", 32, 0},
    {"PXR24", 16, 1376}, {"B44", 32, 0}, {"B44A", 32, 0},   {"DWAA", 32, 0},   {"DWAB", 256, 0},
};

constexpr std::uint32_t pixel_type_sizes[] = {4, 2, 4};

std::uint32_t little_endian_32(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    }
    return value;
}

class HeaderReader {
  public:
    explicit HeaderReader(const std::filesystem::path& path)
        : name_(path.string()), file_size_(map_file_size(path)), file_(path, std::ios::binary) {}

    ExrHeader read();

  private:
    [[noreturn]] void refuse(std::string_view why) const {
        throw InputError(fmt::format("{}: {}", name_, why));
    }
    std::uint64_t remaining() const { return file_size_ - position_; }

    std::string bytes(std::uint64_t count) {
        if (count > remaining()) {
            refuse("the EXR file ends inside its header. It was cut off.");
        }
        std::string result(static_cast<std::size_t>(count), '\0');
        file_.read(result.data(), static_cast<std::streamsize>(count));
        if (!file_) {
            refuse("the EXR file's header cannot be read.");
        }
        position_ += count;
        return result;
    }

    std::uint32_t word() { return little_endian_32(bytes(4), 0); }

    std::string text(std::string_view what) {
        std::string result;
        for (;;) {
            const char c = bytes(1)[0];
            if (c == '\0') {
                return result;
            }
            result += c;
            if (result.size() > 255) {
                refuse(fmt::format(
                    "the EXR file has {} of more than 255 characters, beginning \"{}\". It is damaged.", what,
                    printable_ascii(result.substr(0, 32))));
            }
        }
    }

    void read_version();
    void read_attribute(const std::string& name);
    std::vector<ExrChannel> channels_of(std::string_view list) const;
    void check_preview(const std::string& name, std::string_view preview) const;
    void check_texts(const std::string& name, std::string_view texts) const;
    void read_window(std::string_view box);
    void check_present() const;
    void check_claims() const;
    std::uint64_t chunk_bytes(std::uint64_t i) const;
    void check_chunks();
    std::uint64_t chunk_count() const;
    std::uint64_t block_bytes() const;

    std::string name_;
    std::uint64_t file_size_;
    std::ifstream file_;
    std::uint64_t position_ = 0;
    std::set<std::string> names_;
    ExrHeader header_;
};

void HeaderReader::read_version() {
    bytes(4);  // magic
    const std::uint32_t field = word();
    if ((field & 0xff) != 2) {
        refuse(fmt::format("the EXR file has format version {}; version 2 is read.", field & 0xff));
    }
    if ((field & flag_deep) != 0) {
        refuse(
            "the EXR file holds deep data, several samples per pixel. Flatten it and save one scan-line or "
            "tiled image.");
    }
    if ((field & flag_multi_part) != 0) {
        refuse("the EXR file has several parts. Save the part with the heights as a file of its own.");
    }
    header_.tiled = (field & flag_tiled) != 0;
}

std::vector<ExrChannel> HeaderReader::channels_of(std::string_view list) const {
    std::vector<ExrChannel> channels;
    std::size_t at = 0;
    const auto damaged = [this] { refuse("the EXR file's channel list is damaged."); };
    for (;;) {
        const std::size_t end = list.find('\0', at);
        if (end == std::string_view::npos) {
            damaged();
        }
        if (end == at) {
            break;
        }
        ExrChannel channel;
        channel.name = std::string(list.substr(at, end - at));
        at = end + 1;
        if (list.size() - at < 16) {
            damaged();
        }
        const std::uint32_t type = little_endian_32(list, at);
        channel.x_sampling = static_cast<std::int32_t>(little_endian_32(list, at + 8));
        channel.y_sampling = static_cast<std::int32_t>(little_endian_32(list, at + 12));
        at += 16;
        if (type >= std::size(pixel_type_sizes)) {
            refuse(
                fmt::format("the EXR file's channel \"{}\" has the unknown pixel type {}; 0, 1, 2 (uint, "
                            "half, float) exist.",
                            printable_ascii(channel.name), type));
        }
        if (channel.x_sampling < 1 || channel.y_sampling < 1) {
            refuse(fmt::format("the EXR file's channel \"{}\" has the impossible sampling {} x {}.",
                               printable_ascii(channel.name), channel.x_sampling, channel.y_sampling));
        }
        channel.type = static_cast<int>(type);
        channels.push_back(channel);
    }
    if (at + 1 != list.size()) {
        damaged();
    }
    return channels;
}

void HeaderReader::check_preview(const std::string& name, std::string_view preview) const {
    constexpr std::size_t sides = 8, pixel = 4;
    const bool whole = preview.size() >= sides &&
                       std::uint64_t{little_endian_32(preview, 0)} * little_endian_32(preview, 4) ==
                           (preview.size() - sides) / pixel &&
                       preview.size() % pixel == 0;
    if (!whole) {
        refuse(fmt::format(
            "the EXR file's attribute \"{}\", a preview, is not of the size it states. It is damaged.",
            printable_ascii(name)));
    }
}

void HeaderReader::check_texts(const std::string& name, std::string_view texts) const {
    while (!texts.empty()) {
        const std::size_t length = texts.size() < 4 ? texts.size() : little_endian_32(texts, 0);
        if (texts.size() < 4 || length > texts.size() - 4) {
            refuse(fmt::format(
                "the EXR file's attribute \"{}\", a list of texts, is not of the size it states. It is "
                "damaged.",
                printable_ascii(name)));
        }
        texts.remove_prefix(4 + length);
    }
}

void HeaderReader::read_window(std::string_view box) {
    std::array<std::int32_t, 4> corner{};
    for (std::size_t i = 0; i < 4; ++i) {
        corner[i] = static_cast<std::int32_t>(little_endian_32(box, 4 * i));
    }
    header_.left = corner[0];
    header_.top = corner[1];
    header_.width = static_cast<std::int64_t>(corner[2]) - corner[0] + 1;
    header_.height = static_cast<std::int64_t>(corner[3]) - corner[1] + 1;
    check_map_sides(name_, header_.width, header_.height);
}

void HeaderReader::read_attribute(const std::string& name) {
    const std::string type = text("an attribute's type name");
    const std::uint32_t size = word();
    if (!names_.insert(name).second) {
        refuse(fmt::format("the EXR file's header has the attribute \"{}\" twice. It is damaged.",
                           printable_ascii(name)));
    }
    if (size > remaining()) {
        refuse(
            fmt::format("the EXR file's attribute \"{}\" claims {} bytes, but {} are left in the file. It "
                        "was cut off or is "
                        "damaged.",
                        printable_ascii(name), static_cast<std::int32_t>(size), remaining()));
    }
    for (const FixedSize& fixed : fixed_sizes) {
        if (fixed.type == type && fixed.size != size) {
            refuse(
                fmt::format("the EXR file's attribute \"{}\" of type {} claims {} bytes; that type has {}. "
                            "It is damaged.",
                            printable_ascii(name), type, size, fixed.size));
        }
    }
    if (type == "floatvector" && size % 4 != 0) {
        refuse(fmt::format(
            "the EXR file's attribute \"{}\" of type floatvector claims {} bytes, no multiple of 4. It is "
            "damaged.",
            printable_ascii(name), size));
    }
    for (const Required& required : required_attributes) {
        if (required.name == name && required.type != type) {
            refuse(fmt::format("the EXR file's attribute \"{}\" has type \"{}\"; it must be {}.", name,
                               printable_ascii(type), required.type));
        }
    }
    if (name == "tiles" && type != "tiledesc") {
        refuse(fmt::format("the EXR file's attribute \"tiles\" has type \"{}\"; it must be tiledesc.",
                           printable_ascii(type)));
    }
    const bool wanted = name == "compression" || name == "dataWindow" || name == "tiles";
    // Types of which libOpenEXR reads as many bytes as their content says, whatever size the file states.
    const bool sized_by_content = type == "chlist" || type == "preview" || type == "stringvector";
    if (!wanted && !sized_by_content) {
        file_.seekg(size, std::ios::cur);
        position_ += size;
        return;
    }
    const std::string value = bytes(size);
    if (type == "chlist") {
        std::vector<ExrChannel> channels = channels_of(value);
        if (name == "channels") {
            header_.channels = std::move(channels);
        }
    } else if (type == "preview") {
        check_preview(name, value);
    } else if (type == "stringvector") {
        check_texts(name, value);
    } else if (name == "compression") {
        header_.compression = static_cast<unsigned char>(value[0]);
    } else if (name == "dataWindow") {
        read_window(value);
    } else {
        header_.tile_width = little_endian_32(value, 0);
        header_.tile_height = little_endian_32(value, 4);
        const int mode = static_cast<unsigned char>(value[8]);
        if ((mode & 0x0f) > 2 || (mode >> 4) > 1) {
            refuse(fmt::format(
                "the EXR file's tile mode is {:#04x}; levels 0 to 2 and rounding 0 or 1 exist.", mode));
        }
    }
}

void HeaderReader::check_present() const {
    for (const Required& required : required_attributes) {
        if (required.decides && names_.count(std::string(required.name)) == 0) {
            refuse(fmt::format(
                "the EXR file's header has no attribute \"{}\", without which its pixels cannot be read.",
                required.name));
        }
    }
    if (header_.channels.empty()) {
        refuse("the EXR file has no channels, so it holds no map.");
    }
    if (header_.tiled && names_.count("tiles") == 0) {
        refuse("the EXR file is marked as tiled but has no attribute \"tiles\". It is damaged.");
    }
    if (static_cast<std::size_t>(header_.compression) >= std::size(compressions)) {
        refuse(fmt::format(
            "the EXR file's compression has the unknown number {}; 0 to {} are read. Save it with ZIP.",
            header_.compression, std::size(compressions) - 1));
    }
    // libOpenEXR wants 0 or greater for what it would divide by, but tests only part of it.
    if (header_.tiled && (header_.tile_width < 1 || header_.tile_height < 1 ||
                          header_.tile_width > static_cast<std::uint32_t>(largest_map_side) ||
                          header_.tile_height > static_cast<std::uint32_t>(largest_map_side))) {
        refuse(
            fmt::format("the EXR file's tiles are {} x {} texels; each side must be 1 to {}. Save it with "
                        "tiles of 64 x 64.",
                        header_.tile_width, header_.tile_height, largest_map_side));
    }
}

std::uint64_t HeaderReader::block_bytes() const {
    std::uint64_t bytes_per_pixel = 0;
    for (const ExrChannel& channel : header_.channels) {
        bytes_per_pixel += pixel_type_sizes[channel.type];
    }
    const std::uint64_t texels =
        header_.tiled ? static_cast<std::uint64_t>(header_.tile_width) * header_.tile_height
                      : static_cast<std::uint64_t>(header_.width) * compressions[header_.compression].lines;
    return bytes_per_pixel * texels;
}

std::uint64_t HeaderReader::chunk_count() const {
    const auto blocks = [](std::int64_t side, std::uint64_t block) {
        return (static_cast<std::uint64_t>(side) + block - 1) / block;
    };
    return header_.tiled
               ? blocks(header_.width, header_.tile_width) * blocks(header_.height, header_.tile_height)
               : blocks(header_.height, compressions[header_.compression].lines);
}

void HeaderReader::check_claims() const {
    const Compression& compression = compressions[header_.compression];
    const std::uint64_t block = block_bytes();
    if (block > largest_exr_block) {
        refuse(
            fmt::format("the EXR file's {} have {} bytes each when decoded, {} channels together; the limit "
                        "is {}. Save it "
                        "with one channel, and with {}.",
                        header_.tiled ? "tiles" : "blocks of scan lines", block, header_.channels.size(),
                        largest_exr_block, header_.tiled ? "tiles of 64 x 64" : "ZIP compression"));
    }
    const std::uint64_t chunks = chunk_count();
    const std::uint64_t chunk_overhead = 8 + (header_.tiled ? 20 : 8);  // offset; coordinates and size
    if (chunks * 8 > remaining()) {
        refuse(
            fmt::format("the EXR file's {} x {} texels need {} chunks, but the {} bytes after its header do "
                        "not even hold "
                        "their offsets. It was cut off, or its header is wrong.",
                        header_.width, header_.height, chunks, remaining()));
    }
    std::uint64_t raw = 0;
    for (const ExrChannel& channel : header_.channels) {
        raw += static_cast<std::uint64_t>(header_.width / channel.x_sampling) *
               static_cast<std::uint64_t>(header_.height / channel.y_sampling) *
               pixel_type_sizes[channel.type];
    }
    if (raw > largest_exr_image) {
        refuse(fmt::format(
            "the EXR file's {} channels have {} bytes of pixels when decoded; the limit is {}. Save the "
            "channel with the heights alone.",
            header_.channels.size(), raw, largest_exr_image));
    }
    const std::uint64_t overhead = chunks * chunk_overhead;
    const std::uint64_t payload = remaining() > overhead ? remaining() - overhead : 0;
    if (compression.best_ratio != 0 && raw / compression.best_ratio > payload) {
        refuse(
            fmt::format("the EXR file's {} x {} texels are {} bytes of pixels, more than {} bytes of "
                        "compression {} can hold. "
                        "It was cut off, or its header is wrong.",
                        header_.width, header_.height, raw, payload, compression.name));
    }
}

/// Bytes of pixels that chunk number i holds when decoded.
std::uint64_t HeaderReader::chunk_bytes(std::uint64_t i) const {
    const std::int64_t lines = compressions[header_.compression].lines;
    const std::int64_t across =
        header_.tiled ? (header_.width + header_.tile_width - 1) / header_.tile_width : 1;
    const std::int64_t wide = header_.tiled ? header_.tile_width : header_.width;
    const std::int64_t high = header_.tiled ? header_.tile_height : lines;
    const std::int64_t left = static_cast<std::int64_t>(i) % across * wide;
    const std::int64_t top = static_cast<std::int64_t>(i) / across * high;
    const std::int64_t columns = std::min(wide, header_.width - left),
                       rows = std::min(high, header_.height - top);
    // A channel sampled every n pixels has those at multiples of n.
    const auto samples = [](std::int64_t first, std::int64_t count, std::int64_t every) {
        const auto below = [every](std::int64_t end) {
            return end / every + (end > 0 && end % every != 0 ? 1 : 0);
        };
        return static_cast<std::uint64_t>(below(first + count) - below(first));
    };
    std::uint64_t bytes = 0;
    for (const ExrChannel& channel : header_.channels) {
        bytes += samples(header_.left + left, columns, channel.x_sampling) *
                 samples(header_.top + top, rows, channel.y_sampling) * pixel_type_sizes[channel.type];
    }
    return bytes;
}

/// Bytes that a chunk's payload decodes to, if it is of a compression whose shortfall libOpenEXR does not see: it takes
/// what is missing for zeros. Of a damaged payload, `expected`: the library finds that.
std::uint64_t decoded_bytes(std::string_view compression, const std::string& payload,
                            std::uint64_t expected) {
    if (compression == "none" || payload.size() >= expected) {
        return payload.size();
    }
    if (compression == "RLE") {
        std::uint64_t decoded = 0;
        for (std::size_t at = 0; at < payload.size();) {
            const int byte = static_cast<unsigned char>(payload[at]);
            const int count = byte < 128 ? byte : byte - 256;
            decoded += static_cast<std::uint64_t>(count < 0 ? -count : count + 1);
            at += count < 0 ? static_cast<std::size_t>(1 - count) : 2;
        }
        return decoded;
    }
    std::vector<Bytef> pixels(expected);
    uLongf size = expected;
    const int result =
        uncompress(pixels.data(), &size, reinterpret_cast<const Bytef*>(payload.data()), payload.size());
    return result == Z_OK ? size : expected;
}

// libOpenEXR does not look at the table as long as it reads scan lines in order, so it reads a damaged
// table's file without a word. (It uses a tiled file's table, and rebuilds one with zeros.) Nor does it see
// that a chunk decodes to less than its pixels.
void HeaderReader::check_chunks() {
    const std::uint64_t chunks = chunk_count();
    const std::string table = bytes(chunks * 8);
    std::vector<std::uint64_t> offsets;
    for (std::size_t i = 0; i < chunks; ++i) {
        offsets.push_back(little_endian_32(table, 8 * i) |
                          static_cast<std::uint64_t>(little_endian_32(table, 8 * i + 4)) << 32);
        if (offsets.back() == 0) {
            return;
        }
    }
    const std::size_t head = header_.tiled ? 20 : 8;  // coordinates, then the payload's size
    const Compression& compression = compressions[header_.compression];
    const bool sizes_matter = compression.name == "none" || compression.name == "RLE" ||
                              compression.name == "ZIPS" || compression.name == "ZIP";
    std::uint64_t together = 0;  // of files with overlapping chunks many times the file, all of it to be read
    for (std::size_t i = 0; i < chunks; ++i) {
        const std::int64_t line = header_.top + static_cast<std::int64_t>(i) * compression.lines;
        const std::string what =
            header_.tiled ? fmt::format("tile {}", i) : fmt::format("scan line {}", line);
        std::string found(head, '\0');
        if (offsets[i] < file_size_ && file_size_ - offsets[i] >= head) {
            file_.seekg(static_cast<std::streamoff>(offsets[i]));
            file_.read(found.data(), static_cast<std::streamsize>(head));
        } else {
            refuse(
                fmt::format("the EXR file's offset table puts {} at byte {}, but the file has {}. It was cut "
                            "off or is damaged.",
                            what, offsets[i], file_size_));
        }
        if (!header_.tiled && static_cast<std::int32_t>(little_endian_32(found, 0)) != line) {
            refuse(
                fmt::format("the EXR file's offset table puts {} at byte {}, where another begins or none. "
                            "It is damaged.",
                            what, offsets[i]));
        }
        const std::uint64_t size = little_endian_32(found, head - 4), expected = chunk_bytes(i);
        if (size > file_size_ - offsets[i] - head) {
            continue;  // the library finds it cut off
        }
        together += head + size;
        if (together > file_size_) {
            refuse(fmt::format(
                "the EXR file's chunks up to {} have {} bytes together, but the file has {}: they "
                "overlap. It is damaged: save or download it anew.",
                what, together, file_size_));
        }
        if (!sizes_matter) {
            continue;
        }
        std::string payload(size, '\0');
        file_.read(payload.data(), static_cast<std::streamsize>(size));
        const std::uint64_t decoded = decoded_bytes(compression.name, payload, expected);
        if (decoded < expected) {
            refuse(fmt::format(
                "the EXR file's chunk at {} holds {} bytes of pixels of {}. It is damaged: save or "
                "download it anew.",
                what, decoded, expected));
        }
    }
}

ExrHeader HeaderReader::read() {
    read_version();
    for (std::string name = text("an attribute's name"); !name.empty(); name = text("an attribute's name")) {
        read_attribute(name);
    }
    check_present();
    check_claims();
    check_chunks();
    for (const Required& required : required_attributes) {
        if (names_.count(std::string(required.name)) == 0) {
            header_.absent.emplace_back(required.name);
        }
    }
    return header_;
}

}  // namespace

ExrHeader read_exr_header(const std::filesystem::path& path) {
    return HeaderReader(path).read();
}

}  // namespace tessera

// The seeds of corpus/ that are not written by hand: `tessera_fuzz_seeds FOLDER` writes them into FOLDER/TARGET/seed_*.
// Tiny files of every kind that the readers know; the same bytes from the same libraries.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <half.h>
#include <png.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "testbench/job/dump_job.h"
#include "testbench/tests/datapath_random.h"

namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& bytes) {
    fs::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    if (!file.flush())
        throw std::runtime_error(path.string() + ": cannot be written");
}

struct ExrSeed {
    const char* name;
    Imf::Compression compression;
    Imf::PixelType type;
    bool tiled;
    std::vector<const char*> channels;
    Imf::LevelMode levels = Imf::ONE_LEVEL;
};

constexpr int exr_width = 6, exr_height = 5;

void write_exr(const fs::path& path, const ExrSeed& seed) {
    constexpr int left = 3, top = -2;  // the data window need not begin at 0
    const Imath::Box2i window({left, top}, {left + exr_width - 1, top + exr_height - 1});
    Imf::Header header(window, window);
    header.compression() = seed.compression;
    std::vector<std::vector<char>> planes;
    Imf::FrameBuffer frame;
    for (const char* const channel : seed.channels) {
        std::vector<char> plane;
        for (int i = 0; i < exr_width * exr_height; ++i) {
            const float value = static_cast<float>(i * 7 % 13) - 2.5F;
            const auto natural = static_cast<std::uint32_t>(i * 1000);
            const std::uint16_t bits = Imath::half(value).bits();
            const char* const from = seed.type == Imf::HALF   ? reinterpret_cast<const char*>(&bits)
                                     : seed.type == Imf::UINT ? reinterpret_cast<const char*>(&natural)
                                                              : reinterpret_cast<const char*>(&value);
            plane.insert(plane.end(), from, from + (seed.type == Imf::HALF ? 2 : 4));
        }
        planes.push_back(std::move(plane));
        const std::size_t sample = seed.type == Imf::HALF ? 2 : 4;
        header.channels().insert(channel, Imf::Channel(seed.type));
        frame.insert(channel,
                     Imf::Slice::Make(seed.type, planes.back().data(), window, sample, sample * exr_width));
    }
    fs::create_directories(path.parent_path());
    if (seed.tiled) {
        header.setTileDescription(Imf::TileDescription(4, 4, seed.levels));
        Imf::TiledOutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(frame);
        for (int y = 0; y < file.numYLevels(); ++y)
            for (int x = 0; x < file.numXLevels(); ++x)
                if (file.isValidLevel(x, y))
                    file.writeTiles(0, file.numXTiles(x) - 1, 0, file.numYTiles(y) - 1, x, y);
    } else {
        Imf::OutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(frame);
        file.writePixels(exr_height);
    }
}

void make_exr(const fs::path& folder) {
    const std::vector<ExrSeed> seeds{
        {"none_half", Imf::NO_COMPRESSION, Imf::HALF, false, {"Y"}},
        {"none_float", Imf::NO_COMPRESSION, Imf::FLOAT, false, {"height"}},
        {"none_uint", Imf::NO_COMPRESSION, Imf::UINT, false, {"Y"}},
        {"rle_half", Imf::RLE_COMPRESSION, Imf::HALF, false, {"Y"}},
        {"zips_float", Imf::ZIPS_COMPRESSION, Imf::FLOAT, false, {"R", "G", "B"}},
        {"zip_half", Imf::ZIP_COMPRESSION, Imf::HALF, false, {"A", "Y"}},
        {"piz_half", Imf::PIZ_COMPRESSION, Imf::HALF, false, {"Y"}},
        {"piz_float", Imf::PIZ_COMPRESSION, Imf::FLOAT, true, {"Y"}},
        {"pxr24_float", Imf::PXR24_COMPRESSION, Imf::FLOAT, false, {"Y"}},
        {"b44_half", Imf::B44_COMPRESSION, Imf::HALF, false, {"Y"}},
        {"b44a_half", Imf::B44A_COMPRESSION, Imf::HALF, true, {"Y"}},
        {"dwaa_half", Imf::DWAA_COMPRESSION, Imf::HALF, false, {"Y"}},
        {"dwab_float", Imf::DWAB_COMPRESSION, Imf::FLOAT, false, {"Y"}},
        {"none_tiles", Imf::NO_COMPRESSION, Imf::HALF, true, {"Y"}},
        {"zip_mip_map", Imf::ZIP_COMPRESSION, Imf::FLOAT, true, {"Y"}, Imf::MIPMAP_LEVELS},
        {"rle_rip_map", Imf::RLE_COMPRESSION, Imf::HALF, true, {"Y"}, Imf::RIPMAP_LEVELS},
    };
    for (const ExrSeed& seed : seeds)
        write_exr(folder / (std::string("seed_") + seed.name + ".exr"), seed);
}

struct PngSeed {
    const char* name;
    int depth, colour_type;
    bool interlaced;
};

void write_png(const fs::path& path, const PngSeed& seed) {
    constexpr std::uint32_t width = 5, height = 4;
    const auto fail = [](png_structp, png_const_charp message) { throw std::runtime_error(message); };
    std::string bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &bytes,
        [](png_structp to, png_bytep data, std::size_t size) {
            static_cast<std::string*>(png_get_io_ptr(to))->append(reinterpret_cast<const char*>(data), size);
        },
        nullptr);
    png_set_IHDR(png, info, width, height, seed.depth, seed.colour_type,
                 seed.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (seed.colour_type == PNG_COLOR_TYPE_PALETTE) {
        const std::array<png_color, 4> palette{{{0, 0, 0}, {80, 80, 80}, {10, 200, 30}, {255, 255, 255}}};
        png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
    }
    png_write_info(png, info);
    std::vector<std::uint8_t> row(png_get_rowbytes(png, info));
    const int passes = png_set_interlace_handling(png);
    for (int pass = 0; pass < passes; ++pass) {
        for (std::uint32_t y = 0; y < height; ++y) {
            for (std::size_t k = 0; k < row.size(); ++k)
                row[k] = seed.colour_type == PNG_COLOR_TYPE_PALETTE
                             ? static_cast<std::uint8_t>((k + y) & 3)
                             : static_cast<std::uint8_t>(k * 37 + std::size_t{y} * 11);
            png_write_row(png, row.data());
        }
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    write(path, bytes);
}

void make_png(const fs::path& folder) {
    constexpr std::array<PngSeed, 10> seeds{{
        {"grey_1", 1, PNG_COLOR_TYPE_GRAY, false},
        {"grey_4", 4, PNG_COLOR_TYPE_GRAY, true},
        {"grey_8", 8, PNG_COLOR_TYPE_GRAY, false},
        {"grey_16", 16, PNG_COLOR_TYPE_GRAY, false},
        {"grey_16_interlaced", 16, PNG_COLOR_TYPE_GRAY, true},
        {"grey_alpha_8", 8, PNG_COLOR_TYPE_GRAY_ALPHA, false},
        {"rgb_8", 8, PNG_COLOR_TYPE_RGB, false},
        {"rgba_16_interlaced", 16, PNG_COLOR_TYPE_RGB_ALPHA, true},
        {"palette_8", 8, PNG_COLOR_TYPE_PALETTE, false},
        {"palette_8_interlaced", 8, PNG_COLOR_TYPE_PALETTE, true},
    }};
    for (const PngSeed& seed : seeds)
        write_png(folder / (std::string("seed_") + seed.name + ".png"), seed);
}

template <class Number>
void append(std::string& bytes, Number number) {  // little endian, as this machine is
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof number);
    bytes.append(raw, sizeof number);
}

void make_ply(const fs::path& folder) {
    constexpr std::uint32_t vertices = 4;
    const std::array<std::array<std::uint32_t, 3>, 2> faces{{{0, 1, 2}, {0, 2, 3}}};
    std::string ply =
        "ply\nformat binary_little_endian 1.0\ncomment a seed\nelement vertex 4\nproperty double x\n"
        "property double y\nproperty double z\nproperty float nx\nproperty float ny\nproperty float nz\n"
        "property double s\nproperty double t\nelement face 2\nproperty list uchar int vertex_indices\n"
        "property uchar generation\nproperty uchar split_by\nproperty uchar stopped_by\nproperty int base\n"
        "end_header\n";
    for (std::uint32_t k = 0; k < vertices; ++k) {
        const double u = k == 1 || k == 2 ? 1 : 0, v = k >= 2 ? 1 : 0;
        for (const double value : {u, v, 0.25})
            append(ply, value);
        for (const float value : {0.0F, 0.0F, 1.0F})
            append(ply, value);
        append(ply, u);
        append(ply, v);
    }
    for (const auto& face : faces) {
        append(ply, std::uint8_t{3});
        for (const std::uint32_t index : face)
            append(ply, index);
        for (const std::uint8_t tag : {std::uint8_t{1}, std::uint8_t{3}, std::uint8_t{8}})
            append(ply, tag);
        append(ply, std::uint32_t{0});
    }
    write(folder / "seed_square.ply", ply);
}

/// Every key, table by table, without the comments.
void make_toml(const fs::path& folder) {
    const std::string dump = tessera::dump_job(tessera::Job{});
    std::string table, name = "top";
    for (std::size_t at = 0; at < dump.size();) {
        const std::size_t end = dump.find('\n', at) + 1;
        const std::string line = dump.substr(at, end - at);
        at = end;
        if (line[0] == '#' || line[0] == '\n')
            continue;
        if (line[0] == '[') {
            write(folder / ("seed_" + name + ".toml"), table);
            table.clear();
            name = line.substr(1, line.find(']') - 1);
        }
        table += line;
    }
    write(folder / ("seed_" + name + ".toml"), table);
}

void make_datapath(const fs::path& folder) {
    constexpr int seeds = 12;
    for (int seed = 0; seed < seeds; ++seed) {
        tessera::testing::Random random(static_cast<std::uint64_t>(seed) + 1);
        std::string bytes;
        const std::int64_t size = random.integer(100, 900);
        for (std::int64_t k = 0; k < size; ++k)
            bytes += static_cast<char>(random.bits() & 255);
        write(folder / ("seed_" + std::to_string(seed)), bytes);
    }
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: tessera_fuzz_seeds FOLDER\n");
        return 2;
    }
    try {
        const fs::path folder = arguments[1];
        make_exr(folder / "exr");
        make_png(folder / "png");
        make_ply(folder / "ply");
        make_toml(folder / "toml");
        make_datapath(folder / "datapath");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tessera_fuzz_seeds: %s\n", error.what());
        return 1;
    }
    return 0;
}

#include "testbench/tests/input/map/map_test_files.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <half.h>
#include <png.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "testbench/common/error.h"
#include "testbench/input/map/read_height_map.h"

namespace tessera::map_test {

void write_png(const std::filesystem::path& path, const PngImage& image) {
    const auto fail = [](png_structp, png_const_charp message) { throw std::runtime_error(message); };
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    REQUIRE(file != nullptr);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, image.width, image.height, image.depth, image.colour_type,
                 image.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    std::vector<png_color> palette;
    for (std::size_t i = 0; i + 2 < image.palette.size(); i += 3)
        palette.push_back({image.palette[i], image.palette[i + 1], image.palette[i + 2]});
    if (!palette.empty())
        png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
    png_write_info(png, info);
    const std::size_t row_bytes = image.bytes.size() / image.height;
    std::vector<png_bytep> rows;
    std::vector<std::uint8_t> bytes = image.bytes;
    for (std::size_t y = 0; y < image.height; ++y)
        rows.push_back(bytes.data() + y * row_bytes);
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

void write_exr(const std::filesystem::path& path, const ExrImage& image) {
    const Imath::Box2i window({image.left, image.top}, {image.left + image.width - 1, image.top + image.height - 1});
    const auto display = [](const ExrImage::Window& w) { return Imath::Box2i({w.left, w.top}, {w.right, w.bottom}); };
    Imf::Header header(image.display ? display(*image.display) : window, window);
    header.compression() = static_cast<Imf::Compression>(image.compression);
    const Imf::PixelType type = image.pixels == Pixels::uint   ? Imf::UINT
                                : image.pixels == Pixels::half ? Imf::HALF
                                                               : Imf::FLOAT;
    const std::size_t size = type == Imf::HALF ? 2 : 4;
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<std::vector<char>> planes;
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < image.channels.size(); ++c) {
        std::vector<char> plane(image.values.size() * size);
        for (std::size_t i = 0; i < image.values.size(); ++i) {
            const float value = image.planes.empty() ? image.values[i] + static_cast<float>(c) : image.planes[c][i];
            char* const at = plane.data() + i * size;
            if (type == Imf::UINT) {
                const auto sample = static_cast<std::uint32_t>(value);
                std::copy_n(reinterpret_cast<const char*>(&sample), size, at);
            } else if (type == Imf::HALF) {
                const std::uint16_t bits = Imath::half(value).bits();
                std::copy_n(reinterpret_cast<const char*>(&bits), size, at);
            } else {
                std::copy_n(reinterpret_cast<const char*>(&value), size, at);
            }
        }
        planes.push_back(std::move(plane));
        header.channels().insert(image.channels[c], Imf::Channel(type));
        frame.insert(image.channels[c], Imf::Slice::Make(type, planes.back().data(), window, size, size * width));
    }
    if (image.tiled) {
        header.setTileDescription(Imf::TileDescription(8, 8, image.mip_map ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL));
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        for (int level = 0; level < file.numLevels(); ++level)
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(image.height);
    }
}

Outcome outcome_of(const std::filesystem::path& path) {
    try {
        const HeightMap map = read_height_map(path);
        if (map.repairs.empty())
            return {Outcome::Kind::loaded, ""};
        std::string all;
        for (const std::string& repair : map.repairs)
            all += repair + " ";
        return {Outcome::Kind::loaded_with_remark, all};
    } catch (const InputError& error) {
        return {Outcome::Kind::refused, error.what()};
    } catch (const std::exception& error) {
        return {Outcome::Kind::wrong_exception, error.what()};
    }
}

}  // namespace tessera::map_test

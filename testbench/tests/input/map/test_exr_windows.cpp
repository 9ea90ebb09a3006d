// EXR files as other programs write them: display windows that are not the data window, and several channels.
#include <ImfHeader.h>
#include <ImfRgbaFile.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/tests/input/map/map_test_files.h"
#include "testbench/tests/support/text.h"

using namespace tessera;
using namespace tessera::map_test;
using Catch::Contains;

namespace {

/// Data of 6 x 5 pixels at (left, top), from 1 at the top left to 30.
ExrImage data_at(int left, int top, ExrImage::Window display) {
    ExrImage image{6, 5, std::vector<float>(30)};
    std::iota(image.values.begin(), image.values.end(), 1.F);
    image.left = left;
    image.top = top;
    image.display = display;
    return image;
}

HeightMap read(const ExrImage& image, const std::string& channel = {}) {
    const TestFolder folder;
    write_exr(folder / "a.exr", image);
    return read_height_map(folder / "a.exr", channel);
}

}  // namespace

TEST_CASE("an EXR map is the display window: outside the data 0, data beyond it cropped") {
    struct Row {
        const char* name;
        int left, top;
        ExrImage::Window display;
        const char* remark;
    };
    const Row row = GENERATE(values<Row>({
        {"a crop render", 2, 3, {0, 0, 9, 9}, "is 6 x 5 at (2, 3): 70 texels without data are 0."},
        {"overscan", -1, -2, {0, 0, 3, 1}, "is 6 x 5 at (-1, -2): 22 pixels outside were cropped."},
        {"beside it", -3, -1, {-1, -2, 4, 1}, "are 0, 18 pixels outside were cropped."},
        {"one common pixel", 5, 4, {0, 0, 5, 4}, "29 texels without data are 0, 29 pixels outside were cropped."},
        {"equal windows away from 0", -7, 40, {-7, 40, -2, 44}, ""},
    }));
    for (const bool tiled : {false, true})
        for (const int compression : {0, 3, 4}) {
            INFO(row.name << ", tiled " << tiled << ", compression " << compression);
            ExrImage image = data_at(row.left, row.top, row.display);
            image.tiled = tiled;
            image.compression = compression;
            const HeightMap map = read(image);
            REQUIRE(map.width == row.display.right - row.display.left + 1);
            REQUIRE(map.height == row.display.bottom - row.display.top + 1);
            for (int y = 0; y < map.height; ++y)
                for (int x = 0; x < map.width; ++x) {
                    const int column = x + row.display.left - row.left, line = y + row.display.top - row.top;
                    const bool stored = column >= 0 && column < 6 && line >= 0 && line < 5;
                    CHECK(map.at(x, map.height - 1 - y) == static_cast<float>(stored ? 6 * line + column + 1 : 0));
                }
            CHECK_THAT(testing::joined(map.repairs), Contains(row.remark));
            CHECK(map.repairs.size() == (*row.remark == '\0' ? 0 : 1));
        }
}

TEST_CASE("display windows without pixels, or too large, are refused in little memory") {
    const auto refusal = [](ExrImage::Window display) {
        const TestFolder folder;
        write_exr(folder / "a.exr", data_at(0, 0, display));
        try {
            read_height_map(folder / "a.exr");
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK_THAT(refusal({6, 0, 9, 9}), Contains("data window, 6 x 5 at (0, 0), lies outside its display window, 4 x 10 "
                                               "at (6, 0)"));
    CHECK_THAT(refusal({-9, -9, -1, 8}), Contains("lies outside its display window"));
    CHECK_THAT(refusal({0, 0, 4096, 9}), Contains("the map is 4097 x 10 texels; each side must be 1 to 4096"));
    CHECK_THAT(refusal({-1000000000, -1000000000, 1000000000, 1000000000}), Contains("each side must be 1 to 4096"));
    CHECK(refusal({0, 0, 4095, 4095}).empty());
}

TEST_CASE("overscan may exceed the largest side, up to twice") {
    ExrImage image{8192, 1, std::vector<float>(8192)};
    image.values[5000] = 7;
    image.display = ExrImage::Window{4096, 0, 8191, 0};
    CHECK(read(image).at(5000 - 4096, 0) == 7);
    image = {8193, 1, std::vector<float>(8193)};
    image.display = ExrImage::Window{0, 0, 4095, 0};
    CHECK_THROWS_WITH(read(image), Contains("data window is 8193 x 1 at (0, 0); each side must be 1 to 8192. Save it "
                                            "cropped to its display window, 4096 x 1 at (0, 0)"));
}

TEST_CASE("an EXR map of several channels says which it takes and which differ") {
    const std::vector<float> ramp{0, 0.25F, 0.5F, 1}, other{0, 0.25F, 0.75F, 0.5F}, ones(4, 1), grey(4, 0.5F);
    ExrImage image{2, 2, ramp};
    const auto remark = [&](std::vector<std::string> channels, std::vector<std::vector<float>> planes,
                            const std::string& channel = {}) {
        image.channels = std::move(channels);
        image.planes = std::move(planes);
        return testing::joined(read(image, channel).repairs);
    };
    image.tiled = GENERATE(false, true);
    INFO("grey, with or without alpha");
    CHECK(remark({"R", "G", "B"}, {ramp, ramp, ramp}) == "");
    CHECK(remark({"R", "G", "B", "A"}, {ramp, ramp, ramp, ones}) == "");
    CHECK(remark({"Y", "A"}, {ramp, ones}) == "");
    INFO("a vector displacement, colour with depth, not opaque, layers");
    CHECK(remark({"R", "G", "B"}, {ramp, other, ones}) ==
          "The heights are those of channel R; channels B, G hold other values (at up to 3 texels), and were left out. "
          "map.channel takes another one.\n");
    CHECK_THAT(remark({"R", "G", "B", "A", "Z"}, {grey, grey, grey, ones, ramp}),
               Contains("channel R; channel Z holds other values (at up to 3 texels), and was left out"));
    CHECK_THAT(remark({"R", "A"}, {ramp, grey}), Contains("channel A holds other values"));
    CHECK_THAT(remark({"Y", "height.R", "displacement.Z"}, {ramp, other, ramp}),
               Contains("channel Y; channel height.R holds other values"));
    INFO("a channel that was named is what was wanted");
    CHECK(remark({"R", "G", "B"}, {ramp, other, ones}, "G") == "");
    INFO("without a usual name");
    CHECK(remark({"height.R"}, {ramp}) == "");
    CHECK_THROWS_WITH(remark({"displacement.X", "displacement.Z"}, {ramp, other}),
                      Contains("neither a channel Y nor R, and more than one: displacement.X, displacement.Z. Set "
                               "map.channel"));
}

TEST_CASE("luminance of an EXR file with subsampled chroma is read, and the chroma named") {
    const TestFolder folder;
    const std::string path = folder / "a.exr";
    {
        std::vector<Imf::Rgba> pixels(64);
        for (std::size_t k = 0; k < pixels.size(); ++k)
            pixels[k] = Imf::Rgba(static_cast<float>(k) / 64, 0.25F, 0.5F);
        Imf::RgbaOutputFile file(path.c_str(), Imf::Header(8, 8), Imf::WRITE_YC);
        file.setFrameBuffer(pixels.data(), 1, 8);
        file.writePixels(8);
    }
    const HeightMap map = read_height_map(path);
    CHECK(map.width == 8);
    CHECK_THAT(testing::joined(map.repairs),
               Contains("heights are those of channel Y; channels BY, RY hold other values, and"));
    CHECK_THROWS_WITH(read_height_map(path, "RY"), Contains("only every 2 x 2 pixel"));
}

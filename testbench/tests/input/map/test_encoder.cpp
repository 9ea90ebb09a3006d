#include <catch2/catch.hpp>
#include <cmath>

#include "testbench/input/map/encode_height_map.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/tests/input/map/map_test_files.h"

using namespace tessera;
using namespace tessera::map_test;

namespace {

HeightMap written_and_read(int width, int height, const std::vector<double>& heights, MapFormat format,
                           EncodedMap& map) {
    const TestFolder folder;
    map = encode_height_map(width, height, heights, format);
    write_all(folder / "map", map.bytes);
    return read_height_map(folder / "map");
}

std::vector<double> waves(int width, int height) {
    std::vector<double> heights;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            heights.push_back(-3 + 0.01 * x * x - 0.02 * x * y + 0.7 * std::sin(0.1 * y));
    return heights;
}

}  // namespace

TEST_CASE("encoded maps are read back within half a step, bottom row first") {
    const std::vector<double> heights = waves(31, 17);
    for (const MapFormat format : {MapFormat::pgm, MapFormat::png}) {
        EncodedMap file;
        const HeightMap map = written_and_read(31, 17, heights, format, file);
        CHECK(map.repairs.empty());
        REQUIRE(map.width == 31);
        REQUIRE(map.height == 17);
        CHECK(map.source_units == 65535);
        const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
        CHECK(file.bias == *low);
        CHECK(file.scale == *high - *low);
        CHECK(file.step == Approx((*high - *low) / 65535));
        for (std::size_t k = 0; k < heights.size(); ++k)
            REQUIRE(std::abs(file.bias + file.scale * static_cast<double>(map.values[k]) - heights[k]) <=
                    0.50001 * file.step + 1e-7 * file.scale);  // values are floats
    }
}

TEST_CASE("a PNG and a PGM of the same heights hold the same samples, and EXR the heights as floats") {
    const std::vector<double> heights = waves(64, 48);
    EncodedMap pgm, png, exr;
    const HeightMap a = written_and_read(64, 48, heights, MapFormat::pgm, pgm),
                    b = written_and_read(64, 48, heights, MapFormat::png, png),
                    c = written_and_read(64, 48, heights, MapFormat::exr, exr);
    CHECK(a.values == b.values);
    CHECK(exr.scale == 1);
    CHECK(exr.bias == 0);
    CHECK(exr.step == 0);
    CHECK(c.repairs.empty());
    for (std::size_t k = 0; k < heights.size(); ++k)
        REQUIRE(c.values[k] == static_cast<float>(heights[k]));
}

TEST_CASE("samples run from 0 to 65535, and a flat map is its bias") {
    EncodedMap file;
    const HeightMap ends = written_and_read(3, 1, {-2, 5, 1.5}, MapFormat::png, file);
    CHECK(ends.values == std::vector<float>{0, 1, static_cast<float>(32768 / 65535.0)});
    for (const MapFormat format : {MapFormat::pgm, MapFormat::png}) {
        const HeightMap flat = written_and_read(2, 2, {7, 7, 7, 7}, format, file);
        CHECK(flat.values == std::vector<float>(4, 0.0F));
        CHECK(file.scale == 1);
        CHECK(file.bias == 7);
        CHECK(file.step == 0);
    }
    CHECK(written_and_read(1, 1, {0.25}, MapFormat::exr, file).values == std::vector<float>{0.25F});
}

#include "testbench/setup/tables/mipmap_table.h"

#include <catch2/catch.hpp>

#include "testbench/tests/setup/tables/refined_mesh.h"

using namespace tessera;
using namespace tessera::tables_test;

TEST_CASE("Mipmaps hold the mean, or the maximum, of each block's texels") {
    Random random(1);
    const datapath::Formats formats;
    for (int trial = 0; trial < 20; ++trial) {
        const QuantisedMap map =
            random_map(random, random.natural(1, 20), random.natural(1, 20), AddressMode::clamp, AddressMode::repeat);
        const MipmapTable means = make_mipmap_table(map, MipmapFilter::mean);
        const MipmapTable maxima = make_mipmap_table(map, MipmapFilter::maximum);
        REQUIRE(means.entries.size() == mipmap_entries(map.geometry));
        REQUIRE(maxima.entries.size() == means.entries.size());
        for (int level = 0; level <= highest_mipmap_level(map.geometry); ++level) {
            for (std::uint32_t v = 0; v < map.geometry.height; v += 1u << level) {
                for (std::uint32_t u = 0; u < map.geometry.width; u += 1u << level) {
                    double sum = 0, count = 0;
                    std::uint16_t maximum = 0;
                    for (std::uint32_t y = v; y < std::min(v + (1u << level), map.geometry.height); ++y) {
                        for (std::uint32_t x = u; x < std::min(u + (1u << level), map.geometry.width); ++x) {
                            sum += map.code(x, y);
                            ++count;
                            maximum = std::max(maximum, map.code(x, y));
                        }
                    }
                    const datapath::TexCoord t{u << formats.texture.fraction, v << formats.texture.fraction};
                    const std::uint64_t entry = mipmap_address(t, level, 0, map.geometry, formats) / 2;
                    REQUIRE(maxima.entries[entry] == maximum);
                    REQUIRE(means.entries[entry] == std::floor(sum / count + 0.5));
                }
            }
        }
    }
}

// Worked out by hand: means round to the nearest, halves up, of the texels alone, not of rounded means.
TEST_CASE("Mipmaps of small maps, entry by entry") {
    const auto table = [](std::uint32_t width, std::uint32_t height, std::vector<std::uint16_t> codes,
                          MipmapFilter filter) {
        QuantisedMap map;
        map.geometry = {width, height, AddressMode::clamp, AddressMode::clamp};
        map.codes = std::move(codes);
        std::vector<std::uint16_t> entries = make_mipmap_table(map, filter).entries;
        entries.erase(entries.begin(), entries.begin() + width * height);  // level 0, the map
        return entries;
    };
    using Entries = std::vector<std::uint16_t>;
    // Sums 2, 1, 3, 4 of four: 0.5 up to 1, 0.25, 0.75, 1. The whole: 10/16, where the mean of rounded means is 0.75.
    const Entries square = {0, 1, 0, 0, 1, 0, 1, 0, 1, 1, 1, 1, 1, 0, 1, 1};
    CHECK(table(4, 4, square, MipmapFilter::mean) == Entries{1, 0, 1, 1, 1});
    CHECK(table(4, 4, square, MipmapFilter::maximum) == Entries{1, 1, 1, 1, 1});
    // Sums 1, 1, 1, 2: 5/16 is 0, of rounded means 0.25.
    CHECK(table(4, 4, {0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 1, 1, 0, 0, 0, 0}, MipmapFilter::mean) == Entries{0, 0, 0, 1, 0});
    // 3 x 3: blocks of 4, 2, 2 and 1 texels: 12/4; 7/2 = 3.5; 9/2 = 4.5; 9. The whole 37/9 = 4.1.
    CHECK(table(3, 3, {1, 2, 3, 4, 5, 4, 4, 5, 9}, MipmapFilter::mean) == Entries{3, 4, 5, 9, 4});
    CHECK(table(3, 3, {1, 2, 3, 4, 5, 4, 4, 5, 9}, MipmapFilter::maximum) == Entries{5, 4, 5, 9, 9});
    // 5 x 1: 65535 + 65534 over 2 is 65534.5; then three levels of halves.
    CHECK(table(5, 1, {65535, 65534, 0, 1, 2}, MipmapFilter::mean) == Entries{65535, 1, 2, 32768, 2, 26214});
    CHECK(table(1, 3, {7, 8, 1}, MipmapFilter::mean) == Entries{8, 1, 5});  // 16/3 = 5.33
    CHECK(table(1, 1, {7}, MipmapFilter::mean).empty());
}

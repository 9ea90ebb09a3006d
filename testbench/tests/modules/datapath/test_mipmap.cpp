#include "modules/datapath/mipmap.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace tessera::datapath;

TEST_CASE("mipmap: level, every edge of a narrow format, from both ends") {
    Formats f;
    f.texture = Format::make_unsigned(3 + 1 + 1, 1);
    const MapGeometry map{8, 5, AddressMode::clamp, AddressMode::clamp};
    REQUIRE(highest_mipmap_level(map) == 3);
    for (std::uint32_t iu = 0; iu <= 16; ++iu)
        for (std::uint32_t iv = 0; iv <= 16; ++iv)
            for (std::uint32_t ju = 0; ju <= 16; ++ju)
                for (std::uint32_t jv = 0; jv <= 16; ++jv) {
                    const double du = (1.0 * ju - iu) / 2, dv = (1.0 * jv - iv) / 2;
                    const double half = std::max(std::abs(du), std::abs(dv)) / 2;
                    const int expected = half < 2 ? 0 : static_cast<int>(std::floor(std::log2(half)));
                    REQUIRE(mipmap_level({iu, iv}, {ju, jv}, map, f) == expected);
                    REQUIRE(mipmap_level({ju, jv}, {iu, iv}, map, f) == expected);
                }
    CHECK(mipmap_level({0, 0}, {16, 16}, {2, 2, AddressMode::repeat, AddressMode::repeat}, f) == 1);
}

TEST_CASE("mipmap: blocks of 2^l texels, level after level, under the addressed texel") {
    const Formats f;
    const MapGeometry map{9, 5, AddressMode::repeat, AddressMode::clamp};
    REQUIRE(highest_mipmap_level(map) == 4);
    std::uint64_t entries = 0;
    for (int level = 0; level <= 4; ++level) {
        const MipmapBlocks blocks = mipmap_blocks(level, map);
        CHECK(blocks.first_entry == entries);
        CHECK(blocks.columns == static_cast<std::uint32_t>(std::ceil(9 / std::exp2(level))));
        CHECK(blocks.rows == static_cast<std::uint32_t>(std::ceil(5 / std::exp2(level))));
        entries += std::uint64_t{blocks.columns} * blocks.rows;
        for (std::uint32_t v = 0; v < 12; ++v)
            for (std::uint32_t u = 0; u < 20; ++u) {
                const std::uint32_t column = u % 9 / (1u << level), row = std::min(v, 4u) / (1u << level);
                REQUIRE(mipmap_address({(u << 12) + 4095, v << 12}, level, 64, map, f) ==
                        64 + 2 * (blocks.first_entry + row * blocks.columns + column));
            }
    }
    CHECK(mipmap_blocks(4, map).columns == 1);
    CHECK(mipmap_blocks(4, map).rows == 1);
}

TEST_CASE("mipmap: the test's threshold is twice the height by which the midpoint leaves the chord") {
    for (std::uint32_t i = 0; i < 16; ++i)
        for (std::uint32_t j = 0; j < 16; ++j)
            for (std::uint32_t ij = 0; ij < 16; ++ij)
                for (std::uint32_t threshold = 0; threshold < 32; ++threshold) {
                    const bool splits = std::abs(ij - (i + j) / 2.0) > threshold / 2.0;
                    REQUIRE(mipmap_test(i, j, ij, threshold) == splits);
                    REQUIRE(mipmap_test(j, i, ij, threshold) == splits);
                }
}

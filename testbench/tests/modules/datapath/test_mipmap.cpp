#include "modules/datapath/mipmap.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "modules/datapath/height_tests.h"
#include "modules/datapath/table_shapes.h"

using namespace tessera::datapath;

TEST_CASE("mipmap: the level of every edge of a narrow format, from both ends") {
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

TEST_CASE("mipmap: a texel's entry is that of its block of 2^l texels, levels follow one another") {
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

TEST_CASE("mipmap: the threshold is twice the midpoint's deviation from the chord") {
    TestParameters tests;
    for (std::uint64_t i = 0; i < 16; ++i)
        for (std::uint64_t j = 0; j < 16; ++j)
            for (std::uint64_t ij = 0; ij < 16; ++ij)
                for (int threshold = 0; threshold < 32; ++threshold) {
                    tests.height_thresholds[0] = threshold;
                    const double deviation = std::abs(static_cast<double>(ij) - static_cast<double>(i + j) / 2);
                    const bool splits = deviation > threshold / 2.0;
                    REQUIRE(mipmap_test(mipmap_difference(Entries{i, j, ij}), tests) == splits);
                    REQUIRE(mipmap_test(mipmap_difference(Entries{j, i, ij}), tests) == splits);
                }
}

TEST_CASE("MT: reads the entries of both ends and the midpoint, at the edge's level") {
    Registers r;
    r.formats.height_test = number_of<MipmapTest>();
    r.map = {40, 24, AddressMode::clamp, AddressMode::repeat};
    r.height_table.base = 0x3000;
    shape_tables(r);
    CHECK(r.height_table.entry_bytes == 2);
    CHECK(r.height_table.rows == 1);
    CHECK(r.height_table.columns == 40 * 24 + 20 * 12 + 10 * 6 + 5 * 3 + 3 * 2 + 2 * 1 + 1);
    const TexCoord i{3 << 12, 23 << 12}, j{19 << 12, 25 << 12}, ij{11 << 12, 24 << 12};
    std::vector<std::uint64_t> visited;
    mipmap_reads(i, j, ij, r, [&](std::uint64_t address) { visited.push_back(address); });
    // 16 texels: level 3, 5 x 3 blocks after those of levels 0 to 2; rows 23, 25 and 24 are 23, 1 and 0
    const std::uint64_t first = 40 * 24 + 20 * 12 + 10 * 6;
    CHECK(visited == std::vector<std::uint64_t>{0x3000 + 2 * (first + 2 * 5 + 0), 0x3000 + 2 * (first + 2),
                                                0x3000 + 2 * (first + 1)});
}

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

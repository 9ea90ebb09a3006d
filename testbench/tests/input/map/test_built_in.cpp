#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <numeric>

#include "testbench/common/error.h"
#include "testbench/common/hash.h"
#include "testbench/input/map/built_in_maps.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/input/map/stroke_font.h"
#include "testbench/tests/input/map/map_test_files.h"
#include "testbench/tests/support/shared_data.h"
#include "testbench/tests/support/source_folder.h"

using namespace tessera;
using namespace tessera::map_test;
using Catch::Contains;

namespace {

// FNV-1a over the bits of the values.
std::uint64_t fingerprint(const HeightMap& map) {
    std::uint64_t hash = fnv1a_basis;
    for (const float value : map.values) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        hash = fnv1a(hash, bits);
    }
    return hash;
}

long code(float value) {
    return std::lround(static_cast<double>(value) * 65535);
}

}  // namespace

TEST_CASE("the half donut is a half torus") {
    const HeightMap map = half_donut_map(256, 256);
    CHECK(map.at(128, 128) == 0);                            // the hole
    CHECK(map.at(0, 0) == 0);                                // a corner
    CHECK(map.at(128 + 70, 128) == Approx(1).margin(1e-3));  // the crest, 0.55 from the centre
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            REQUIRE(map.at(x, y) == map.at(255 - x, y));
            REQUIRE(map.at(x, y) == map.at(y, x));
        }
    }
}

TEST_CASE("half donut and ramp agree with the reference maps to one code of 16 bits") {
    const auto folder = shared_data("maps");
    if (folder.empty())
        return;
    const auto differ = [](const HeightMap& a, const HeightMap& b) {
        REQUIRE(a.values.size() == b.values.size());
        long worst = 0;
        for (std::size_t i = 0; i < a.values.size(); ++i)
            worst = std::max(worst, std::labs(code(a.values[i]) - code(b.values[i])));
        return worst;
    };
    CHECK(differ(half_donut_map(256, 256), read_height_map(folder / "half_torus_256.pgm")) <= 1);
    CHECK(differ(ramp_map(256, 256), read_height_map(folder / "ramp_256.pgm")) <= 1);
}

TEST_CASE("the maps of the project's jobs equal those of the shared data") {
    const std::filesystem::path shared = shared_data("maps"), ours = source_folder() / "testbench/examples/jobs";
    if (shared.empty())
        return;
    const HeightMap crater = read_height_map(ours / "crater_lake_west.png");
    const HeightMap metres = read_height_map(shared / "crater_lake_west_336x459.pgm");
    REQUIRE(crater.values.size() == metres.values.size());
    std::size_t different = 0;
    for (std::size_t k = 0; k < metres.values.size(); ++k)
        different += code(crater.values[k]) != std::lround(2478 * static_cast<double>(metres.values[k]));
    CHECK(different == 0);
    CHECK(read_height_map(ours / "head_lee_perry_smith.png").values ==
          read_height_map(shared / "head_lps_512.pgm").values);
}

TEST_CASE("the maps of the project's jobs agree with ORIGINS.txt") {
    const std::filesystem::path ours = source_folder() / "testbench/examples/jobs";
    const HeightMap crater = read_height_map(ours / "crater_lake_west.png");
    REQUIRE(crater.width == 336);
    REQUIRE(crater.height == 459);
    const auto [lowest, highest] = std::minmax_element(crater.values.begin(), crater.values.end());
    CHECK(code(*lowest) == 1533);
    CHECK(code(*highest) == 2478);
    CHECK(code(crater.at(0, 458)) == 1633);  // the file's first sample, top left
    const HeightMap head = read_height_map(ours / "head_lee_perry_smith.png");
    CHECK(head.width == 512);
    CHECK(head.height == 512);
    CHECK(*std::min_element(head.values.begin(), head.values.end()) == 0);
    CHECK(*std::max_element(head.values.begin(), head.values.end()) == 1);
}

TEST_CASE("text is inside the map, with flat tops and soft edges, each character different") {
    const HeightMap map = text_map(512, 256, "Tessera 2000");
    double total = 0;
    bool top = false;
    bool edge = false;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const float value = map.at(x, y);
            REQUIRE(value >= 0);
            REQUIRE(value <= 1);
            if (x == 0 || y == 0 || x == map.width - 1 || y == map.height - 1)
                REQUIRE(value == 0);
            top = top || value == 1;
            edge = edge || (value > 0.4F && value < 0.6F);
            total += static_cast<double>(value);
        }
    }
    CHECK(top);
    CHECK(edge);
    CHECK(total > 0.05 * 512 * 256);
    std::vector<std::uint64_t> seen;
    for (const char character : stroke_font_characters()) {
        if (character != ' ') {
            const std::uint64_t hash = fingerprint(text_map(64, 64, std::string(1, character)));
            CHECK(std::find(seen.begin(), seen.end(), hash) == seen.end());
            seen.push_back(hash);
        }
    }
    CHECK(seen.size() >= 36);
    CHECK(text_map(64, 64, "abc").values == text_map(64, 64, "ABC").values);
    // An L has its foot at the bottom, right of its stem.
    const HeightMap letter = text_map(100, 100, "L");
    CHECK(letter.at(60, 20) == 1);
    CHECK(letter.at(60, 80) == 0);
    CHECK(letter.at(30, 80) == 1);
}

TEST_CASE("noise depends on seed and position only, and is about uniform") {
    const HeightMap map = noise_map(128, 64, 7);
    const HeightMap larger = noise_map(300, 70, 7);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x)
            REQUIRE(map.at(x, y) == larger.at(x, y));
    CHECK(map.values != noise_map(128, 64, 8).values);
    const double mean = std::accumulate(larger.values.begin(), larger.values.end(), 0.0) / (300 * 70);
    CHECK(mean == Approx(0.5).margin(0.01));
}

TEST_CASE("built-in maps have the same bits everywhere") {
    CHECK(fingerprint(half_donut_map(256, 200)) == 0xa0e83f27b5387951U);
    CHECK(fingerprint(text_map(300, 100, "Tessera 0.1")) == 0x43dcc665a32d6882U);
    CHECK(fingerprint(noise_map(100, 50, 1)) == 0x10781d6b2b919bd1U);
    CHECK(fingerprint(ramp_map(100, 3)) == 0x6fcfa14f7c06fb41U);
    CHECK(fingerprint(constant_map(3, 3, 0.3)) == 0x6f651fa89aab04cdU);
}

TEST_CASE("built-in maps refuse invalid parameters") {
    CHECK(constant_map(2, 3, 0.5).values == std::vector<float>(6, 0.5F));
    CHECK_THROWS_WITH(constant_map(2, 2, 1.5), Contains("value is 1.5; it must be 0 to 1"));
    for (const double end : {0.0, 1.0})
        CHECK_NOTHROW(constant_map(2, 2, end));
    CHECK_THROWS_AS(constant_map(2, 2, std::nan("")), InputError);
    CHECK_THROWS_WITH(ramp_map(0, 2), Contains("0 x 2 texels"));
    CHECK_THROWS_WITH(half_donut_map(2, 4097), Contains("2 x 4097"));
    CHECK_THROWS_AS(noise_map(-1, INT64_MAX, 1), InputError);
    CHECK_THROWS_WITH(text_map(256, 256, "50%"), Contains("no character \"%\" (code 37)"));
    CHECK_THROWS_WITH(text_map(256, 256, "  "), Contains("the text is empty"));
    CHECK_THROWS_WITH(text_map(256, 256, std::string(100, 'x')), Contains("they need 7"));
}

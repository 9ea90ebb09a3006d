// Values that mark missing data: map.no_data, and the remark on maps that seem to have them.
#include "testbench/input/map/no_data.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/tests/input/map/map_test_files.h"
#include "testbench/tests/support/shared_data.h"
#include "testbench/tests/support/source_folder.h"

using namespace tessera;
using namespace tessera::map_test;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

constexpr int side = 16;

/// A hill, `low` to `high` in source units, in which the first `holes` texels are `hole`. units: of the source.
HeightMap hill(double low, double high, double hole, int holes, double units = 1) {
    HeightMap map;
    map.width = map.height = side;
    map.source_units = units;
    for (int k = 0; k < side * side; ++k) {
        const double x = k % side - 7.5, y = k / side - 7.5;
        const double height = low + (high - low) * std::exp(-(x * x + y * y) / 6);
        map.values.push_back(static_cast<float>((k < holes ? hole : units > 1 ? std::round(height) : height) / units));
    }
    return map;
}

std::string hint(HeightMap map, const std::vector<double>& given = {}) {
    suspect_no_data(map, given);
    return map.no_data_hint;
}

/// The value that a hint advises, as in a job.
std::string advised(const std::string& text) {
    const std::string key = "map.no_data = ";
    const std::size_t at = text.find(key);
    return at == std::string::npos ? "" : text.substr(at + key.size());
}

ExrImage exr_of(const HeightMap& map, Pixels pixels) {
    ExrImage image{map.width, map.height, map.values};
    image.pixels = pixels;
    return image;
}

}  // namespace

TEST_CASE("texels of a no-data value get the lowest of the other values, and are counted") {
    HeightMap map = hill(35, 1235, -9999, 5);
    map.values[7] = std::numeric_limits<float>::quiet_NaN();
    map.values[8] = std::numeric_limits<float>::infinity();
    const float lowest = *std::min_element(map.values.begin() + 9, map.values.end());
    const float highest = *std::max_element(map.values.begin() + 9, map.values.end());
    const auto range = replace_missing(map, {-9999, 4});
    REQUIRE(range);
    CHECK(*range == std::array{lowest, highest});
    for (const std::size_t k : {0U, 1U, 2U, 3U, 4U, 7U})
        CHECK(map.values[k] == lowest);
    CHECK(map.values[8] == highest);
    REQUIRE(map.replaced.size() == 7);
    CHECK(map.replaced[4].texel == 4);
    CHECK(map.replaced[4].was == -9999);
    CHECK(map.replaced[6].texel == 8);
    REQUIRE(map.repairs.size() == 4);
    CHECK_THAT(map.repairs[0], Contains("1 NaN texel set to the lowest remaining value, 35"));
    CHECK_THAT(map.repairs[1], Contains("1 +infinity texel set to the highest remaining value"));
    CHECK_THAT(map.repairs[2], Contains("5 no-data (-9999) texels set to the lowest remaining value, 35"));
    CHECK_THAT(map.repairs[3], Contains("No texel has the value 4 of map.no_data; the map's values are 35"));
}

TEST_CASE("a no-data value matches the nearest number of the file's type, a huge one to 1 %") {
    struct Row {
        const char* name;
        Pixels pixels;
        float stored;
        double given;
        bool matches;
    };
    const float endless = std::numeric_limits<float>::infinity();
    const Row row = GENERATE_COPY(values<Row>({
        {"exact", Pixels::float_, -32767, -32767, true},
        {"a neighbour of it", Pixels::float_, -32767, -32766.99, false},
        {"another value", Pixels::float_, -32767, -32768, false},
        {"float's lowest, with its digits", Pixels::float_, std::numeric_limits<float>::lowest(),
         -3.4028234663852886e38, true},
        {"float's lowest, as it is usually printed", Pixels::float_, std::numeric_limits<float>::lowest(), -3.4e38,
         true},
        {"of the other sign", Pixels::float_, std::numeric_limits<float>::lowest(), 3.4e38, false},
        {"double's lowest, which a float file has as -infinity", Pixels::float_, -endless, -1.7976931348623157e308,
         true},
        {"a decimal fraction", Pixels::float_, 0.1F, 0.1, true},
        {"1e20", Pixels::float_, 1e20F, 1e20, true},
        {"1e20, nearly", Pixels::float_, 1e20F, 1.001e20, false},
        {"half has no -9999", Pixels::half, -9999, -9999, true},
        {"half has no 1e20", Pixels::half, endless, 1e20, true},
        {"half's highest", Pixels::half, 65504, 65504, true},
        {"half's neighbour", Pixels::half, -9999, -9992, false},
        {"uint's highest", Pixels::uint, 4294967040.F, 4294967040.0, true},
    }));
    INFO(row.name);
    const TestFolder folder;
    write_exr(folder / "a.exr", exr_of(hill(35, 1235, static_cast<double>(row.stored), 3), row.pixels));
    const HeightMap map = read_height_map(folder / "a.exr", "", {row.given});
    CHECK((map.range_low > 34 && map.range_high < 1300) == (row.matches || std::isinf(row.stored)));
    CHECK((map.replaced.size() == 3) == (row.matches || std::isinf(row.stored)));
    const std::string text = row.matches ? "3 no-data" : "No texel has the value";
    CHECK(std::any_of(map.repairs.begin(), map.repairs.end(),
                      [&](const std::string& repair) { return repair.find(text) != std::string::npos; }));
}

TEST_CASE("no-data values of PGM and PNG are samples, and a map of nothing else is refused") {
    const TestFolder folder;
    for (const int hole : {0, 32768, 65535}) {
        const HeightMap map = hill(1035, 2235, hole, 6, 65535);
        std::vector<std::uint8_t> bytes;
        std::string text = "P2 16 16 65535\n";
        for (const float value : map.values) {
            const auto sample = static_cast<unsigned>(std::lround(value * 65535));
            bytes.push_back(static_cast<std::uint8_t>(sample >> 8));
            bytes.push_back(static_cast<std::uint8_t>(sample));
            text += std::to_string(sample) + "\n";
        }
        write_png(folder / "a.png", {side, side, 16, 0, bytes, {}});
        write_all(folder / "a.pgm", text);
        for (const char* const name : {"a.png", "a.pgm"}) {
            const HeightMap read = read_height_map(folder / name, "", {static_cast<double>(hole)});
            const auto [low, high] = std::minmax_element(read.values.begin(), read.values.end());
            CHECK(*low * 65535 == Approx(1035));
            CHECK(*high * 65535 > 2100);
            CHECK(*high * 65535 <= 2235.01);
            CHECK(read.replaced.size() == 6);
            CHECK(read.range_low == 0);  // the whole of the format, as before
            CHECK(read.range_high == 1);
        }
    }
    write_all(folder / "b.pgm", "P2 2 1 9\n4 4\n");
    CHECK_THROWS_WITH(read_height_map(folder / "b.pgm", "", {4}), Contains("all 2 texels have a value in map.no_data"));
    write_exr(folder / "b.exr", {2, 1, {-9999, std::numeric_limits<float>::quiet_NaN()}});
    CHECK_THROWS_WITH(read_height_map(folder / "b.exr", "", {-9999}), Contains("all 2 texels"));
}

TEST_CASE("a map that seems to have missing data says which value, how many texels, the gap and the key") {
    CHECK_THAT(hint(hill(35, 1235, -9999, 20)),
               StartsWith("20 texels hold exactly the lowest value, -9999, which is 10034 from the next, 35") &&
                   EndsWith(": if that marks missing data, set map.no_data = -9999"));
    struct Row {
        double low, high, hole, units;
    };
    for (const Row& row :
         {Row{35, 1235, -32767, 1}, Row{35, 1235, -32768, 1}, Row{35, 1235, -3.4e38, 1}, Row{35, 1235, 1e20, 1},
          Row{35, 1235, 9999, 1}, Row{-8, -7, 0, 1}, Row{0.2, 0.3, -1, 1}, Row{35, 1235, 65535, 65535},
          Row{35, 1235, 32768, 65535}, Row{33000, 34200, 0, 65535}, Row{1533, 2478, 0, 2478}}) {
        INFO(row.hole << " in " << row.low << " to " << row.high);
        for (const int holes : {3, 100}) {
            HeightMap map = hill(row.low, row.high, row.hole, holes, row.units);
            const std::string value = advised(hint(map));
            REQUIRE_FALSE(value.empty());
            REQUIRE(replace_missing(map, {std::stod(value)}));  // the advice works
            CHECK(map.replaced.size() == static_cast<std::size_t>(holes));
            CHECK(hint(map) == "");
        }
    }
    INFO("several values, in addition to those given");
    HeightMap map = hill(35, 1235, 1e20, 9);
    map.values[0] = map.values[1] = -9999;
    CHECK(advised(hint(map, {7})) == "[7, 1e+20, -9999]");
    INFO("one texel of few values only if nothing else is left of the relief");
    CHECK(advised(hint(hill(35, 1235, -3.4e38, 1))) == "-3.4e+38");
    CHECK(hint(hill(35, 1235, -9999, 1)) == "");
    INFO("few other values, if no height can be the one");
    HeightMap two = hill(0, 0, -3.4e38, 30);
    two.values.back() = 0.25F;
    CHECK(advised(hint(two)) == "-3.4e+38");
}

TEST_CASE("a value within the heights that often marks missing data is told if its texels stand out") {
    constexpr int size = 32, from = 3 * size * size / 4;
    HeightMap slope;
    slope.width = slope.height = size;
    for (int k = 0; k < size * size; ++k)
        slope.values.push_back(-10900 + 19000.0F * static_cast<float>(k) / (size * size));
    const auto hint_with = [&](float hole, int holes) {
        HeightMap map = slope;
        std::fill_n(map.values.begin() + from, holes, hole);
        return hint(map);
    };
    for (const float hole : {-9999.0F, 999.0F, -999.0F}) {
        const std::string text = hint_with(hole, 5);
        INFO(hole << ' ' << text);
        CHECK_THAT(text, StartsWith("5 texels hold exactly " + std::to_string(static_cast<int>(hole)) +
                                    ", and those beside them differ from it by "));
        CHECK(advised(text) == std::to_string(static_cast<int>(hole)));
        CHECK(hint_with(hole, 3) == "");
    }
    CHECK(hint_with(-9998, 5) == "");
    INFO("a plain at that height");
    HeightMap plain = slope;
    for (float& value : plain.values)
        if (std::abs(value + 9999) < 300)
            value = -9999;
    CHECK(hint(plain) == "");
    INFO("the lowest value, a little apart");
    std::fill_n(plain.values.begin() + from, 100, -12500.0F);
    CHECK(advised(hint(plain)) == "-12500");
    std::fill_n(plain.values.begin() + from, 100, -11000.0F);
    CHECK(hint(plain) == "");
    INFO("0 below heights of 300 to 2000");
    for (float& value : slope.values)
        value = 300 + (value + 10900) * 1700 / 19000;
    CHECK(advised(hint_with(0, 100)) == "0");
    CHECK(hint_with(0, 3) == "");
}

namespace {

constexpr int wide = 64;

/// A smooth relief, `low` to `high` in source units, with a square of `hole` on its slopes.
HeightMap relief(double low, double high, double hole, int hole_side, double units = 1) {
    HeightMap map;
    map.width = map.height = wide;
    map.source_units = units;
    for (int y = 0; y < wide; ++y)
        for (int x = 0; x < wide; ++x) {
            const double part = 0.5 + 0.3 * std::sin(0.1 * x + 0.003 * y) + 0.2 * std::sin(0.1 * y + 0.7);
            const bool is_hole = x >= 30 && x < 30 + hole_side && y >= 20 && y < 20 + hole_side;
            const double value = is_hole ? hole : low + (high - low) * part;
            map.values.push_back(static_cast<float>((units > 1 ? std::round(value) : value) / units));
        }
    return map;
}

}  // namespace

TEST_CASE("a value that stands out from the texels beside it is told though it is not far from all heights") {
    struct Row {
        const char* kind;
        double low, high, hole, units;
        int hole_side, too_small;  // 0: not tried
    };
    for (const Row& row : {
             Row{"an outermost marker", 20000, 60000, 65535, 65535, 5, 1},
             Row{"an outermost marker", 2000, 8848, 9999, 1, 5, 1},
             Row{"an outermost marker", -9000, 8000, -9999, 1, 5, 1},
             Row{"an outermost marker", -9500, 8000, -9999, 1, 5, 1},
             Row{"-9999 + 32768", 21768, 40768, 22769, 65535, 5, 1},
             Row{"0, the lowest value", 300, 2000, 0, 65535, 3, 1},
             Row{"another lowest value", 300, 2000, 100, 1, 8, 7},
             Row{"the highest value", 300, 2000, 2300, 1, 8, 7},
             Row{"the only negative value", 0, 500, -1, 1, 5, 1},
             Row{"the only negative value", 0, 2000, -99, 1, 5, 1},
             Row{"0 among heights", -1500, 400, 0, 1, 10, 7},
             Row{"0..1", 0.15, 1, 0, 1, 10, 7},
             Row{"0..1", 0, 0.85, 1, 1, 10, 7},
             Row{"8 bits", 30, 250, 0, 255, 10, 7},
             Row{"8 bits", 10, 210, 255, 255, 10, 7},
             Row{"any value", -11000 * 3.28, 8000 * 3.28, -9999 * 3.28, 1, 10, 7},
             Row{"any value", 0, 19000, 1001, 1, 10, 7},
         }) {
        INFO(row.kind << ": " << row.hole << " in " << row.low << " to " << row.high);
        HeightMap map = relief(row.low, row.high, row.hole, row.hole_side, row.units);
        const std::string text = hint(map);
        CHECK_THAT(text, StartsWith(std::to_string(row.hole_side * row.hole_side) + " texels hold exactly "));
        REQUIRE_FALSE(advised(text).empty());
        REQUIRE(replace_missing(map, {std::stod(advised(text))}));
        CHECK(map.replaced.size() == static_cast<std::size_t>(row.hole_side * row.hole_side));
        CHECK(hint(map) == "");
        CHECK(hint(relief(row.low, row.high, row.hole, row.too_small, row.units)) == "");
        // In noise every value differs from those beside it.
        std::uint32_t random = 1;
        for (float& value : map.values) {
            random = random * 1664525 + 1013904223;
            value = static_cast<float>((row.low + (row.high - row.low) * (random >> 24) / 255) / row.units);
            if (random >> 24 == 255)
                value = static_cast<float>(row.hole / row.units);
        }
        map.replaced.clear();
        CHECK(hint(map) == "");
    }
}

TEST_CASE("a value among the heights is told beside one far from them") {
    HeightMap map = relief(-11000, 8000, -9999, 5);
    std::fill_n(map.values.begin(), 9, -3.4e38F);
    CHECK(advised(hint(map)) == "[-3.4e+38, -9999]");
}

TEST_CASE("level parts of ordinary maps do not seem to be missing data") {
    const auto levelled = [](double from, double to, auto level) {
        HeightMap map = relief(from, to, 0, 0);
        for (float& value : map.values)
            value = static_cast<float>(level(static_cast<double>(value)));
        return hint(map);
    };
    CHECK(levelled(-800, 900, [](double z) { return std::clamp(z, -500.0, 600.0); }) == "");      // clipped
    CHECK(levelled(-800, 900, [](double z) { return std::abs(z) < 100 ? 0 : z; }) == "");         // a plain
    CHECK(levelled(0, 900, [](double z) { return z < 200 ? 199 : z; }) == "");                    // a lake
    CHECK(levelled(0, 65535, [](double z) { return z < 40000 ? z : 65535; }) != "");              // a hole
    CHECK(levelled(0, 1000, [](double z) { return std::round(z / 20) * 20 + z / 1000; }) == "");  // terraces
    INFO("flat roofs");
    HeightMap town = relief(0, 20, 0, 0);
    for (int k = 0; k < 9; ++k)
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 9; ++x)
                town.at(5 + 20 * (k % 3) + x, 5 + 20 * (k / 3) + y) = static_cast<float>(40 + 3 * k);
    CHECK(hint(town) == "");
    INFO("padding that meets others at one end");
    HeightMap padded = relief(0, 0, 0, 0);
    for (int y = 0; y < wide; ++y)
        for (int x = 0; x < wide; ++x)
            padded.at(x, y) = x >= 30 && x < 50 && y >= 20 && y < 24
                                  ? 30.205F
                                  : static_cast<float>(x) + 0.01F * static_cast<float>(y);
    CHECK(hint(padded) == "");
    INFO("texels set to the lowest height");
    HeightMap filled = relief(1, 500, 1e20, 10);
    filled.values.front() = -1;
    REQUIRE(replace_missing(filled, {1e20}));
    CHECK(hint(filled) == "");
    INFO("0 as a ground with figures on it and in it");
    HeightMap ground = relief(-0.1, 3, 0, 0);
    for (int y = 0; y < wide; ++y)
        for (int x = 0; x < wide; ++x)
            if (y < 40)
                ground.at(x, y) = 0;
    CHECK(hint(ground) == "");
}

TEST_CASE("beside many values, which lie close together, a narrower gap is enough") {
    const auto slope = [](double low, double high, double hole, int holes, double units) {
        HeightMap map;
        map.width = map.height = 32;
        map.source_units = units;
        for (int k = 0; k < 1024; ++k)
            map.values.push_back(static_cast<float>(
                (k < holes ? hole : std::round(low + (high - low) * std::sqrt(k / 1023.0))) / units));
        return advised(hint(map));
    };
    CHECK(slope(535, 1735, 0, 40, 65535) == "0");
    CHECK(slope(1035, 2238, 0, 40, 1) == "0");
    CHECK(slope(35, 1236, -500, 40, 1) == "-500");
    CHECK(slope(35, 1236, -9999, 1, 1) == "-9999");
    CHECK(slope(35, 1236, 9999, 1, 1) == "9999");
    CHECK(slope(35, 1236, 100, 40, 1) == "");   // a cliff
    CHECK(slope(35, 1236, -4000, 1, 1) == "");  // a shaft
}

TEST_CASE("0 and full scale of 8 bits and of 0..1 may mark missing data, too") {
    struct Row {
        double low, high, hole, units;
        const char* value;
    };
    for (const Row& row : {Row{0.6, 0.9, 0, 1, "0"}, Row{0.1, 0.3, 1, 1, "1"}, Row{150, 255, 0, 255, "0"},
                           Row{10, 90, 255, 255, "255"}, Row{60, 200, 0, 255, "0"}, Row{100, 200, 255, 255, "255"}}) {
        INFO(row.hole << " in " << row.low << " to " << row.high);
        HeightMap map;
        map.width = map.height = 32;
        map.source_units = row.units;
        for (int k = 0; k < 1024; ++k) {
            const double height = row.low + (row.high - row.low) * k / 1023;
            map.values.push_back(static_cast<float>((k < 40          ? row.hole
                                                     : row.units > 1 ? std::round(height)
                                                                     : height) /
                                                    row.units));
        }
        CHECK(advised(hint(map)) == row.value);
        REQUIRE(replace_missing(map, {std::stod(row.value)}));
        CHECK(map.replaced.size() == 40);
        CHECK(hint(map) == "");
    }
}

TEST_CASE("several nearly equal values that mark missing data are advised together") {
    struct Row {
        double first, second, units;
        const char* advice;
    };
    for (const Row& row : {Row{-32767, -32768, 1, "[-32768, -32767]"}, Row{-9999, -9998.99, 1, "[-9999, -9998.99]"},
                           Row{65534, 65535, 65535, "[65535, 65534]"}}) {
        INFO(row.advice);
        HeightMap map = hill(35, 1235, row.first, 9, row.units);
        for (std::size_t k = 0; k < 4; ++k)
            map.values[k] = static_cast<float>(row.second / row.units);
        const std::string text = hint(map);
        CHECK_THAT(text, StartsWith("9 texels hold one of the ") && Contains(" values, ") && Contains(", which are "));
        CHECK(advised(text) == row.advice);
        REQUIRE(replace_missing(map, {row.first, row.second}));
        CHECK(map.replaced.size() == 9);
        CHECK(hint(map) == "");
    }
    INFO("a spire of two texels");
    HeightMap spire = hill(0, 100, 0, 0);
    spire.values[0] = 400;
    spire.values[1] = 401;
    CHECK(hint(spire) == "");
}

TEST_CASE("beside few levels a value that marks missing data is far from all") {
    const auto steps = [](float hole, std::vector<float> levels, double units = 1) {
        HeightMap map = hill(0, 0, 0, 0, units);
        for (std::size_t k = 0; k < map.values.size(); ++k)
            map.values[k] = static_cast<float>(static_cast<double>(k < 20 ? hole : levels[k % levels.size()]) / units);
        return advised(hint(map));
    };
    CHECK(steps(-9999, {100, 110, 120}) == "-9999");
    CHECK(steps(-9999, {0, 0.25F}) == "-9999");
    CHECK(steps(-32768, {500}) == "-32768");
    CHECK(steps(65535, {100, 101, 105}, 65535) == "65535");
    CHECK(steps(-1, {0, 1}) == "");
    CHECK(steps(-1, {1}) == "");
    CHECK(steps(-1000, {1000}) == "");
    CHECK(steps(65535, {0}, 65535) == "");
    CHECK(steps(0, {255}, 255) == "");
    CHECK(steps(0, {200, 201, 202}, 255) == "");
    CHECK(steps(0, {60000, 60001}, 65535) == "");
}

TEST_CASE("values between missing data and heights, beside the missing data, are noticed as a blurred border") {
    // Heights with a square hole; each texel is the mean of those up to `reach` away.
    const auto blurred = [](double low, double high, double hole, int reach, double units) {
        HeightMap map = hill(low, high, 0, 0, units);
        const auto is_hole = [](int x, int y) { return x >= 1 && x < 8 && y >= 2 && y < 9; };
        const HeightMap sharp = map;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                double sum = 0;
                int count = 0;
                for (int row = std::max(y - reach, 0); row <= std::min(y + reach, side - 1); ++row)
                    for (int column = std::max(x - reach, 0); column <= std::min(x + reach, side - 1);
                         ++column, ++count)
                        sum += is_hole(column, row) ? hole : static_cast<double>(sharp.at(column, row)) * units;
                const double value = sum / count;
                map.at(x, y) = static_cast<float>((units > 1 ? std::round(value) : value) / units);
            }
        return map;
    };
    struct Row {
        double low, high, hole, units;
        const char* value;
    };
    for (const Row& row : {Row{35, 1235, -9999, 1, "-9999"}, Row{35, 1235, -32768, 1, "-32768"},
                           Row{1000, 2200, 65535, 65535, "65535"}, Row{-8, -7, 9999, 1, "9999"}})
        for (const int reach : {1, 2}) {
            INFO(row.hole << ", reach " << reach);
            HeightMap map = blurred(row.low, row.high, row.hole, reach, row.units);
            const std::string text = hint(map);
            CHECK_THAT(text, Contains(" texels within 6 of those that hold " + std::string(row.value) +
                                      " lie between that value") &&
                                 Contains("export the map again without interpolation across them"));
            CHECK(advised(text) == row.value);
            REQUIRE(replace_missing(map, {row.hole}));
            CHECK_THAT(hint(map, {row.hole}), Contains("of those that held " + std::string(row.value)) &&
                                                  Contains("export the map again") && !Contains("set map.no_data"));
            map = blurred(row.low, row.high, row.hole, 0, row.units);
            REQUIRE(replace_missing(map, {row.hole}));
            CHECK(hint(map) == "");
        }
    INFO("a hill and a basin on a plain, with level ground");
    for (const double sign : {1, -1}) {
        HeightMap level = hill(0, sign * 900, 0, 0);
        for (float& value : level.values)
            value = static_cast<float>(std::clamp(static_cast<double>(value), -500.0, 500.0));
        CHECK(hint(level) == "");
    }
    INFO("smoothed letters on a floor");
    CHECK(hint(blurred(0, 0, 65535, 1, 65535)) == "");
    CHECK(hint(blurred(65535, 65535, 0, 2, 65535)) == "");
    INFO("a lake with gentle shores");
    CHECK(hint(blurred(1000, 1900, 500, 2, 1)) == "");
}

TEST_CASE("a sample of 16 bits is named as the file has it") {
    for (const int hole : {55537, 40001, 65534, 33333})
        CHECK_THAT(hint(hill(35, 1235, hole, 6, 65535)),
                   Contains("highest value, " + std::to_string(hole) + ", which is") &&
                       EndsWith("map.no_data = " + std::to_string(hole)));
}

TEST_CASE("ordinary maps do not seem to have missing data") {
    HeightMap sea = hill(0, 900, 0, 0);
    for (float& value : sea.values)
        value = std::max(value, 300.F);
    CHECK(hint(sea) == "");
    sea = hill(0, 900, 0, 0);
    for (float& value : sea.values)
        value = value < 100 ? 0 : value;  // a cliff coast
    CHECK(hint(sea) == "");
    CHECK(hint(hill(35, 1235, -500, 20)) == "");
    sea = hill(0, 200, 0, 0, 255);
    for (float& value : sea.values)
        value = std::max(value - 40 / 255.F, 0.F);
    CHECK(hint(sea) == "");
    CHECK(hint(hill(60, 255, 0, 1, 255)) == "");
    HeightMap mask = hill(0, 0, 1, 100, 65535);
    CHECK(hint(mask) == "");
    for (const int levels : {1, 2, 3, 7}) {
        for (std::size_t k = 0; k < mask.values.size(); ++k)
            mask.values[k] = static_cast<float>(
                k % 3 == 0 ? 0 : 0.9 + 0.01 * static_cast<double>(k % static_cast<unsigned>(levels)));
        CHECK(hint(mask) == "");
    }
    int count = 0;
    for (const auto& folder : {shared_data("maps"), source_folder() / "testbench/examples/jobs"}) {
        if (folder.empty())
            continue;
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".pgm" && extension != ".png")
                continue;
            ++count;
            INFO(entry.path());
            CHECK(hint(read_height_map(entry.path())) == "");
        }
    }
    CHECK(count >= 3);
}

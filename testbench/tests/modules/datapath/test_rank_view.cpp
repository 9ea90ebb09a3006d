#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <set>

#include "modules/datapath/rank_view.h"
#include "testbench/common/random.h"

using namespace tessera::datapath;
using tessera::Random;

namespace {

Formats with_distances(int rank_bits = 16, int bound_bits = 16) {
    Formats formats;
    formats.height_test = HeightTest::rank;
    formats.distances = true;
    formats.rank_bits = rank_bits;
    formats.bound_bits = bound_bits;
    return formats;
}

/// The distance of (0, 0, 0) from an eye at (x, y, z).
std::uint32_t distance_from(std::int64_t x, std::int64_t y, std::int64_t z, const Formats& formats) {
    TransformParameters parameters;
    parameters.eye = {x, y, z};
    return eye_distance({0, 0, 0}, parameters, formats);
}

}  // namespace

TEST_CASE("D is at most the Euclidean distance, and at least 0.873 of it, from every side", "[rank]") {
    const Formats formats = with_distances();
    Random random(1);
    double least = 1, most = 0;
    for (int trial = 0; trial < 200000; ++trial) {
        const auto component = [&] { return random.integer(-1000000000, 1000000000); };
        const std::array<std::int64_t, 3> v{component(), component(), component()};
        const auto [x, y, z] = v;
        const double length = std::sqrt(static_cast<double>(x) * static_cast<double>(x) +
                                        static_cast<double>(y) * static_cast<double>(y) +
                                        static_cast<double>(z) * static_cast<double>(z));
        const std::uint32_t d = distance_from(x, y, z, formats);
        REQUIRE(d == distance_from(-z, x, -y, formats));
        least = std::min(least, (d + 1) / length);
        most = std::max(most, d / length);
    }
    CHECK(least > 0.873);
    CHECK(least < 0.876);
    CHECK(most <= 1);
}

TEST_CASE("D changes by no more than the distance moved, and saturates", "[rank]") {
    Formats formats = with_distances();
    formats.view_distance = Format::make_signed(32, 13);  // 3 bits fewer than positions
    Random random(2);
    for (int trial = 0; trial < 100000; ++trial) {
        const auto near = [&](std::int64_t to, std::int64_t step) { return to + random.any_size(step); };
        const std::int64_t x = near(0, std::int64_t{1} << 38), y = near(0, std::int64_t{1} << 38), z = near(0, 1 << 30);
        const std::int64_t dx = random.any_size(1 << 20), dy = random.any_size(1 << 20), dz = random.any_size(1 << 20);
        const std::int64_t a = distance_from(x, y, z, formats), b = distance_from(x + dx, y + dy, z + dz, formats);
        REQUIRE(std::abs(a - b) <= std::int64_t{distance_from(dx, dy, dz, formats)} + 2);
    }
    CHECK(distance_from(std::int64_t{1} << 39, 0, 0, formats) == 0xffffffff);
    CHECK(distance_from(80, 0, 0, formats) == 10);
    CHECK(distance_from(87, 0, 0, formats) == 10);
}

TEST_CASE("the level is the logarithm, linear between powers of two and rounded down", "[rank]") {
    CHECK(distance_level(0) == 0);
    std::uint32_t before = 0;
    for (std::uint64_t distance = 1; distance < std::uint64_t{1} << 36; distance += 1 + distance / 1000) {
        const std::uint32_t level = distance_level(distance);
        const double exact = std::log2(static_cast<double>(distance)), found = level / 4096.0;
        REQUIRE(found <= exact);
        REQUIRE(found > exact - 0.0864);
        REQUIRE(level >= before);
        before = level;
    }
    CHECK(distance_level(1) == 0);
    CHECK(distance_level(2) == 4096);
    CHECK(distance_level(3) == 4096 + 2048);
    CHECK(distance_level(std::uint64_t{1} << 33) == 33 * 4096);
}

TEST_CASE("a radius has four significant bits and an exponent", "[rank]") {
    CHECK(midpoint_radius(0) == 8);
    CHECK(midpoint_radius(7) == 15);
    CHECK(midpoint_radius(8) == 16);
    CHECK(midpoint_radius(255) == std::uint64_t{15} << 31);
    for (std::uint32_t code = 1; code < 256; ++code)
        REQUIRE(midpoint_radius(code) > midpoint_radius(code - 1));
}

TEST_CASE("an entry's radius is in the bits above its bound, if it has a bound", "[rank]") {
    const Formats formats = with_distances(6, 9);
    REQUIRE(rank_entry_bits(formats) == 6 + 9 + 8);
    const RankEntry entry = rank_entry(0x15u | 0x155u << 6 | std::uint64_t{0xa5} << 15, formats);
    CHECK(entry.rank == 0x15);
    CHECK(entry.bound == 0x155);
    CHECK(entry.radius == 0xa5);
    CHECK(rank_entry_bits(with_distances(8, 0)) == 8);
    CHECK(rank_entry(0xff, with_distances(8, 0)).radius == 0);
}

TEST_CASE("the thresholds rise with distance: per octave a rank's by two or four, a bound's by one", "[rank]") {
    TestParameters parameters;
    const auto asks = [&](const RankEntry& entry, std::uint64_t distance, const Formats& formats) {
        return rank_test_in_view(entry, {distance, 0}, parameters, formats);
    };
    // A rank has 10 fraction bits, a bound 11.
    const std::uint32_t rank = 40 << 10;
    parameters.height_thresholds[rank_number] = (20 << 10) - 1;
    CHECK(asks({rank, 0}, 1 << 10, with_distances()));
    CHECK_FALSE(asks({rank - 1, 0}, 1 << 10, with_distances()));
    CHECK(asks({rank - (2 << 10), 0}, 1 << 9, with_distances()));
    CHECK_FALSE(asks({rank - (2 << 10) - 1, 0}, 1 << 9, with_distances()));
    CHECK(asks({rank >> 10, 0}, 1 << 10, with_distances(6, 0)));  // the same on a scale of 6 bits
    CHECK_FALSE(asks({(rank >> 10) - 1, 0}, 1 << 10, with_distances(6, 0)));
    parameters.rank_per_pixel = true;
    CHECK(asks({rank, 0}, 1 << 5, with_distances()));
    CHECK_FALSE(asks({rank - 1, 0}, 1 << 5, with_distances()));

    const std::uint32_t bound = 20 << 11;
    parameters.height_thresholds[bound_number] = (10 << 11) - 1;
    CHECK(asks({0, bound, 0}, (1 << 10) + 8, with_distances()));  // the least radius is 8
    CHECK_FALSE(asks({0, bound - 1, 0}, (1 << 10) + 8, with_distances()));
    CHECK(asks({0, bound - (1 << 11), 8}, (1 << 9) + 16, with_distances()));
    CHECK_FALSE(asks({0, bound - (1 << 11) - 1, 8}, (1 << 9) + 16, with_distances()));
    CHECK(asks({0, bound >> 10, 0}, (1 << 10) + 8, with_distances(0, 6)));
    CHECK_FALSE(asks({0, (bound >> 10) - 1, 0}, (1 << 10) + 8, with_distances(0, 6)));
}

TEST_CASE("a sphere around the eye splits, one behind the viewer does not, nor does an entry of 0", "[rank]") {
    const Formats formats = with_distances();
    TestParameters parameters;
    parameters.height_thresholds[bound_number] = parameters.height_thresholds[rank_number] = 65535;
    CHECK(rank_test_in_view({0, 1, 0}, {8, 0}, parameters, formats));
    CHECK_FALSE(rank_test_in_view({0, 1, 0}, {9, 0}, parameters, formats));
    CHECK(rank_test_in_view({0, 1, 0}, {8, -8}, parameters, formats));
    CHECK_FALSE(rank_test_in_view({0, 1, 0}, {8, -9}, parameters, formats));
    parameters.height_thresholds[bound_number] = -(1 << (bound_limit_bits - 1));
    parameters.height_thresholds[rank_number] = -(1 << (rank_limit_bits - 1));
    CHECK_FALSE(rank_test_in_view({0, 0, 0}, {0, 0}, parameters, formats));
    CHECK_FALSE(rank_test_in_view({0, 0, 255}, {0, 0}, parameters, formats));
    const std::uint64_t farthest = std::uint64_t{0xffffffff} * 2;
    CHECK(rank_test_in_view({1, 0, 0}, {farthest, 0}, parameters, formats));
    CHECK(rank_test_in_view({0, 1, 0}, {farthest, 0}, parameters, formats));
    parameters.rank_per_pixel = true;
    CHECK(rank_test_in_view({1, 0, 0}, {farthest, 0}, parameters, formats));
}

TEST_CASE("an edge decides alike from either end, and a thousand random edges give both decisions", "[rank]") {
    Random random(3);
    std::set<bool> found;
    for (int trial = 0; trial < 1000; ++trial) {
        const auto end = [&] {
            ScreenPosition at;
            at.w = random.integer32(-1000000, 1000000);
            at.distance = random.natural(0, 0xffffffff) >> random.natural(0, 31);
            return at;
        };
        const ScreenPosition i = end(), j = end();
        const RankEntry entry{random.natural(0, 65535), random.natural(0, 65535), random.natural(0, 255)};
        TestParameters parameters;
        parameters.rank_per_pixel = random.coin();
        parameters.height_thresholds[rank_number] = random.integer32(-100000, 60000);
        parameters.height_thresholds[bound_number] = random.integer32(-60000, 60000);
        const Formats formats = with_distances();
        const bool asks = asks_by_rank(entry, edge_in_view(i, j), parameters, formats);
        REQUIRE(asks == asks_by_rank(entry, edge_in_view(j, i), parameters, formats));
        found.insert(asks);
    }
    CHECK(found.size() == 2);
}

#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>

#include "modules/datapath/format.h"
#include "testbench/common/random.h"
#include "testbench/tests/modules/datapath/datapath_reference.h"

using namespace tessera::datapath;
using namespace tessera::testing;
using tessera::Random;

TEST_CASE("formats: lowest and highest values") {
    for (int bits = 1; bits <= 48; ++bits) {
        const Format s = Format::make_signed(bits, 0), u = Format::make_unsigned(bits, 3);
        CHECK(static_cast<double>(s.lowest) == -std::ldexp(1.0, bits - 1));
        CHECK(static_cast<double>(s.highest) == std::ldexp(1.0, bits - 1) - 1);
        CHECK(u.lowest == 0);
        CHECK(static_cast<double>(u.highest) == std::ldexp(1.0, bits) - 1);
        CHECK(u.fraction == 3);
    }
    // the last border of a map of 4096 texels
    CHECK(Formats{}.texture.highest >= 4096 << Formats{}.texture.fraction);
}

TEST_CASE("saturate: gives the nearest value that fits, counts each saturation once") {
    for (const Format& format : {Format::make_signed(8, 4), Format::make_unsigned(8, 0), Format::make_signed(1, 0)}) {
        for (std::int64_t value = -1000; value <= 1000; ++value) {
            std::uint64_t count = 7;
            const std::int64_t result = saturate(value, format, count);
            const bool fits = value >= format.lowest && value <= format.highest;
            if (result != static_cast<std::int64_t>(clamped(value, format.lowest, format.highest)) ||
                count != (fits ? 7u : 8u))
                FAIL(value << " in " << format.bits << " bits gives " << result << ", counted " << count - 7);
        }
    }
    std::uint64_t count = 0;
    const Format wide = Format::make_signed(32, 16);
    CHECK(saturate(std::numeric_limits<std::int64_t>::min(), wide, count) == wide.lowest);
    CHECK(saturate(std::numeric_limits<std::int64_t>::max(), wide, count) == wide.highest);
    CHECK(count == 2);
}

TEST_CASE("saturations: sums and totals include every counter") {
    Saturations a;
    a.displaced_position = 1;
    a.normal = 2;
    a.screen_position = 4;
    a.screen_normal = 8;
    a.degenerate_normal = 16;
    Saturations b = a;
    b += a;
    CHECK(b.displaced_position == 2);
    CHECK(b.normal == 4);
    CHECK(b.screen_position == 8);
    CHECK(b.screen_normal == 16);
    CHECK(b.degenerate_normal == 32);
    CHECK(a.total() == 31);
    CHECK(b.total() == 62);
}

TEST_CASE("round_shift: rounds to nearest, ties upwards") {
    for (int shift = 0; shift <= 9; ++shift) {
        for (std::int64_t value = -2048; value <= 2048; ++value) {
            const auto expected =
                static_cast<std::int64_t>(std::floor(std::ldexp(static_cast<double>(value), -shift) + 0.5));
            if (round_shift(value, shift) != expected)
                FAIL(value << " by " << shift << " gives " << round_shift(value, shift) << " for " << expected);
        }
    }
    Random random(1);
    for (int k = 0; k < 1'000'000; ++k) {
        const int shift = static_cast<int>(random.integer(0, 62));
        // up to the header's limit: |value| + half fits 64 bits
        const std::int64_t half = shift == 0 ? 0 : std::int64_t{1} << (shift - 1);
        const std::int64_t value = random.any_size(std::numeric_limits<std::int64_t>::max() - half);
        if (round_shift(value, shift) != nearest(value, shift))
            FAIL(value << " by " << shift << " gives " << round_shift(value, shift));
    }
}

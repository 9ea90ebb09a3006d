#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "modules/datapath/midpoint.h"
#include "testbench/common/random.h"

using namespace tessera::datapath;
using tessera::Random;

namespace {

template <class Integer>
bool right(Integer a, Integer b) {
    const Integer middle = midpoint(a, b);
    // a sum of two 32-bit integers is exact in a double
    return static_cast<double>(middle) == std::floor((static_cast<double>(a) + static_cast<double>(b)) / 2) &&
           middle == midpoint(b, a) && middle >= std::min(a, b) && middle <= std::max(a, b);
}

}  // namespace

TEST_CASE("midpoint: floor of the mean, commutative, between its operands, every pair of 8 bits") {
    for (std::int32_t a = -128; a <= 127; ++a) {
        for (std::int32_t b = -128; b <= 127; ++b)
            if (!right(a, b) || !right(static_cast<std::uint32_t>(a + 128), static_cast<std::uint32_t>(b + 128)))
                FAIL(a << ", " << b << " gives " << midpoint(a, b));
    }
}

TEST_CASE("midpoint: 32-bit operands, limits included") {
    Random random(2);
    const std::int64_t limit = std::numeric_limits<std::int32_t>::max();
    for (int k = 0; k < 1'000'000; ++k) {
        const auto a = static_cast<std::int32_t>(random.any_size(limit)),
                   b = static_cast<std::int32_t>(random.any_size(limit));
        const auto c = static_cast<std::uint32_t>(random.bits()), d = static_cast<std::uint32_t>(random.bits());
        if (!right(a, b) || !right(c, d))
            FAIL(a << ", " << b << " or " << c << ", " << d);
    }
    constexpr std::int32_t low = std::numeric_limits<std::int32_t>::min();
    constexpr std::uint32_t all = std::numeric_limits<std::uint32_t>::max();
    CHECK(midpoint(low, low) == low);
    CHECK(midpoint(low, std::numeric_limits<std::int32_t>::max()) == -1);
    CHECK(midpoint(all, all) == all);
    CHECK(midpoint(all, all - 1) == all - 1);
}

TEST_CASE("midpoint: vectors, component by component") {
    CHECK(midpoint(Position{1, -3, 5}, Position{2, -4, 100}) == Position{1, -4, 52});
    CHECK(midpoint(Direction{-1, 0, 8}, Direction{0, -1, 9}) == Direction{-1, -1, 8});
    CHECK(midpoint(TexCoord{7, 10}, TexCoord{8, 20}) == TexCoord{7, 15});
}

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "modules/datapath/normalise.h"
#include "testbench/common/random.h"

using namespace tessera::datapath;
using tessera::Random;

namespace {

Formats with_normals(int bits, int fraction) {
    Formats formats;
    formats.normal = Format::make_signed(bits, fraction);
    return formats;
}

/// Largest error of a component in LSB, against long double.
double error(std::int64_t x, std::int64_t y, std::int64_t z, const Direction& result, int fraction) {
    const auto a = static_cast<long double>(x), b = static_cast<long double>(y), c = static_cast<long double>(z);
    const long double scale = std::ldexp(1.0L, fraction) / std::sqrt(a * a + b * b + c * c);
    const auto off = [&](long double component, std::int32_t got) {
        return std::abs(static_cast<double>(component * scale - static_cast<long double>(got)));
    };
    return std::max({off(a, result.x), off(b, result.y), off(c, result.z)});
}

/// The bound in the header, in LSB.
double bound(int fraction) {
    return 0.5 + std::ldexp(1.0, fraction - 28);
}

void check(std::int64_t x, std::int64_t y, std::int64_t z, const Formats& formats) {
    Saturations saturations;
    const Direction result = normalise(x, y, z, formats, saturations);
    const double off = error(x, y, z, result, formats.normal.fraction);
    if (off > bound(formats.normal.fraction) || saturations.total() != 0)
        FAIL("(" << x << ", " << y << ", " << z << ") at " << formats.normal.fraction << " fraction bits gives ("
                 << result.x << ", " << result.y << ", " << result.z << "), off by " << off << " LSB, saturated "
                 << saturations.total());
}

}  // namespace

TEST_CASE("normalise: every vector of narrow formats") {
    for (const Formats& formats : {with_normals(5, 3), with_normals(6, 4), with_normals(6, 2)}) {
        const std::int64_t low = formats.normal.lowest, high = formats.normal.highest;
        for (std::int64_t x = low; x <= high; ++x)
            for (std::int64_t y = low; y <= high; ++y)
                for (std::int64_t z = low; z <= high; ++z)
                    if (x != 0 || y != 0 || z != 0)
                        check(x, y, z, formats);
    }
}

TEST_CASE("normalise: every legal normal format, vectors of up to 31 bits") {
    Random random(5);
    for (int fraction = 0; fraction <= 16; ++fraction) {
        const Formats formats = with_normals(std::max(6, fraction + 2), fraction);
        for (int k = 0; k < 60'000; ++k) {
            const std::int64_t limit = (std::int64_t{1} << random.integer(1, 31)) - 1;
            const std::int64_t x = random.any_size(limit), y = random.any_size(limit), z = random.any_size(limit);
            if (x != 0 || y != 0 || z != 0)
                check(x, y, z, formats);
        }
        constexpr std::int64_t largest = 0x7fffffff;  // 31 bits: the limit of x * x and the products
        for (const std::int64_t x : {-largest, std::int64_t{-1}, std::int64_t{0}, std::int64_t{1}, largest})
            for (const std::int64_t y : {-largest, std::int64_t{0}, std::int64_t{1}, largest})
                for (const std::int64_t z : {-largest, std::int64_t{1}, largest})
                    check(x, y, z, formats);
    }
}

TEST_CASE("normalise: the bound is tight and the result is of unit length") {
    Random random(6);
    const Formats formats = with_normals(18, 16);
    double worst = 0, worst_length = 0;
    for (int k = 0; k < 1'000'000; ++k) {
        const std::int64_t limit = 1 << 30;
        const std::int64_t x = random.integer(-limit, limit), y = random.integer(-limit, limit),
                           z = random.integer(-limit, limit);
        Saturations saturations;
        const Direction n = normalise(x, y, z, formats, saturations);
        worst = std::max(worst, error(x, y, z, n, 16));
        const double length =
            std::sqrt(static_cast<double>(n.x) * n.x + static_cast<double>(n.y) * n.y + static_cast<double>(n.z) * n.z);
        worst_length = std::max(worst_length, std::abs(length - 65536));
    }
    CHECK(worst > 0.49999);
    CHECK(worst < bound(16));
    CHECK(worst_length < std::sqrt(3.0) / 2 + 0.001);
}

TEST_CASE("normalise: unit vectors along an axis stay exact") {
    for (int fraction = 0; fraction <= 16; ++fraction) {
        const Formats formats = with_normals(fraction + 2, fraction);
        const std::int32_t one = 1 << fraction;
        Saturations saturations;
        for (const std::int64_t length : {1, 2, 3, 255, 16384, 0x7fffffff}) {
            CHECK(normalise(length, 0, 0, formats, saturations) == Direction{one, 0, 0});
            CHECK(normalise(0, -length, 0, formats, saturations) == Direction{0, -one, 0});
            CHECK(normalise(0, 0, length, formats, saturations) == Direction{0, 0, one});
        }
        CHECK(saturations.total() == 0);
    }
}

TEST_CASE("normalise: a zero vector stays zero and is counted") {
    Saturations saturations;
    CHECK(normalise(0, 0, 0, Formats{}, saturations) == Direction{});
    CHECK(normalise(Direction{}, Formats{}, saturations) == Direction{});
    CHECK(saturations.degenerate_normal == 2);
    CHECK(saturations.total() == 2);
}

TEST_CASE("normalise: a format that cannot hold 1 saturates, and is counted") {
    const Formats formats = with_normals(15, 14);
    Saturations saturations;
    CHECK(normalise(5, 0, 0, formats, saturations) == Direction{16383, 0, 0});
    CHECK(saturations.normal == 1);
    CHECK(normalise(-5, 0, 0, formats, saturations) == Direction{-16384, 0, 0});
    CHECK(saturations.total() == 1);
}

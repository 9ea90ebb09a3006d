#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "modules/datapath/normalise.h"
#include "modules/datapath/reciprocal.h"
#include "testbench/common/random.h"
#include "testbench/tests/modules/datapath/datapath_reference.h"

using namespace tessera::datapath;
using namespace tessera::testing;
using tessera::Random;

namespace {

/// Relative error of reciprocal(m), exact but for its own conversion to double.
double reciprocal_error(std::uint32_t m) {
    return static_cast<double>(static_cast<Wide>(reciprocal(m)) * m - (Wide{1} << 63)) * 0x1p-63;
}

/// Relative error of reciprocal_root(m) from its square: (1 + e)^2 - 1 = 2 e, neglecting e^2.
double root_error(std::uint32_t m) {
    const auto y = static_cast<Wide>(reciprocal_root(m));
    return static_cast<double>(y * y * m - (Wide{1} << 92)) * 0x1p-93;
}

struct Extremes {
    double lowest = 0, highest = 0;
    void take(double error) {
        lowest = std::min(lowest, error);
        highest = std::max(highest, error);
    }
};

/// Both ends of every table interval with their neighbours, then `count` samples.
template <class Visit>
void sample(std::uint32_t first, std::uint32_t interval, int count, Visit&& visit) {
    for (std::uint64_t at = first; at < std::uint64_t{1} << 32; at += interval) {
        for (std::uint32_t k = 0; k < 64; ++k) {
            visit(static_cast<std::uint32_t>(at + k));
            visit(static_cast<std::uint32_t>(at + interval - 1 - k));
        }
    }
    Random random(3);
    for (int k = 0; k < count; ++k)
        visit(random.natural(first, 0xffffffff));
}

}  // namespace

TEST_CASE("reciprocal: seeds and result within the stated errors") {
    double seed = 0;
    for (std::size_t k = 0; k < 128; ++k)
        for (const double m : {1 + static_cast<double>(k) / 128, 1 + static_cast<double>(k + 1) / 128})
            seed = std::max(seed, std::abs(std::ldexp(reciprocal_seeds[k], -16) * m - 1));
    CHECK(seed < 0x1p-8);
    CHECK(seed > 0x1p-8 * 0.99);  // the bound is tight

    Extremes errors;
    std::uint64_t smallest = ~std::uint64_t{0}, largest = 0;
    sample(0x80000000, 1 << 24, 2'000'000, [&](std::uint32_t m) {
        errors.take(reciprocal_error(m));
        smallest = std::min(smallest, reciprocal(m));
        largest = std::max(largest, reciprocal(m));
    });
    // over all 2^31 values: -4.802e-10 (m = 4294950976) to 2^-31
    CHECK(reciprocal_error(4294950976) < -4.80e-10);
    CHECK(errors.lowest > -4.802e-10);
    CHECK(errors.highest <= 0x1p-31);
    CHECK(smallest >= std::uint64_t{1} << 31);
    CHECK(largest == std::uint64_t{1} << 32);
    CHECK(reciprocal(0x80000000) == std::uint64_t{1} << 32);
    CHECK(reciprocal(0xffffffff) == std::uint64_t{1} << 31);
}

TEST_CASE("reciprocal root: seeds and result within the stated errors") {
    double seed = 0;
    for (std::size_t k = 64; k < 256; ++k) {
        CHECK(reciprocal_root_seeds[k] % (1 << 22) == 0);  // 9 fraction bits
        for (const double m : {static_cast<double>(k) / 64, static_cast<double>(k + 1) / 64})
            seed = std::max(seed, std::abs(std::ldexp(reciprocal_root_seeds[k], -31) * std::sqrt(m) - 1));
    }
    CHECK(seed < 0x1p-7 * 0.590);
    CHECK(seed > 0x1p-7 * 0.585);  // the bound is tight: 2^-7.76

    Extremes errors;
    std::uint64_t smallest = ~std::uint64_t{0}, largest = 0;
    sample(0x40000000, 1 << 24, 2'000'000, [&](std::uint32_t m) {
        errors.take(root_error(m));
        smallest = std::min(smallest, reciprocal_root(m));
        largest = std::max(largest, reciprocal_root(m));
    });
    // over all 3 * 2^30 values: -1.960e-9 (m = 1140824152) to 2.327e-9 (m = 4294138324), 2^-28.68
    CHECK(root_error(1140824152) < -1.958e-9);
    CHECK(root_error(4294138324) > 2.325e-9);
    CHECK(errors.lowest > -1.960e-9);
    CHECK(errors.highest < 2.327e-9);
    CHECK(smallest >= std::uint64_t{1} << 30);
    CHECK(largest <= std::uint64_t{1} << 31);
}

TEST_CASE("integer square root and leading zeros: small values and around every square and power") {
    for (std::uint64_t value = 0; value < 100'000; ++value) {
        const std::uint64_t root = integer_square_root(value);
        if (root * root > value || (root + 1) * (root + 1) <= value)
            FAIL("root of " << value << " gives " << root);
    }
    Random random(4);
    for (int k = 0; k < 100'000; ++k) {
        const std::uint64_t root = random.natural(1, 0xffffffff);
        if (integer_square_root(root * root) != root || integer_square_root(root * root - 1) != root - 1)
            FAIL("around the square of " << root);
    }
    for (int k = 0; k < 64; ++k) {
        CHECK(leading_zeros(std::uint64_t{1} << k) == 63 - k);
        CHECK(leading_zeros(~std::uint64_t{0} >> k) == k);
    }
}

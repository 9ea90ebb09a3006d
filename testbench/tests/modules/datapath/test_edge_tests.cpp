#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/midpoint.h"
#include "testbench/common/random.h"
#include "testbench/tests/modules/datapath/datapath_reference.h"

using namespace tessera::datapath;
using namespace tessera::testing;
using tessera::Random;

TEST_CASE("split decision: (NT or SHT or HT) and VT and TCT and GT, all 64 rows") {
    for (unsigned row = 0; row < 64; ++row) {
        const bool asked = (row & (normal_bit | summed_height_bit | highlight_bit)) != 0;
        const bool allowed = (row & view_bit) != 0 && (row & tex_coord_bit) != 0 && (row & generation_bit) != 0;
        CHECK(split_decision(static_cast<std::uint8_t>(row)) == (asked && allowed));
    }
}

TEST_CASE("absolute difference: up to 62 bits") {
    Random random(20);
    const std::int64_t limit = (std::int64_t{1} << 62) - 1;
    for (int k = 0; k < 300'000; ++k) {
        const std::int64_t a = random.any_size(limit), b = random.any_size(limit);
        const Wide difference = Wide{a} - b;
        if (absolute_difference(a, b) != static_cast<std::uint64_t>(difference < 0 ? -difference : difference))
            FAIL(a << ", " << b);
    }
}

TEST_CASE("Normal Test: compares the largest of six differences with the threshold") {
    // One component at a time, at, below and above the threshold, both signs, either end.
    TestParameters parameters;
    for (const std::uint32_t threshold : {0u, 1u, 4915u, 65534u, 65535u}) {
        parameters.normal_threshold = threshold;
        for (int place = 0; place < 6; ++place) {
            for (const std::int32_t from : {-32768, -4915, 0, 4915, 32767}) {
                for (const std::int32_t to : {-32768, -4916, -4914, -1, 0, 1, 4914, 4916, 32767}) {
                    Direction i{from, from, from}, j = i;
                    const Direction ij = i;
                    Direction& end = place < 3 ? i : j;
                    (place % 3 == 0 ? end.x : (place % 3 == 1 ? end.y : end.z)) = to;
                    if (normal_test(i, j, ij, parameters) != (std::abs(from - to) > static_cast<double>(threshold)))
                        FAIL("place " << place << ": " << from << " to " << to << ", threshold " << threshold);
                }
            }
        }
    }
    Random random(21);
    for (int k = 0; k < 500'000; ++k) {
        const auto direction = [&] {
            return Direction{random.integer32(-300, 300), random.integer32(-300, 300), random.integer32(-300, 300)};
        };
        const Direction i = direction(), j = direction(), ij = direction();
        parameters.normal_threshold = random.natural(0, 700);
        const int largest = std::max({std::abs(ij.x - i.x), std::abs(ij.y - i.y), std::abs(ij.z - i.z),
                                      std::abs(ij.x - j.x), std::abs(ij.y - j.y), std::abs(ij.z - j.z)});
        if (normal_test(i, j, ij, parameters) != (largest > static_cast<int>(parameters.normal_threshold)))
            FAIL("random");
    }
}

TEST_CASE("Summed Height Test: |S_ij / 2 - (S_i + S_j) / 4| above the threshold, every sum of 5 bits") {
    TestParameters parameters;
    for (std::uint64_t i = 0; i < 32; ++i) {
        for (std::uint64_t j = 0; j < 32; ++j) {
            for (std::uint64_t ij = 0; ij < 32; ++ij) {
                const double value =
                    std::abs(static_cast<double>(ij) / 2 - (static_cast<double>(i) + static_cast<double>(j)) / 4);
                for (std::uint64_t threshold = 0; threshold < 80; ++threshold) {
                    // the register holds four times the paper's threshold, which gives it two fraction bits
                    parameters.summed_height_unit = SummedHeightUnit::sum;
                    parameters.height_thresholds[0] = static_cast<std::int64_t>(threshold);
                    if (summed_height_test(i, j, ij, {7, 9}, parameters) !=
                        (value > static_cast<double>(threshold) / 4))
                        FAIL(i << ", " << j << ", " << ij << " against " << threshold);
                }
                for (std::uint64_t threshold = 0; threshold < 8; ++threshold) {
                    parameters.summed_height_unit = SummedHeightUnit::area;
                    parameters.height_thresholds[0] = static_cast<std::int64_t>(threshold);
                    for (const RectangleSize& size : {RectangleSize{1, 1}, RectangleSize{3, 1}, RectangleSize{2, 5}})
                        if (summed_height_test(i, j, ij, size, parameters) !=
                            (4 * value > static_cast<double>(threshold * size.width * size.height)))
                            FAIL(i << ", " << j << ", " << ij << " against " << threshold << " by area");
                }
            }
        }
    }
}

TEST_CASE("Summed Height Test: the widest sums, areas and thresholds the host can set") {
    TestParameters parameters;
    const std::uint64_t full = (std::uint64_t{1} << 48) - 1;
    parameters.height_thresholds[0] = 2 * full - 1;
    CHECK(summed_height_test(0, 0, full, {1, 1}, parameters));
    CHECK(summed_height_test(full, full, 0, {1, 1}, parameters));
    parameters.height_thresholds[0] = 2 * full;
    CHECK_FALSE(summed_height_test(0, 0, full, {1, 1}, parameters));
    CHECK_FALSE(summed_height_test(full, full, 0, {1, 1}, parameters));
    parameters.summed_height_unit = SummedHeightUnit::area;
    parameters.height_thresholds[0] = 1 << 18;
    const std::uint64_t limit = std::uint64_t{1} << 42;  // times 4096 x 4096: beyond 32 bits
    CHECK_FALSE(summed_height_test(0, 0, limit / 2, {4096, 4096}, parameters));
    CHECK(summed_height_test(1, 0, limit / 2 + 1, {4096, 4096}, parameters));
}

TEST_CASE("View Test: Manhattan length above the threshold, every pair of 5-bit positions") {
    TestParameters parameters;
    for (const std::uint32_t threshold : {0u, 1u, 7u, 31u, 61u, 62u}) {
        parameters.view_threshold = threshold;
        for (std::int32_t ix = -16; ix < 16; ++ix)
            for (std::int32_t iy = -16; iy < 16; ++iy)
                for (std::int32_t jx = -16; jx < 16; ++jx)
                    for (std::int32_t jy = -16; jy < 16; ++jy) {
                        const double length = std::fabs(ix - jx) + std::fabs(iy - jy);
                        if (view_test({ix, iy, 0, true}, {jx, jy, 99, true}, parameters) != (length > threshold))
                            FAIL(ix << ", " << iy << " to " << jx << ", " << jy << " against " << threshold);
                    }
    }
    constexpr std::int32_t low = std::numeric_limits<std::int32_t>::min(), high = 0x7fffffff;
    parameters.view_threshold = 0xffffffff;
    CHECK_FALSE(view_test({low, 0, 0, true}, {high, 0, 0, true}, parameters));
    CHECK(view_test({low, 0, 0, true}, {high, 1, 0, true}, parameters));
    CHECK(view_test({low, high, 0, true}, {high, low, 0, true}, parameters));
}

TEST_CASE("View Test: one end behind the near plane counts as long, two as invisible, for any positions") {
    TestParameters parameters;
    for (const std::uint32_t threshold : {0u, 100u, 0xffffffffu}) {
        parameters.view_threshold = threshold;
        for (const std::int32_t far : {0, 1, 100000}) {
            CHECK(view_test({0, 0, 0, true}, {far, far, 0, false}, parameters));
            CHECK(view_test({0, 0, 0, false}, {far, far, 0, true}, parameters));
            CHECK_FALSE(view_test({0, 0, 0, false}, {far, far, 0, false}, parameters));
        }
    }
}

TEST_CASE(
    "Tex Coord Test: false if the midpoint shares a texel, or a part of one, with an end, every edge of 3 + 2 bits") {
    Formats formats;
    formats.texture = Format::make_unsigned(6, 2);
    formats.tex_coord_fraction = GENERATE(0, 1, 2);
    const double size = 4 / std::pow(2, formats.tex_coord_fraction);
    const auto texel = [size](double coordinate) { return std::floor(coordinate / size); };
    for (std::uint32_t iu = 0; iu <= 32; ++iu)
        for (std::uint32_t iv = 0; iv <= 32; ++iv)
            for (std::uint32_t ju = 0; ju <= 32; ++ju)
                for (std::uint32_t jv = 0; jv <= 32; ++jv) {
                    const TexCoord i{iu, iv}, j{ju, jv};
                    const double u = std::floor((iu + ju) / 2.0), v = std::floor((iv + jv) / 2.0);
                    const bool reached = (texel(u) == texel(iu) && texel(v) == texel(iv)) ||
                                         (texel(u) == texel(ju) && texel(v) == texel(jv));
                    if (tex_coord_test(i, j, midpoint(i, j), formats) == reached)
                        FAIL(iu << ", " << iv << " to " << ju << ", " << jv);
                }
}

TEST_CASE("Generation Test: an inserted vertex is one generation above the higher end, up to the limit") {
    for (int gi = 0; gi <= 255; ++gi) {
        for (int gj = 0; gj <= 255; ++gj) {
            Vertex i, j;
            i.generation = static_cast<std::uint8_t>(gi);
            j.generation = static_cast<std::uint8_t>(gj);
            const int inserted = std::min(255, std::max(gi, gj) + 1);
            if (inserted_generation(i.generation, j.generation) != inserted)
                FAIL(gi << ", " << gj);
            for (int limit = 0; limit <= 15; ++limit) {
                TestParameters parameters;
                parameters.generation_limit = static_cast<std::uint32_t>(limit);
                if (generation_test(i.generation, j.generation, parameters) != (inserted <= limit))
                    FAIL(gi << ", " << gj << " limit " << limit);
            }
        }
    }
}

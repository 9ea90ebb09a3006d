#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "modules/datapath/edge_tests.h"
#include "testbench/common/random.h"

/// The Highlight Test: one of three normals in the highlight, and a difference above its threshold.
using namespace tessera::datapath;
using tessera::Random;

namespace {

double real(std::int32_t value) {
    return value;
}

/// The definition again, in doubles, which hold every number here exactly.
bool reference(const Direction& i, const Direction& j, const Direction& ij, const TestParameters& parameters) {
    const auto cosine = [&](const Direction& n) {
        return real(n.x) * parameters.half_vector[0] + real(n.y) * parameters.half_vector[1] +
               real(n.z) * parameters.half_vector[2];
    };
    const double nearest = std::max({cosine(i), cosine(j), cosine(ij)});
    double largest = 0;
    for (const Direction& end : {i, j})
        for (const double difference : {real(ij.x) - end.x, real(ij.y) - end.y, real(ij.z) - end.z})
            largest = std::max(largest, std::fabs(difference));
    return nearest > static_cast<double>(parameters.highlight_cosine) &&
           largest > parameters.highlight_normal_threshold;
}

TestParameters parameters_of(std::array<std::int32_t, 3> half, std::int64_t cosine, std::uint32_t threshold) {
    TestParameters parameters;
    parameters.highlight_test = true;
    parameters.half_vector = half;
    parameters.highlight_cosine = cosine;
    parameters.highlight_normal_threshold = threshold;
    return parameters;
}

std::vector<Direction> all_directions(std::int32_t least, std::int32_t most) {
    std::vector<Direction> all;
    for (std::int32_t x = least; x <= most; ++x)
        for (std::int32_t y = least; y <= most; ++y)
            for (std::int32_t z = least; z <= most; ++z)
                all.push_back({x, y, z});
    return all;
}

}  // namespace

TEST_CASE("Highlight Test: every edge of 2-bit normals follows the definition, in both directions") {
    const std::vector<Direction> all = all_directions(-2, 1);
    std::uint64_t asked = 0;
    for (const auto& parameters :
         {parameters_of({1, 1, 1}, 2, 0), parameters_of({-2, 0, 1}, 1, 1), parameters_of({0, 0, 1}, 0, 2),
          parameters_of({1, -2, 0}, 3, 0), parameters_of({0, 0, 0}, 0, 0)}) {
        for (const Direction& i : all)
            for (const Direction& j : all)
                for (const Direction& ij : all) {
                    const bool asks = highlight_test(i, j, ij, parameters);
                    asked += asks ? 1 : 0;
                    if (asks != highlight_test(j, i, ij, parameters) || asks != reference(i, j, ij, parameters))
                        FAIL(i.x << " " << i.y << " " << i.z << ", " << j.x << " " << j.y << " " << j.z << ", " << ij.x
                                 << " " << ij.y << " " << ij.z);
                }
    }
    CHECK(asked > 100'000);
}

TEST_CASE("Highlight Test: random normals of the widest formats follow the definition, in both directions") {
    Random random(51);
    std::array<int, 2> seen{};
    for (const std::int32_t limit : {31, 1 << 11, 1 << 15, 1 << 17}) {
        for (int k = 0; k < 200'000; ++k) {
            const auto direction = [&] {
                return Direction{random.integer32(-limit, limit - 1), random.integer32(-limit, limit - 1),
                                 random.integer32(-limit, limit - 1)};
            };
            const Direction i = direction(), j = direction(), ij = random.coin() ? direction() : i;
            const Direction h = direction();
            auto parameters =
                parameters_of({h.x, h.y, h.z}, 0, random.natural(0, 2 * static_cast<std::uint32_t>(limit)));
            parameters.highlight_cosine = random.any_size(std::int64_t{limit} * limit);
            const bool asks = highlight_test(i, j, ij, parameters);
            ++seen[asks ? 1 : 0];
            if (asks != highlight_test(j, i, ij, parameters) || asks != reference(i, j, ij, parameters))
                FAIL("limit " << limit << ", edge " << k);
        }
    }
    CHECK(seen[0] > 10'000);
    CHECK(seen[1] > 10'000);
}

TEST_CASE("Highlight Test: the largest possible sum, of the widest normals, is exact") {
    const std::int32_t lowest = -(1 << 17);
    const auto widest = parameters_of({lowest, lowest, lowest}, 3 * (std::int64_t{1} << 34) - 1, 0);
    CHECK(in_highlight({lowest, lowest, lowest}, widest));
    CHECK_FALSE(in_highlight({lowest, lowest, lowest + 1}, widest));
}

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "modules/datapath/displace.h"
#include "testbench/common/random.h"
#include "testbench/tests/modules/datapath/datapath_reference.h"

using namespace tessera::datapath;
using namespace tessera::testing;
using tessera::Random;

namespace {

constexpr std::int64_t greatest_int32 = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t lowest = std::numeric_limits<std::int32_t>::min();

/// One component bit for bit, with the roundings that the header names.
Wide reference(std::int64_t p, std::int64_t n, std::uint32_t code, const DisplacementParameters& by,
               const Formats& formats) {
    const Wide height = nearest(Wide{by.scale} * code, formats.displacement.bits) + by.bias;
    return Wide{p} + nearest(height * n, formats.normal.fraction);
}

void check(const Position& p, const Direction& n, std::uint32_t code, const DisplacementParameters& by,
           const Formats& formats) {
    Saturations saturations;
    const Position got = displace(p, n, code, by, formats, saturations);
    const std::array<std::int32_t, 3> base{p.x, p.y, p.z}, normal{n.x, n.y, n.z}, result{got.x, got.y, got.z};
    std::uint64_t saturated = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Wide exact = reference(base[k], normal[k], code, by, formats);
        const Wide fits = clamped(exact, formats.position.lowest, formats.position.highest);
        saturated += exact == fits ? 0 : 1;
        if (result[k] != fits)
            FAIL("base " << base[k] << ", normal " << normal[k] << ", code " << code << ", scale " << by.scale
                         << ", bias " << by.bias << " gives " << result[k]);
        // the stated bound, against the value without intermediate rounding
        const long double ideal =
            static_cast<long double>(base[k]) +
            (std::ldexp(static_cast<long double>(by.scale) * code, -formats.displacement.bits) + by.bias) *
                std::ldexp(static_cast<long double>(normal[k]), -formats.normal.fraction);
        const double bound =
            0.5 * (std::abs(std::ldexp(static_cast<double>(normal[k]), -formats.normal.fraction)) + 1) + 1e-6;
        if (exact == fits && std::abs(static_cast<double>(ideal - static_cast<long double>(result[k]))) > bound)
            FAIL("bound: base " << base[k] << ", normal " << normal[k] << ", code " << code << ", scale " << by.scale
                                << ", bias " << by.bias << " gives " << result[k]);
    }
    if (saturations.displaced_position != saturated || saturations.total() != saturated)
        FAIL("counted " << saturations.total() << " saturations of " << saturated);
}

}  // namespace

TEST_CASE("displace: equals 128-bit arithmetic, for any operands") {
    Random random(10);
    for (int k = 0; k < 1'000'000; ++k) {
        Formats formats;
        if (random.coin()) {
            const int bits = static_cast<int>(random.integer(8, 32));
            const int normal = static_cast<int>(random.integer(6, 18));
            const int codes = static_cast<int>(random.integer(1, 16));
            formats.position = Format::make_signed(bits, static_cast<int>(random.integer(0, bits - 1)));
            formats.view_distance = formats.position;
            formats.normal = Format::make_signed(normal, static_cast<int>(random.integer(0, normal - 2)));
            formats.displacement = Format::make_unsigned(codes, codes);
        }
        const auto position = [&] { return static_cast<std::int32_t>(random.any_size(formats.position.highest)); };
        const auto normal = [&] { return static_cast<std::int32_t>(random.any_size(formats.normal.highest)); };
        const auto code = static_cast<std::uint32_t>(std::abs(random.any_size(formats.displacement.highest)));
        const Position p{position(), position(), position()};
        const Direction n{normal(), normal(), normal()};
        const DisplacementParameters by{position(), position()};
        check(p, n, code, by, formats);
    }
}

TEST_CASE("displace: every register at its limits") {
    const Formats formats;
    for (const std::int64_t p : {lowest, std::int64_t{0}, greatest_int32})
        for (const std::int32_t n : {-32768, -16384, 0, 16384, 32767})
            for (const std::uint32_t code : {0u, 1u, 65535u})
                for (const std::int64_t scale : {lowest, std::int64_t{-1}, std::int64_t{1}, greatest_int32})
                    for (const std::int64_t bias : {lowest, std::int64_t{0}, greatest_int32}) {
                        const auto at = static_cast<std::int32_t>(p);
                        check({at, at, at}, {n, -n, 0}, code,
                              {static_cast<std::int32_t>(scale), static_cast<std::int32_t>(bias)}, formats);
                    }
}

TEST_CASE("displace: simple heights computed by hand") {
    const Formats formats;
    Saturations saturations;
    const Direction up{0, 0, 16384};
    const std::int32_t one = 65536;
    CHECK(displace({1, 2, 3}, up, 0, {one, 0}, formats, saturations) == Position{1, 2, 3});
    CHECK(displace({}, up, 32768, {one, 0}, formats, saturations) == Position{0, 0, one / 2});
    CHECK(displace({}, up, 32768, {-one, 0}, formats, saturations) == Position{0, 0, -one / 2});
    CHECK(displace({}, up, 32768, {one, -one}, formats, saturations) == Position{0, 0, -one / 2});
    CHECK(displace({}, {0, -16384, 0}, 32768, {one, one}, formats, saturations) == Position{0, -one - one / 2, 0});
    CHECK(saturations.total() == 0);
}

#define SC_INCLUDE_FX
#include <catch2/catch.hpp>
#include <cstdint>
#include <systemc>

#include "modules/datapath/cull.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/format.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/transform.h"
#include "testbench/common/random.h"

/// Checks rounding, saturation and widths against SystemC's own fixed-point and wide integer types.
using namespace tessera::datapath;
using tessera::Random;

/// Catch2's main runs; the SystemC library still needs this symbol.
int sc_main(int, char**) {
    return 0;
}

namespace {

/// The datapath's position format: rounds to nearest, a tie upwards (SC_RND), and saturates (SC_SAT).
using FixedPosition = sc_dt::sc_fixed<32, 16, sc_dt::SC_RND, sc_dt::SC_SAT>;
using Wide = sc_dt::sc_bigint<128>;

/// The bits of a fixed-point number with 16 fraction bits, as an integer.
template <class Fixed>
std::int64_t raw(const Fixed& value) {
    return sc_dt::sc_fixed<40, 40>(sc_dt::sc_fixed<56, 40>(value) << 16).to_int64();
}

}  // namespace

TEST_CASE("SystemC types: round_shift is SC_RND, saturate is SC_SAT") {
    Random random(34);
    const Format format = Format::make_signed(12, 4);
    for (int k = 0; k < 20'000; ++k) {
        const std::int64_t value = random.any_size((1 << 20) - 1);
        std::uint64_t saturated = 0;
        const std::int64_t got = saturate(round_shift(value, 5), format, saturated);
        sc_dt::sc_fixed<30, 21> exact;  // 9 fraction bits
        exact.range(29, 0) = sc_dt::sc_int<30>(value);
        const sc_dt::sc_fixed<12, 8, sc_dt::SC_RND, sc_dt::SC_SAT> expected(exact);
        if (sc_dt::sc_int<12>(expected.range()).to_int64() != got)
            FAIL(value << " gives " << got << " for " << expected.to_string());
    }
}

TEST_CASE("SystemC types: midpoint is a one bit wider sum and an arithmetic shift") {
    Random random(35);
    for (int k = 0; k < 20'000; ++k) {
        const auto a = static_cast<std::int32_t>(random.bits()), b = static_cast<std::int32_t>(random.bits());
        const sc_dt::sc_int<33> sum = sc_dt::sc_int<33>(a) + sc_dt::sc_int<33>(b);
        if ((sum >> 1) != midpoint(a, b))
            FAIL(a << ", " << b);
    }
}

TEST_CASE("SystemC types: displace in sc_fixed") {
    Random random(36);
    const Formats formats;
    for (int k = 0; k < 10'000; ++k) {
        const auto value = [&] { return static_cast<std::int32_t>(random.any_size(0x7fffffff)); };
        const Position p{value(), value(), value()};
        const Direction n{random.integer32(-16384, 16384), random.integer32(-16384, 16384), 16384};
        const DisplacementParameters by{value(), value()};
        const std::uint32_t code = random.natural(0, 65535);
        Saturations saturations;
        const Position got = displace(p, n, code, by, formats, saturations);

        const auto position = [](std::int32_t bits) {
            return sc_dt::sc_fixed<33, 17>(sc_dt::sc_fixed<49, 33>(bits) >> 16);
        };
        const sc_dt::sc_fixed<17, 1> d(sc_dt::sc_fixed<33, 17>(code) >> 16);
        const sc_dt::sc_fixed<50, 34, sc_dt::SC_RND> scaled(position(by.scale) * d);
        const sc_dt::sc_fixed<52, 36> height(scaled + position(by.bias));
        const auto along = [&](std::int32_t base, std::int32_t normal) {
            const sc_dt::sc_fixed<17, 3> component(sc_dt::sc_fixed<31, 17>(normal) >> 14);
            const sc_dt::sc_fixed<56, 40, sc_dt::SC_RND> product(height * component);
            return raw(FixedPosition(position(base) + product));
        };
        if (along(p.x, n.x) != got.x || along(p.y, n.y) != got.y || along(p.z, n.z) != got.z)
            FAIL("base " << p.x << " " << p.y << " " << p.z << ", code " << code << ", scale " << by.scale << ", bias "
                         << by.bias);
    }
}

TEST_CASE("SystemC types: transform's rows and culling's products in sc_bigint") {
    Random random(37);
    for (int k = 0; k < 20'000; ++k) {
        const auto value = [&] { return static_cast<std::int32_t>(random.any_size(0x7fffffff)); };
        const Position p{value(), value(), value()};
        const std::array<std::int64_t, 4> row{random.any_size(1 << 24), random.any_size(1 << 24),
                                              random.any_size(1 << 24), random.any_size(std::int64_t{1} << 61)};
        const auto wide = [](std::int64_t bits) { return Wide(static_cast<sc_dt::int64>(bits)); };
        const Wide exact =
            wide(row[0]) * wide(p.x) + wide(row[1]) * wide(p.y) + wide(row[2]) * wide(p.z) + wide(row[3]);
        if (exact != wide(transform_row(row, p)))
            FAIL("row");
        const ScreenPosition a{value(), value(), 0, true}, b{value(), value(), 0, true}, c{value(), value(), 0, true};
        const Wide area =
            (wide(b.x) - wide(a.x)) * (wide(c.y) - wide(a.y)) - (wide(b.y) - wide(a.y)) * (wide(c.x) - wide(a.x));
        if ((area <= Wide(0)) != faces_away(a, b, c))
            FAIL("area");
    }
}

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "modules/datapath/transform.h"
#include "testbench/common/random.h"
#include "testbench/tests/modules/datapath/datapath_reference.h"

using namespace tessera::datapath;
using namespace tessera::testing;

namespace {

using Row = std::array<std::int64_t, 4>;
using tessera::Random;

/// Limits of what the host sets: matrix entries of magnitude 1, an offset of 61 bits, an exponent of up to 24 (a field
/// of view of 0.1 degrees, 16384 pixels high).
constexpr std::int64_t largest_entry = std::int64_t{1} << 24;
constexpr std::int64_t largest_offset = std::int64_t{1} << 61;
constexpr int largest_exponent = 24;

Wide exact_row(const Row& row, const Position& p) {
    return Wide{row[0]} * p.x + Wide{row[1]} * p.y + Wide{row[2]} * p.z + row[3];
}

struct Worst {
    double relative = 0;  ///< largest error beyond half an LSB, over the result
    std::uint64_t in_front = 0, saturated = 0;
};

/// Checks everything that the header says about one position.
void check(const Position& p, const TransformParameters& parameters, const Formats& formats, Worst& worst) {
    Saturations saturations;
    const ScreenPosition got = transform(p, parameters, formats, saturations);
    const Wide w = exact_row(parameters.row_w, p);
    const auto fail = [&](const char* what) {
        FAIL(what << ": position " << p.x << " " << p.y << " " << p.z << ", w row " << parameters.row_w[0] << " "
                  << parameters.row_w[1] << " " << parameters.row_w[2] << " " << parameters.row_w[3] << ", x row "
                  << parameters.row_x[0] << " " << parameters.row_x[1] << " " << parameters.row_x[2] << " "
                  << parameters.row_x[3] << ", y row " << parameters.row_y[0] << " " << parameters.row_y[1] << " "
                  << parameters.row_y[2] << " " << parameters.row_y[3] << ", exponent " << parameters.exponent
                  << ", near plane " << parameters.near_plane << ", screen " << formats.screen.bits << "."
                  << formats.screen.fraction << " gives " << got.x << " " << got.y << " " << got.w);
    };
    if (got.w != clamped(nearest(w, 24), formats.view_distance.lowest, formats.view_distance.highest))
        fail("w");
    if ((saturations.view_distance != 0) != (nearest(w, 24) != got.w))
        fail("saturation of w");
    if (got.in_front != (w > parameters.near_plane))
        fail("near plane");
    if (!got.in_front) {
        if (got.x != 0 || got.y != 0 || saturations.screen_position != 0)
            fail("behind");
        return;
    }
    ++worst.in_front;
    const auto low = static_cast<double>(formats.screen.lowest), high = static_cast<double>(formats.screen.highest);
    std::uint64_t certain = 0, possible = 0;
    const auto coordinate = [&](const Row& row, std::int32_t value) {
        const long double ideal =
            std::ldexp(static_cast<long double>(exact_row(row, p)), parameters.exponent + formats.screen.fraction) /
            static_cast<long double>(w);
        const double size = std::abs(static_cast<double>(ideal));
        const double bound = 0.5 + size * 0x1p-28;
        if (ideal > high + bound || ideal < low - bound) {
            ++certain;
            ++possible;
            if (value != (ideal > 0 ? formats.screen.highest : formats.screen.lowest))
                fail("saturation");
            return;
        }
        if (ideal > high - bound || ideal < low + bound)
            ++possible;
        const double error = std::abs(static_cast<double>(ideal - static_cast<long double>(value)));
        if (error > bound + 1e-9 && !(ideal > high && error < bound + 1))
            fail("bound");
        if (size > 0)
            worst.relative = std::max(worst.relative, (error - 0.5) / size);
    };
    coordinate(parameters.row_x, got.x);
    coordinate(parameters.row_y, got.y);
    worst.saturated += saturations.screen_position;
    if (saturations.screen_position < certain || saturations.screen_position > possible ||
        saturations.total() != saturations.screen_position + saturations.view_distance)
        fail("count");
}

Row any_row(Random& random) {
    return {random.any_size(largest_entry), random.any_size(largest_entry), random.any_size(largest_entry),
            random.any_size(largest_offset)};
}

Position extreme_position(Random& random) {
    const auto one = [&] {
        return random.integer(0, 31) == 0 ? std::numeric_limits<std::int32_t>::min()
                                          : static_cast<std::int32_t>(random.any_size(0x7fffffff));
    };
    return {one(), one(), one()};
}

}  // namespace

TEST_CASE("transform: any position, any legal register") {
    Random random(11);
    Worst worst;
    for (int k = 0; k < 1'500'000; ++k) {
        Formats formats;
        if (random.coin()) {
            const int bits = static_cast<int>(random.integer(8, 32));
            formats.screen = Format::make_signed(bits, static_cast<int>(random.integer(0, bits - 1)));
            formats.position = Format::make_signed(static_cast<int>(random.integer(8, 32)), 0);
            formats.view_distance = formats.position;
        }
        TransformParameters parameters;
        parameters.row_x = any_row(random);
        parameters.row_y = any_row(random);
        parameters.row_w = any_row(random);
        parameters.exponent = static_cast<int>(random.integer(0, largest_exponent));
        if (random.integer(0, 3) == 0)
            parameters.near_plane = std::abs(random.any_size(largest_offset));
        check(extreme_position(random), parameters, formats, worst);
    }
    CHECK(worst.in_front > 500'000);
    CHECK(worst.saturated > 100'000);
    CHECK(worst.relative < 0x1p-28);
}

TEST_CASE("transform: a camera's registers, positions inside the picture and outside") {
    Random random(12);
    Worst worst;
    for (int view = 0; view < 200; ++view) {
        // Right, up and forward of a random view, with the focal length as the host scales it.
        const auto real = [&] { return static_cast<double>(random.integer(-1000, 1000)) / 1000; };
        const std::array<double, 3> a{real(), real(), real()}, b{real(), real(), real()};
        const auto scaled = [](const std::array<double, 3>& v, double length) {
            const double factor = length / std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + 1e-9);
            return std::array<double, 3>{v[0] * factor, v[1] * factor, v[2] * factor};
        };
        const std::array<double, 3> forward = scaled(a, 1);
        const std::array<double, 3> right =
            scaled({a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}, 1);
        const double focal = static_cast<double>(random.integer(200, 20000)), centre = 512;
        TransformParameters parameters;
        parameters.exponent = static_cast<int>(std::ceil(std::log2(focal + centre)));
        const double distance = std::ldexp(1.0, static_cast<int>(random.integer(16, 31)));
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = std::ldexp(focal * right[k] + centre * forward[k], 24 - parameters.exponent);
            parameters.row_x[k] = std::llround(x);
            parameters.row_y[k] = -std::llround(x);
            parameters.row_w[k] = std::llround(forward[k] * (1 << 24));
        }
        parameters.row_w[3] = std::llround(distance * (1 << 24));
        parameters.row_x[3] = std::llround(std::ldexp(centre * distance, 24 - parameters.exponent));
        parameters.row_y[3] = -parameters.row_x[3];
        parameters.near_plane = std::llround(distance / 16 * (1 << 24));
        for (int k = 0; k < 5'000; ++k) {
            const auto reach = static_cast<std::int64_t>(distance) - 1;
            check({random.integer32(-reach, reach), random.integer32(-reach, reach), random.integer32(-reach, reach)},
                  parameters, Formats{}, worst);
        }
    }
    CHECK(worst.in_front > 500'000);
}

TEST_CASE("transform: extreme registers and positions do not overflow") {
    Worst worst;
    constexpr std::int64_t low = std::numeric_limits<std::int32_t>::min(), high = 0x7fffffff;
    const std::array<std::int64_t, 3> entries{-largest_entry, 0, largest_entry};
    const std::array<std::int64_t, 5> offsets{-largest_offset, -1, 0, 1, largest_offset};
    for (int e = 0; e < 27; ++e) {
        for (int c = 0; c < 27; ++c) {
            const auto digit = [](int number, int place) {
                return static_cast<std::size_t>(place == 0 ? number % 3 : (place == 1 ? number / 3 % 3 : number / 9));
            };
            const std::array<std::int64_t, 3> corners{low, 1, high};
            const Position p{static_cast<std::int32_t>(corners[digit(c, 0)]),
                             static_cast<std::int32_t>(corners[digit(c, 1)]),
                             static_cast<std::int32_t>(corners[digit(c, 2)])};
            for (const std::int64_t offset : offsets) {
                const Row row{entries[digit(e, 0)], entries[digit(e, 1)], entries[digit(e, 2)], offset};
                if (transform_row(row, p) != exact_row(row, p))
                    FAIL("the row's sum");
                for (const std::int64_t w : offsets) {
                    for (const int exponent : {0, largest_exponent}) {
                        for (const std::int64_t near : {std::int64_t{0}, largest_offset}) {
                            TransformParameters parameters;
                            parameters.row_x = row;
                            parameters.row_y = {0, 0, 0, offset};
                            parameters.row_w = {-row[0], row[1], row[2], w};
                            parameters.exponent = exponent;
                            parameters.near_plane = near;
                            check(p, parameters, Formats{}, worst);
                            Formats wide;
                            wide.screen = Format::make_signed(32, 31);
                            check(p, parameters, wide, worst);
                        }
                    }
                }
            }
        }
    }
    CHECK(worst.in_front > 10'000);
}

TEST_CASE("transform: a vertex on the near plane is behind it, one LSB farther it is not") {
    TransformParameters parameters;
    parameters.row_w = {0, 0, 1, 0};
    parameters.row_x = {1, 0, 0, 0};
    parameters.near_plane = 1000;
    const Formats formats;
    Saturations saturations;
    CHECK_FALSE(transform({500, 0, 1000}, parameters, formats, saturations).in_front);
    CHECK(transform({500, 0, 1000}, parameters, formats, saturations).x == 0);
    CHECK(transform({500, 0, 1001}, parameters, formats, saturations).in_front);
    CHECK(transform({1001, 0, 1001}, parameters, formats, saturations).x == 256);  // one pixel
    CHECK(transform({-1001, 0, 1001}, parameters, formats, saturations).x == -256);
    CHECK_FALSE(transform({500, 0, -1001}, parameters, formats, saturations).in_front);
    parameters.near_plane = 0;
    CHECK_FALSE(transform({500, 0, 0}, parameters, formats, saturations).in_front);
    CHECK(transform({500, 0, 1}, parameters, formats, saturations).x == 500 * 256);
    CHECK(saturations.total() == 0);
}

TEST_CASE("transform: the distance w is rounded to its own format and saturates") {
    TransformParameters parameters;
    parameters.row_w = {0, 0, 1 << 23, 0};
    Saturations saturations;
    CHECK(transform({0, 0, 7}, parameters, Formats{}, saturations).w == 4);  // 3.5
    CHECK(transform({0, 0, -7}, parameters, Formats{}, saturations).w == -3);
    parameters.row_w[3] = largest_offset;
    CHECK(transform({0, 0, 0}, parameters, Formats{}, saturations).w == 0x7fffffff);
    parameters.row_w[3] = -largest_offset;
    CHECK(transform({0, 0, 0}, parameters, Formats{}, saturations).w == std::numeric_limits<std::int32_t>::min());
    CHECK(saturations.view_distance == 2);

    Formats coarse;
    coarse.view_distance = Format::make_signed(32, 14);
    parameters.row_w = {0, 0, 1 << 24, 0};
    CHECK(transform({0, 0, 40}, parameters, coarse, saturations).w == 10);
    CHECK(transform({0, 0, 42}, parameters, coarse, saturations).w == 11);  // 10.5
    CHECK(saturations.view_distance == 2);
}

TEST_CASE("transform_normal: rotates to the nearest LSB, equals 128-bit arithmetic, counts saturations") {
    Random random(13);
    for (int k = 0; k < 300'000; ++k) {
        Formats formats;
        if (random.coin()) {
            const int bits = static_cast<int>(random.integer(6, 18));
            formats.normal = Format::make_signed(bits, static_cast<int>(random.integer(0, bits - 2)));
        }
        const auto one = [&] { return static_cast<std::int32_t>(random.any_size(formats.normal.highest)); };
        TransformParameters parameters;
        for (auto& row : parameters.normal_rows)
            row = {one(), one(), one()};
        const Direction n{one(), one(), one()};
        Saturations saturations;
        const Direction got = transform_normal(n, parameters, formats, saturations);
        std::uint64_t saturated = 0;
        const auto expected = [&](const std::array<std::int32_t, 3>& row) {
            const Wide exact =
                nearest(Wide{row[0]} * n.x + Wide{row[1]} * n.y + Wide{row[2]} * n.z, formats.normal.fraction);
            const Wide fits = clamped(exact, formats.normal.lowest, formats.normal.highest);
            saturated += exact == fits ? 0 : 1;
            return static_cast<std::int32_t>(fits);
        };
        const Direction want{expected(parameters.normal_rows[0]), expected(parameters.normal_rows[1]),
                             expected(parameters.normal_rows[2])};
        if (!(got == want) || saturations.screen_normal != saturated || saturations.total() != saturated)
            FAIL("normal " << n.x << " " << n.y << " " << n.z);
    }
}

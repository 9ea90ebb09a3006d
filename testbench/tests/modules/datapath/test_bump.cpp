#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "modules/datapath/bump.h"
#include "testbench/common/random.h"

using namespace tessera::datapath;
using tessera::Random;

namespace {

using Vector = std::array<double, 3>;

Vector real(const Direction& d, int fraction) {
    return {std::ldexp(d.x, -fraction), std::ldexp(d.y, -fraction), std::ldexp(d.z, -fraction)};
}

/// N' in doubles, directly from the definition, and the length of the sum before normalisation.
Vector reference(const Vector& n, const Vector& t, int handedness, const Vector& m, double& length) {
    const Vector b{handedness * (n[1] * t[2] - n[2] * t[1]), handedness * (n[2] * t[0] - n[0] * t[2]),
                   handedness * (n[0] * t[1] - n[1] * t[0])};
    Vector sum{};
    for (std::size_t k = 0; k < 3; ++k)
        sum[k] = m[0] * t[k] + m[1] * b[k] + m[2] * n[k];
    length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (double& component : sum)
        component /= length;
    return sum;
}

/// Largest error of a component, in LSB.
double off(const Direction& got, const Vector& expected, int fraction) {
    const double one = std::ldexp(1.0, fraction);
    return std::max({std::abs(got.x - expected[0] * one), std::abs(got.y - expected[1] * one),
                     std::abs(got.z - expected[2] * one)});
}

Direction unit(Random& random, const Formats& formats) {
    Saturations unused;
    for (;;) {
        const std::int64_t x = random.integer(-1000000, 1000000), y = random.integer(-1000000, 1000000),
                           z = random.integer(-1000000, 1000000);
        const std::int64_t square = x * x + y * y + z * z;
        if (square > 10'000'000'000 && square < 1'000'000'000'000)
            return normalise(x, y, z, formats, unused);
    }
}

Formats with_normals(int bits, int fraction) {
    Formats formats;
    formats.normal = Format::make_signed(bits, fraction);
    return formats;
}

}  // namespace

TEST_CASE("bump: the normal of a flat map gives N") {
    Random random(7);
    for (int fraction = 0; fraction <= 16; ++fraction) {
        const Formats formats = with_normals(std::max(6, fraction + 2), fraction);
        const Direction flat{0, 0, 1 << fraction};
        Saturations saturations;
        std::int32_t worst = 0;
        for (int k = 0; k < 20'000; ++k) {
            const Direction n = unit(random, formats), t = unit(random, formats);
            const Direction bumped = bump(n, t, random.coin() ? 1 : -1, flat, formats, saturations);
            worst = std::max({worst, std::abs(bumped.x - n.x), std::abs(bumped.y - n.y), std::abs(bumped.z - n.z)});
        }
        // N is rounded, so normalising it again may move it by its error of length, sqrt(3)/2 LSB
        CHECK(worst <= 1);
        CHECK(saturations.total() == 0);
    }
}

TEST_CASE("bump: agrees with doubles, every legal normal format") {
    Random random(8);
    for (int fraction = 0; fraction <= 16; ++fraction) {
        const Formats formats = with_normals(std::max(6, fraction + 2), fraction);
        Saturations saturations;
        for (int k = 0; k < 60'000; ++k) {
            const Direction n = unit(random, formats), t = unit(random, formats), m = unit(random, formats);
            const int handedness = random.coin() ? 1 : -1;
            double length = 0;
            const Vector expected =
                reference(real(n, fraction), real(t, fraction), handedness, real(m, fraction), length);
            // Rounding of B: half an LSB times a factor of the map's normal, per component; of the sum: an eighth (two
            // guard bits). Both are divided by the sum's length, and the error of that length adds as much again along
            // the vector; then the result is rounded.
            const double one = std::ldexp(1.0, fraction);
            const double before = std::abs(m.y / one) * 0.5 + 0.125;
            if (length * one < 4 * before)
                continue;  // N and T are nearly parallel and cancel: no meaningful direction
            const double bound = 0.5 + 2.8 * before / length + 0.01;
            const double error = off(bump(n, t, handedness, m, formats, saturations), expected, fraction);
            if (error > bound)
                FAIL("fraction " << fraction << ": off by " << error << " LSB, bound " << bound << ", length " << length
                                 << "; N " << n.x << " " << n.y << " " << n.z << ", T " << t.x << " " << t.y << " "
                                 << t.z << ", N_d " << m.x << " " << m.y << " " << m.z);
        }
        CHECK(saturations.normal == 0);
    }
}

TEST_CASE("bump: the error of an orthogonal frame is within 1.5 LSB in the default format") {
    Random random(9);
    const Formats formats;
    double worst = 0;
    Saturations saturations;
    for (int k = 0; k < 300'000; ++k) {
        const Direction n = unit(random, formats), a = unit(random, formats), m = unit(random, formats);
        const double dot = (double{1} * n.x * a.x + double{1} * n.y * a.y + double{1} * n.z * a.z) / (1 << 28);
        if (std::abs(dot) > 0.9)
            continue;
        const auto across = [&](std::int32_t from, std::int32_t along) {
            return static_cast<std::int64_t>(std::lround(1e4 * (from - dot * along)));
        };
        const Direction t = normalise(across(a.x, n.x), across(a.y, n.y), across(a.z, n.z), formats, saturations);
        double length = 0;
        const Vector expected = reference(real(n, 14), real(t, 14), 1, real(m, 14), length);
        worst = std::max(worst, off(bump(n, t, 1, m, formats, saturations), expected, 14));
    }
    CHECK(worst < 1.5);
    CHECK(worst > 0.7);
    CHECK(saturations.total() == 0);
}

TEST_CASE("bump: the frame is T, handedness * (N x T), N") {
    const Formats formats;
    Saturations saturations;
    const Direction z{0, 0, 16384}, x{16384, 0, 0};
    const Direction along_u{9830, 0, 13107}, along_v{0, 9830, 13107};  // (0.6, 0, 0.8), (0, 0.6, 0.8)
    CHECK(bump(z, x, 1, along_u, formats, saturations) == Direction{9830, 0, 13107});
    CHECK(bump(z, x, -1, along_u, formats, saturations) == Direction{9830, 0, 13107});
    CHECK(bump(z, x, 1, along_v, formats, saturations) == Direction{0, 9830, 13107});
    CHECK(bump(z, x, -1, along_v, formats, saturations) == Direction{0, -9830, 13107});
    CHECK(bump(x, z, 1, along_v, formats, saturations) == Direction{13107, -9830, 0});
}

TEST_CASE("bump: saturated and zero normals are counted") {
    Saturations saturations;
    bump({0, 0, 16383}, {16383, 0, 0}, 1, {0, 0, 16383}, with_normals(15, 14), saturations);
    CHECK(saturations.normal == 1);
    CHECK(bump({}, {}, 1, {0, 0, 16384}, Formats{}, saturations) == Direction{});
    CHECK(saturations.degenerate_normal == 1);
    CHECK(saturations.total() == 2);
}

TEST_CASE("handedness of an inserted vertex: 1 if both ends have 1, else -1") {
    for (const std::int8_t a : {std::int8_t{-1}, std::int8_t{1}}) {
        for (const std::int8_t b : {std::int8_t{-1}, std::int8_t{1}}) {
            Vertex i, j;
            i.handedness = a;
            j.handedness = b;
            CHECK(int{inserted_handedness(i.handedness, j.handedness)} == (a == 1 && b == 1 ? 1 : -1));
        }
    }
}

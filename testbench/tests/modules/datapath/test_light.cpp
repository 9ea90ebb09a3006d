#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "modules/datapath/light.h"
#include "testbench/common/random.h"

using namespace tessera::datapath;
using tessera::Random;

TEST_CASE("light: agrees with doubles, 0..255, any operands, every legal normal format") {
    Random random(23);
    Saturations saturations;
    std::uint64_t saturated = 0;
    for (int k = 0; k < 1'000'000; ++k) {
        Formats formats;
        const int fraction = static_cast<int>(random.integer(0, 16));
        formats.normal = Format::make_signed(std::max(6, fraction + 2), fraction);
        const auto one = [&] { return static_cast<std::int32_t>(random.any_size(formats.normal.highest)); };
        LightParameters parameters;
        parameters.direction = {one(), one(), one()};
        parameters.ambient = random.integer32(0, 256);
        const Direction n{one(), one(), one()};
        const double dot =
            std::ldexp(double{1} * n.x * parameters.direction[0] + double{1} * n.y * parameters.direction[1] +
                           double{1} * n.z * parameters.direction[2],
                       -2 * fraction);
        const double ideal = parameters.ambient + (256 - parameters.ambient) * std::max(0.0, dot);
        // truncated twice: the cosine by an LSB of the normal's format, then the intensity
        const double low = ideal - 1 - (256 - parameters.ambient) * std::ldexp(1.0, -fraction);
        const int got = light(n, parameters, formats, saturations);
        // beyond 8 bits, with the integers themselves: two shifts that round down
        const std::int64_t sum = std::int64_t{n.x} * parameters.direction[0] +
                                 std::int64_t{n.y} * parameters.direction[1] +
                                 std::int64_t{n.z} * parameters.direction[2];
        const auto one_lsb = std::int64_t{1} << fraction;
        const std::int64_t cosine = std::max<std::int64_t>(0, sum) / one_lsb;
        saturated += parameters.ambient + (256 - parameters.ambient) * cosine / one_lsb > 255 ? 1 : 0;
        if (got > std::min(255.0, ideal) + 1e-9 || got < std::min(255.0, low) - 1e-9 ||
            got < std::min(255, parameters.ambient))
            FAIL("normal " << n.x << " " << n.y << " " << n.z << " gives " << got << " for " << ideal);
    }
    CHECK(saturated > 1000);
    CHECK(saturations.intensity == saturated);
}

TEST_CASE("light: face on, edge on, from behind, ambient alone") {
    const Formats formats;
    Saturations saturations;
    const Direction towards{0, 0, 16384}, away{0, 0, -16384}, across{16384, 0, 0}, sixty{14189, 0, 8192};
    const LightParameters lamp{{0, 0, 16384}, 51};
    CHECK(int{light(towards, lamp, formats, saturations)} == 255);
    CHECK(saturations.intensity == 1);
    CHECK(int{light(sixty, lamp, formats, saturations)} == 51 + 102);
    CHECK(int{light(across, lamp, formats, saturations)} == 51);
    CHECK(int{light(away, lamp, formats, saturations)} == 51);
    CHECK(int{light(away, {{0, 0, 16384}, 0}, formats, saturations)} == 0);
    CHECK(int{light(sixty, {{0, 0, 16384}, 0}, formats, saturations)} == 128);
    CHECK(int{light(away, {{0, 0, 16384}, 256}, formats, saturations)} == 255);
    CHECK(int{light({32767, 32767, 32767}, {{32767, 32767, 32767}, 0}, formats, saturations)} == 255);
    CHECK(saturations.intensity == 3);
    CHECK(saturations.total() == 3);
}

#include "testbench/render/palette.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr double last_generation = 12;

constexpr Colour generation_scale[] = {{255, 244, 204}, {218, 236, 176}, {160, 215, 176}, {92, 189, 190},
                                       {44, 150, 192},  {38, 104, 174},  {44, 60, 140},   {36, 26, 88}};

}  // namespace

Colour generation_colour(unsigned generation) {
    constexpr int steps = static_cast<int>(std::size(generation_scale)) - 1;
    const double at = std::min(generation / last_generation, 1.0) * steps;
    const int i = std::min(static_cast<int>(at), steps - 1);
    Colour result{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double low = generation_scale[i][k];
        const double high = generation_scale[i + 1][k];
        result[k] = static_cast<std::uint8_t>(std::lround(low + (high - low) * (at - i)));
    }
    return result;
}

Colour deciding_test_colour(DecidingTest test) {
    switch (test) {
        case DecidingTest::normal:
            return {230, 159, 0};
        case DecidingTest::summed_height:
            return {86, 180, 233};
        case DecidingTest::both:
            return {0, 158, 115};
        case DecidingTest::base:
            break;
    }
    return {214, 214, 210};
}

glm::dvec3 to_linear(const Colour& colour) {
    const auto linear = [](std::uint8_t code) {
        const double value = code / 255.0;
        return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    };
    return {linear(colour[0]), linear(colour[1]), linear(colour[2])};
}

Colour to_srgb(const glm::dvec3& linear) {
    const auto code = [](double value) {
        const double x = std::clamp(value, 0.0, 1.0);
        const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
        return static_cast<std::uint8_t>(std::lround(255 * encoded));
    };
    return {code(linear.x), code(linear.y), code(linear.z)};
}

}  // namespace tessera

#include "testbench/render/palette.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tessera {
namespace {

constexpr Colour generation_scale[] = {{255, 244, 204}, {218, 236, 176}, {160, 215, 176}, {92, 189, 190},
                                       {44, 150, 192},  {38, 104, 174},  {44, 60, 140},   {36, 26, 88}};

constexpr Colour error_scale[] = {{255, 255, 214}, {255, 237, 160}, {254, 217, 118}, {254, 178, 76}, {253, 141, 60},
                                  {252, 78, 42},   {227, 26, 28},   {189, 0, 38},    {112, 0, 34}};

/// Interpolates between the colours of a scale; `fraction` from 0 to 1.
template <class Scale>
Colour between(const Scale& scale, double fraction) {
    const std::size_t count = std::size(scale);
    const double at = fraction * static_cast<double>(count - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), count - 2);
    Colour result{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double low = scale[i][k];
        const double high = scale[i + 1][k];
        result[k] = static_cast<std::uint8_t>(std::lround(low + (high - low) * (at - static_cast<double>(i))));
    }
    return result;
}

}  // namespace

Colour generation_colour(unsigned generation) {
    return between(generation_scale, std::min(static_cast<double>(generation) / last_generation, 1.0));
}

Colour error_colour(double fraction) {
    return between(error_scale, std::clamp(fraction, 0.0, 1.0));
}

Colour deciding_test_colour(DecidingTest test) {
    constexpr Colour colours[] = {{214, 214, 210}, {230, 159, 0}, {86, 180, 233}, {0, 158, 115}, {204, 121, 167}};
    static_assert(std::size(colours) == deciding_tests);
    return colours[static_cast<std::size_t>(test)];
}

Stop stop_of(std::uint8_t stopped_by) {
    switch (stopped_by) {
        case 0: return Stop::none;
        case datapath::view_bit: return Stop::view;
        case datapath::tex_coord_bit: return Stop::tex_coord;
        case datapath::generation_bit: return Stop::generation;
        default: return Stop::several;
    }
}

Colour stop_colour(Stop stop) {
    constexpr Colour colours[] = {{214, 214, 210}, {86, 180, 233}, {230, 159, 0}, {213, 94, 0}, {204, 121, 167}};
    static_assert(std::size(colours) == stops);
    return colours[static_cast<std::size_t>(stop)];
}

glm::dvec3 to_linear(const Colour& colour) {
    const auto linear = [](std::uint8_t code) {
        const double value = code / 255.0;
        return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    };
    return {linear(colour[0]), linear(colour[1]), linear(colour[2])};
}

Colour to_srgb(const glm::vec3& linear) {
    const auto code = [](double value) {
        const double x = std::clamp(value, 0.0, 1.0);
        const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
        return static_cast<std::uint8_t>(std::lround(255 * encoded));
    };
    return {code(linear.x), code(linear.y), code(linear.z)};
}

}  // namespace tessera

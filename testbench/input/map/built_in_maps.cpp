#include "testbench/input/map/built_in_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "testbench/common/error.h"
#include "testbench/common/random.h"
#include "testbench/input/map/map_file.h"
#include "testbench/input/map/stroke_font.h"

namespace tessera {
namespace {

void check_sides(std::int64_t width, std::int64_t height) {
    check_map_sides("the built-in map (map.width, map.height)", width, height);
}

// Calls value(x, y) for every texel.
template <class Value>
HeightMap map_of(std::int64_t width, std::int64_t height, Value&& value) {
    check_sides(width, height);
    HeightMap map;
    map.width = static_cast<int>(width);
    map.height = static_cast<int>(height);
    map.values.resize(static_cast<std::size_t>(width * height));
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            map.at(x, y) = static_cast<float>(value(x, y));
    return map;
}

// Flat on top, with a smooth step to 0 at outer_radius, which must be below 1, half the gap between two letters.
double stroke_profile(double distance) {
    constexpr double inner_radius = 0.35;
    constexpr double outer_radius = 0.85;
    const double t = std::clamp((outer_radius - distance) / (outer_radius - inner_radius), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

HeightMap half_donut_map(std::int64_t width, std::int64_t height) {
    constexpr double major = 0.55;
    constexpr double minor = 0.25;
    return map_of(width, height, [&](int column, int row) {
        const double x = (2 * column + 1) / static_cast<double>(width) - 1;
        const double y = (2 * row + 1) / static_cast<double>(height) - 1;
        const double across = std::sqrt(x * x + y * y) - major;
        return std::sqrt(std::max(0.0, minor * minor - across * across)) / minor;
    });
}

HeightMap text_map(std::int64_t width, std::int64_t height, std::string_view text) {
    check_sides(width, height);
    const StrokeText letters(text);
    if (letters.blank())
        throw InputError("map.text: the text is empty, so the map would be flat. Give it at least one letter.");
    // A margin of one gap around the text keeps the strokes' edges inside the map.
    constexpr int margin = StrokeText::glyph_advance - StrokeText::glyph_width;
    constexpr int letter_height = StrokeText::glyph_height;
    const double units_per_texel = std::max((letters.width() + 2 * margin) / static_cast<double>(width),
                                            (letter_height + 2.0 * margin) / static_cast<double>(height));
    if (units_per_texel * 7 > letter_height) {
        throw InputError(
            fmt::format("map.text: the letters of \"{}\" would be {:.1f} texels high on a map of {} x {}; they need "
                        "7. Shorten the text or enlarge the map.",
                        printable_ascii(text), letter_height / units_per_texel, width, height));
    }
    return map_of(width, height, [&](int column, int row) {
        const double x = (column + 0.5 - 0.5 * static_cast<double>(width)) * units_per_texel + 0.5 * letters.width();
        const double y = (row + 0.5 - 0.5 * static_cast<double>(height)) * units_per_texel + 0.5 * letter_height;
        return stroke_profile(std::sqrt(letters.squared_distance(x, y)));
    });
}

HeightMap noise_map(std::int64_t width, std::int64_t height, std::int64_t seed) {
    const std::uint64_t key = Random(static_cast<std::uint64_t>(seed)).bits();
    return map_of(width, height, [key](int x, int y) {
        const std::uint64_t place = static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint64_t>(x);
        return static_cast<double>(Random(key ^ place).bits() >> 48) / 65535.0;
    });
}

HeightMap constant_map(std::int64_t width, std::int64_t height, double value) {
    if (!(value >= 0 && value <= 1))
        throw InputError(fmt::format("map.value: the constant map's value is {}; it must be 0 to 1.", value));
    return map_of(width, height, [value](int, int) { return value; });
}

HeightMap ramp_map(std::int64_t width, std::int64_t height) {
    return map_of(width, height, [width](int x, int) { return (x + 0.5) / static_cast<double>(width); });
}

}  // namespace tessera

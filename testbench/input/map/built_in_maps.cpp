#include "testbench/input/map/built_in_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "testbench/common/error.h"
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
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            map.at(x, y) = static_cast<float>(value(x, y));
        }
    }
    return map;
}

// The finaliser of splitmix64 (Vigna, public domain).
std::uint64_t mix(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
}

double squared_distance(const Stroke& stroke, double x, double y) {
    const double dx = stroke.x1 - stroke.x0;
    const double dy = stroke.y1 - stroke.y0;
    const double length = dx * dx + dy * dy;
    const double along = (x - stroke.x0) * dx + (y - stroke.y0) * dy;
    const double t = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
    const double ex = x - (stroke.x0 + t * dx);
    const double ey = y - (stroke.y0 + t * dy);
    return ex * ex + ey * ey;
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
    std::vector<std::vector<Stroke>> letters;
    bool blank = true;
    for (const char character : text) {
        letters.push_back(stroke_glyph(character));
        blank = blank && letters.back().empty();
    }
    if (blank) {
        throw InputError(
            "map.text: the text is empty, so the map would be flat. Give it at least one letter.");
    }
    // A margin of one gap around the text keeps the strokes' edges inside the map.
    constexpr int margin = glyph_advance - glyph_width;
    const double text_width = static_cast<double>(letters.size()) * glyph_advance - margin;
    const double units_per_texel = std::max((text_width + 2 * margin) / static_cast<double>(width),
                                            (glyph_height + 2.0 * margin) / static_cast<double>(height));
    if (units_per_texel * 7 > glyph_height) {
        throw InputError(fmt::format(
            "map.text: the letters of \"{}\" would be {:.1f} texels high on a map of {} x {}; they need "
            "7. Shorten the text or enlarge the map.",
            printable_ascii(text), glyph_height / units_per_texel, width, height));
    }
    return map_of(width, height, [&](int column, int row) {
        const double x =
            (column + 0.5 - 0.5 * static_cast<double>(width)) * units_per_texel + 0.5 * text_width;
        const double y =
            (row + 0.5 - 0.5 * static_cast<double>(height)) * units_per_texel + 0.5 * glyph_height;
        const double cell = std::floor((x + 0.5 * margin) / glyph_advance);
        if (cell < 0 || cell >= static_cast<double>(letters.size())) {
            return 0.0;
        }
        double nearest = 1;
        for (const Stroke& stroke : letters[static_cast<std::size_t>(cell)]) {
            nearest = std::min(nearest, squared_distance(stroke, x - cell * glyph_advance, y));
        }
        return stroke_profile(std::sqrt(nearest));
    });
}

HeightMap noise_map(std::int64_t width, std::int64_t height, std::int64_t seed) {
    const std::uint64_t key = mix(static_cast<std::uint64_t>(seed));
    return map_of(width, height, [key](int x, int y) {
        const std::uint64_t place = static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint64_t>(x);
        return static_cast<double>(mix(key ^ place) >> 48) / 65535.0;
    });
}

HeightMap constant_map(std::int64_t width, std::int64_t height, double value) {
    if (!(value >= 0 && value <= 1)) {
        throw InputError(fmt::format("map.value: the constant map's value is {}; it must be 0 to 1.", value));
    }
    return map_of(width, height, [value](int, int) { return value; });
}

HeightMap ramp_map(std::int64_t width, std::int64_t height) {
    return map_of(width, height, [width](int x, int) { return (x + 0.5) / static_cast<double>(width); });
}

}  // namespace tessera

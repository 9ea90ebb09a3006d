#include "testbench/prove/random_machines/random_map.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <functional>

namespace tessera {

namespace {

int any_side(Random& random) {
    switch (random.integer(0, 4)) {
        case 0: return 1;
        case 1: return random.integer32(2, 9);
        case 2: return 1 << random.integer(1, 6);
        case 3: return 2 * random.integer32(5, 40) + 1;
        default: return random.integer32(10, 96);
    }
}

/// One of the patterns with random parameters, as a function of column and row.
std::function<std::int64_t(int, int)> any_pattern(Random& random, const RandomMap& map) {
    const std::int64_t highest = map.highest;
    const auto any_sample = [&random, highest] { return random.integer(0, highest); };
    switch (random.integer(0, 7)) {
        case 0: return [any_sample](int, int) { return any_sample(); };
        case 1:  // extremes
            return [&random, highest](int, int) { return random.coin() ? highest : 0; };
        case 2: {  // steps: blocks of one height each
            const int across = random.integer32(1, 16), up = random.integer32(1, 16);
            const auto salt = random.bits();
            return [=](int x, int y) {
                Random block(salt ^ static_cast<std::uint64_t>(x / across * 4096 + y / up));
                return block.integer(0, 3) * highest / 3;
            };
        }
        case 3: {  // a few spikes on a plain
            const std::int64_t plain = any_sample();
            return [=, &random](int, int) { return random.chance(2) ? highest - plain : plain; };
        }
        case 4: {  // a ramp along either axis, up or down
            const bool along = random.coin(), down = random.coin();
            return [=](int x, int y) {
                const int at = along ? x : y, last = (along ? map.width : map.height) - 1;
                const std::int64_t value = last == 0 ? highest / 2 : highest * at / last;
                return down ? highest - value : value;
            };
        }
        case 5: {  // waves, of triangles
            const int length = random.integer32(2, 40);
            return [=](int x, int y) {
                const int phase = (x + 2 * y) % (2 * length);
                return highest * std::abs(phase - length) / length;
            };
        }
        case 6: {  // single-texel checkerboard
            const std::int64_t low = any_sample(), high = any_sample();
            return [=](int x, int y) { return (x + y) % 2 == 0 ? low : high; };
        }
        default: {
            const std::int64_t all = any_sample();
            return [=](int, int) { return all; };
        }
    }
}

}  // namespace

HeightMap RandomMap::height_map() const {
    HeightMap map;
    map.width = width;
    map.height = height;
    map.source_units = highest;
    map.values.resize(samples.size());
    for (int row = 0; row < height; ++row)
        for (int x = 0; x < width; ++x)
            map.at(x, height - 1 - row) =
                static_cast<float>(static_cast<double>(samples[static_cast<std::size_t>(row * width + x)]) / highest);
    return map;
}

std::string RandomMap::pgm() const {
    std::string text = fmt::format("P5\n{} {}\n{}\n", width, height, highest);
    for (const std::uint16_t sample : samples) {
        if (highest > 255)
            text += static_cast<char>(sample >> 8);
        text += static_cast<char>(sample & 255);
    }
    return text;
}

RandomMap make_random_map(Random& random) {
    RandomMap map;
    map.width = any_side(random);
    map.height = any_side(random);
    map.highest = random.chance(70) ? 65535 : random.one_of({1, 100, 255, 256, 4095});
    const auto pattern = any_pattern(random, map);
    for (int row = 0; row < map.height; ++row)
        for (int x = 0; x < map.width; ++x)
            map.samples.push_back(
                static_cast<std::uint16_t>(std::clamp<std::int64_t>(pattern(x, row), 0, map.highest)));
    return map;
}

}  // namespace tessera

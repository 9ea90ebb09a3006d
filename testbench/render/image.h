#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera {

/// An sRGB colour as stored.
using Colour = std::array<std::uint8_t, 3>;

/// 8-bit sRGB, three bytes per pixel, rows from the top.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> bytes;

    Image() = default;
    Image(int columns, int rows, const Colour& colour) : width(columns), height(rows) {
        bytes.reserve(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
        for (std::size_t n = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); n > 0; --n)
            bytes.insert(bytes.end(), colour.begin(), colour.end());
    }

    std::size_t offset(int x, int y) const {
        return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    }
    Colour at(int x, int y) const {
        const std::size_t i = offset(x, y);
        return {bytes[i], bytes[i + 1], bytes[i + 2]};
    }
    void set(int x, int y, const Colour& colour) {
        const std::size_t i = offset(x, y);
        bytes[i] = colour[0];
        bytes[i + 1] = colour[1];
        bytes[i + 2] = colour[2];
    }
};

}  // namespace tessera

#pragma once
#include <cstddef>
#include <vector>

namespace tessera {

/// Linear light, three floats a pixel (red, green, blue with sRGB's primaries; 1 is the PNG's white and may be
/// exceeded), rows from the top.
struct LinearImage {
    int width = 0;
    int height = 0;
    std::vector<float> values;

    std::size_t offset(int x, int y) const {
        return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    }
};

}  // namespace tessera

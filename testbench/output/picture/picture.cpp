#include "testbench/output/picture/picture.h"

#include <algorithm>
#include <utility>

#include "testbench/output/picture/palette.h"

namespace tessera {

Picture to_picture(Image image, bool linear) {
    Picture result;
    result.image = std::move(image);
    if (!linear)
        return result;
    const std::vector<std::uint8_t>& bytes = result.image.bytes;
    result.linear = {result.image.width, result.image.height, {}};
    result.linear.values.reserve(bytes.size());
    Colour last{};
    glm::dvec3 light = to_linear(last);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const Colour colour{bytes[i], bytes[i + 1], bytes[i + 2]};
        if (colour != last)
            light = to_linear(colour);
        last = colour;
        for (int k = 0; k < 3; ++k)
            result.linear.values.push_back(static_cast<float>(light[k]));
    }
    return result;
}

void paste(const Picture& from, int left, int top, Picture& to) {
    const int columns = std::min(from.image.width, to.image.width - left);
    const int rows = std::min(from.image.height, to.image.height - top);
    if (columns <= 0)
        return;
    to.mesh_in_sight = to.mesh_in_sight || from.mesh_in_sight;
    const std::size_t row_length = 3 * static_cast<std::size_t>(columns);
    for (int y = 0; y < rows; ++y) {
        std::copy_n(&from.image.bytes[from.image.offset(0, y)], row_length,
                    &to.image.bytes[to.image.offset(left, top + y)]);
        if (!to.linear.values.empty())
            std::copy_n(&from.linear.values[from.linear.offset(0, y)], row_length,
                        &to.linear.values[to.linear.offset(left, top + y)]);
    }
}

}  // namespace tessera

#include "testbench/output/picture/picture.h"

#include <algorithm>

#include "testbench/output/picture/palette.h"

namespace tessera {
namespace {

void set(LinearImage& image, int x, int y, const glm::dvec3& light) {
    float* const pixel = &image.values[image.offset(x, y)];
    for (int k = 0; k < 3; ++k)
        pixel[k] = static_cast<float>(light[k]);
}

}  // namespace

Picture plain_picture(int width, int height, const Colour& colour, bool linear) {
    Picture result;
    result.image = Image(width, height, colour);
    if (!linear)
        return result;
    result.linear = {width, height, {}};
    result.linear.values.resize(result.image.bytes.size());
    const glm::dvec3 light = to_linear(colour);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            set(result.linear, x, y, light);
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

void take_over_annotations(Picture& picture) {
    if (picture.linear.values.empty())
        return;
    for (int y = 0; y < picture.image.height; ++y)
        for (int x = 0; x < picture.image.width; ++x) {
            const float* const pixel = &picture.linear.values[picture.linear.offset(x, y)];
            const Colour colour = picture.image.at(x, y);
            if (to_srgb({pixel[0], pixel[1], pixel[2]}) != colour)
                set(picture.linear, x, y, to_linear(colour));
        }
}

}  // namespace tessera

#include "testbench/input/map/png_encoder.h"

#include <png.h>

#include <stdexcept>

namespace tessera {

std::string encode_png_samples(int width, int height, std::uint32_t format, const void* samples, std::uint32_t flags) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(width);
    header.height = static_cast<png_uint_32>(height);
    header.format = format;
    header.flags = flags;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string file(size, '\0');
    if (!png_image_write_to_memory(&header, file.data(), &size, 0, samples, 0, nullptr))
        throw std::runtime_error(std::string("PNG: ") + header.message);
    file.resize(size);
    return file;
}

}  // namespace tessera

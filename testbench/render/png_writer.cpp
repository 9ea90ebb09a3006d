#include "testbench/render/png_writer.h"

#include <png.h>

#include <stdexcept>
#include <string>

namespace tessera {

std::vector<std::uint8_t> encode_png(const Image& image) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::vector<std::uint8_t> file(size);
    if (!png_image_write_to_memory(&header, file.data(), &size, 0, image.bytes.data(), 0, nullptr))
        throw std::runtime_error(std::string("PNG: ") + header.message);
    file.resize(size);
    return file;
}

}  // namespace tessera

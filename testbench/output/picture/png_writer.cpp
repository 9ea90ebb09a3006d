#include "testbench/output/picture/png_writer.h"

#include <png.h>

#include "testbench/input/map/png_encoder.h"

namespace tessera {

std::string encode_png(const Image& image) {
    return encode_png_samples(image.width, image.height, PNG_FORMAT_RGB, image.bytes.data());
}

}  // namespace tessera

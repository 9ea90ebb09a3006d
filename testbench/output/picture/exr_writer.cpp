#include "testbench/output/picture/exr_writer.h"

#include <ImfStandardAttributes.h>

#include <vector>

#include "testbench/input/map/exr_encoder.h"

namespace tessera {

std::string encode_exr(const LinearImage& image, ExrSamples samples) {
    // The default chromaticities are those of ITU-R BT.709, the same as sRGB's.
    Imf::Header header(image.width, image.height, 1, Imath::V2f(0, 0), 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    Imf::addChromaticities(header, Imf::Chromaticities());
    const std::vector<const char*> channels{"R", "G", "B"};
    if (samples == ExrSamples::single)
        return encode_exr_samples(header, channels, Imf::FLOAT, image.values.data());
    const std::vector<half> halves(image.values.begin(), image.values.end());
    return encode_exr_samples(header, channels, Imf::HALF, halves.data());
}

}  // namespace tessera

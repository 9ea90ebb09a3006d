#include "testbench/render/exr_writer.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfThreading.h>

#include <vector>

namespace tessera {
namespace {

constexpr const char* channels[] = {"R", "G", "B"};

template <typename Sample>
std::string encode(const LinearImage& image, const std::vector<Sample>& samples, Imf::PixelType type) {
    // Chromaticities' defaults are those of ITU-R BT.709, which are sRGB's.
    Imf::Header header(image.width, image.height, 1, Imath::V2f(0, 0), 1, Imf::INCREASING_Y,
                       Imf::ZIP_COMPRESSION);
    Imf::addChromaticities(header, Imf::Chromaticities());
    Imf::FrameBuffer frame;
    for (std::size_t k = 0; k < 3; ++k) {
        header.channels().insert(channels[k], Imf::Channel(type));
        // Written from, never to.
        auto* const first = const_cast<Sample*>(samples.data() + k);
        frame.insert(channels[k],
                     Imf::Slice::Make(type, first, header.dataWindow(), 3 * sizeof(Sample),
                                      3 * sizeof(Sample) * static_cast<std::size_t>(image.width)));
    }
    Imf::setGlobalThreadCount(0);
    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, header, 0);
        file.setFrameBuffer(frame);
        file.writePixels(image.height);
    }  // which completes the file
    return stream.str();
}

}  // namespace

std::string encode_exr(const LinearImage& image, ExrSamples samples) {
    if (samples == ExrSamples::single)
        return encode(image, image.values, Imf::FLOAT);
    return encode(image, std::vector<half>(image.values.begin(), image.values.end()), Imf::HALF);
}

}  // namespace tessera

#include "testbench/input/map/encode_height_map.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "testbench/input/map/png_encoder.h"

namespace tessera {
namespace {

constexpr double highest_code = 65535;

/// Rows from the top, as in all three formats.
template <typename Sample, typename Convert>
std::vector<Sample> top_down(int width, const std::vector<double>& heights, Convert convert) {
    std::vector<Sample> samples;
    samples.reserve(heights.size());
    for (std::size_t end = heights.size(); end > 0; end -= static_cast<std::size_t>(width))
        for (std::size_t k = end - static_cast<std::size_t>(width); k < end; ++k)
            samples.push_back(convert(heights[k]));
    return samples;
}

std::string pgm_file(int width, int height, const std::vector<std::uint16_t>& samples) {
    std::string file = fmt::format("P5\n{} {}\n65535\n", width, height);
    for (const std::uint16_t sample : samples) {
        file += static_cast<char>(sample >> 8);
        file += static_cast<char>(sample & 0xff);
    }
    return file;
}

/// One channel Y, without a time stamp: the same map gives the same bytes.
std::string exr_file(int width, int height, const std::vector<float>& samples) {
    Imf::Header header(width, height, 1, Imath::V2f(0, 0), 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    Imf::FrameBuffer frame;
    // OpenEXR only reads through this pointer.
    frame.insert("Y", Imf::Slice::Make(Imf::FLOAT, const_cast<float*>(samples.data()), header.dataWindow()));
    Imf::setGlobalThreadCount(0);
    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, header, 0);
        file.setFrameBuffer(frame);
        file.writePixels(height);
    }  // the destructor completes the file
    return stream.str();
}

}  // namespace

EncodedMap encode_height_map(int width, int height, const std::vector<double>& heights, MapFormat format) {
    EncodedMap map;
    if (format == MapFormat::exr) {
        map.bytes = exr_file(width, height,
                             top_down<float>(width, heights, [](double value) { return static_cast<float>(value); }));
        return map;
    }
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    map.bias = *low;
    const double range = *high - *low;
    if (range > 0) {
        map.scale = range;
        map.step = range / highest_code;
    }
    const auto samples = top_down<std::uint16_t>(width, heights, [&](double value) {
        return static_cast<std::uint16_t>(std::floor((value - map.bias) / map.scale * highest_code + 0.5));
    });
    if (format == MapFormat::pgm) {
        map.bytes = pgm_file(width, height, samples);
    } else {
        // libpng's name for 16-bit grey; no conversion takes place.
        map.bytes = encode_png_samples(width, height, PNG_FORMAT_LINEAR_Y, samples.data());
    }
    return map;
}

}  // namespace tessera

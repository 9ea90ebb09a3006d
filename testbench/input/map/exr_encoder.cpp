#include "testbench/input/map/exr_encoder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfThreading.h>

#include <cstddef>

namespace tessera {

std::string encode_exr_samples(Imf::Header header, const std::vector<const char*>& channels, Imf::PixelType type,
                               const void* samples) {
    const Imath::Box2i window = header.dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const std::size_t sample = type == Imf::HALF ? 2 : 4, pixel = channels.size() * sample;
    Imf::FrameBuffer frame;
    for (std::size_t k = 0; k < channels.size(); ++k) {
        header.channels().insert(channels[k], Imf::Channel(type));
        // OpenEXR only reads through this pointer.
        char* const first = const_cast<char*>(static_cast<const char*>(samples)) + k * sample;
        frame.insert(channels[k], Imf::Slice::Make(type, first, window, pixel, pixel * width));
    }
    Imf::setGlobalThreadCount(0);
    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, header, 0);
        file.setFrameBuffer(frame);
        file.writePixels(window.max.y - window.min.y + 1);
    }  // the destructor completes the file
    return stream.str();
}

}  // namespace tessera

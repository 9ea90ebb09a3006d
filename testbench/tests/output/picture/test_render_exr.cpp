#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStdIO.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "testbench/output/picture/exr_writer.h"
#include "testbench/output/picture/palette.h"
#include "testbench/output/picture/view_picture.h"
#include "testbench/tests/output/picture/render_scenes.h"

using namespace tessera;

namespace {

struct ReadBack {
    LinearImage image;
    Imf::PixelType type = Imf::UINT;
    std::string attributes;
};

/// Reads with OpenEXR's own reader, the file's first row first.
ReadBack read_back(const std::string& file) {
    Imf::StdISStream stream;
    stream.str(file);
    Imf::InputFile input(stream);
    const Imf::Header& header = input.header();
    const Imath::Box2i window = header.dataWindow();
    CHECK(window.min == Imath::V2i(0, 0));
    CHECK(header.displayWindow() == window);
    CHECK(header.lineOrder() == Imf::INCREASING_Y);
    ReadBack result;
    std::size_t channels = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        ++channels;
        result.type = channel.channel().type;
    }
    CHECK(channels == 3);
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
        result.attributes += std::string(attribute.name()) + " ";
    result.image.width = window.max.x + 1;
    result.image.height = window.max.y + 1;
    result.image.values.resize(result.image.offset(0, result.image.height));
    const char* const names[] = {"R", "G", "B"};
    Imf::FrameBuffer frame;
    for (std::size_t k = 0; k < 3; ++k)
        frame.insert(names[k], Imf::Slice::Make(Imf::FLOAT, result.image.values.data() + k, window, 3 * sizeof(float),
                                                3 * sizeof(float) * static_cast<std::size_t>(result.image.width)));
    input.setFrameBuffer(frame);
    input.readPixels(0, window.max.y);
    return result;
}

Picture sample_picture() {
    PictureOptions options;
    options.width = 300;
    options.linear = true;
    return render_views(make_sphere({0, 0, 0}, 48), look_down(3, 256, 192, 200), {PictureView::generation}, options)
        .front();
}

/// The largest difference in any channel, in codes of the PNG.
int largest_difference(const LinearImage& linear, const Image& image) {
    int largest = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* const light = &linear.values[linear.offset(x, y)];
            const Colour encoded = to_srgb({light[0], light[1], light[2]});
            const Colour colour = image.at(x, y);
            for (std::size_t k = 0; k < 3; ++k)
                largest = std::max(largest, std::abs(int{encoded[k]} - int{colour[k]}));
        }
    return largest;
}

}  // namespace

TEST_CASE("render: an EXR file has the PNG's pixels in linear light") {
    const Picture picture = sample_picture();
    REQUIRE(picture.linear.width == picture.image.width);
    REQUIRE(picture.linear.height == picture.image.height);
    CHECK(largest_difference(picture.linear, picture.image) == 0);
    SECTION("float: bit for bit") {
        const ReadBack file = read_back(encode_exr(picture.linear, ExrSamples::single));
        CHECK(file.type == Imf::FLOAT);
        CHECK(file.image.width == picture.image.width);
        CHECK(file.image.values == picture.linear.values);
        CHECK(largest_difference(file.image, picture.image) == 0);
    }
    SECTION("half: within a rounding step") {
        const ReadBack file = read_back(encode_exr(picture.linear, ExrSamples::half));
        CHECK(file.type == Imf::HALF);
        REQUIRE(file.image.values.size() == picture.linear.values.size());
        CHECK(largest_difference(file.image, picture.image) <= 1);
        for (std::size_t i = 0; i < file.image.values.size(); ++i)
            REQUIRE(std::abs(file.image.values[i] - picture.linear.values[i]) <=
                    picture.linear.values[i] / 2048 + 6e-8f);
    }
}

TEST_CASE("render: the first row of an EXR file is the upper one") {
    LinearImage image{3, 2, {}};
    for (int i = 0; i < 18; ++i)
        image.values.push_back(static_cast<float>(i) / 4);  // also beyond 1
    for (const ExrSamples samples : {ExrSamples::half, ExrSamples::single}) {
        const ReadBack file = read_back(encode_exr(image, samples));
        CHECK(file.image.width == 3);
        CHECK(file.image.height == 2);
        CHECK(file.image.values == image.values);
    }
}

TEST_CASE("render: an EXR file does not contain the time and place of its creation") {
    const Picture picture = sample_picture();
    const std::string file = encode_exr(picture.linear, ExrSamples::half);
    CHECK(file == encode_exr(sample_picture().linear, ExrSamples::half));
    const std::string attributes = read_back(file).attributes;
    CHECK(attributes.find("chromaticities") != std::string::npos);
    for (const char* const word : {"Date", "Time", "owner", "comments"})
        CHECK(attributes.find(word) == std::string::npos);
}

TEST_CASE("render: an overview in linear light equals the overview") {
    PictureOptions options;
    options.width = 320;
    const RenderMesh mesh = make_sphere({0, 0, 0}, 24);
    const View view = look_down(3, 256, 192, 200);
    const auto overview = [&] { return render_views(mesh, view, {PictureView::overview}, options).front(); };
    const Picture plain = overview();
    options.linear = true;
    const Picture both = overview();
    CHECK(plain.linear.values.empty());
    CHECK(plain.image.bytes == both.image.bytes);
    CHECK(largest_difference(both.linear, both.image) == 0);
}

#include "testbench/maps/exr_reader.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStdIO.h>
#include <ImfThreading.h>
#include <ImfTiledInputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <new>
#include <string_view>

#include "testbench/common/error.h"
#include "testbench/maps/exr_header.h"
#include "testbench/maps/map_file.h"
#include "testbench/maps/repair_non_finite.h"

namespace tessera {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view why) {
    throw InputError(fmt::format("{}: {}", path.string(), why));
}

std::string channel_names(const ExrHeader& header) {
    constexpr std::size_t most = 16;
    std::string names;
    for (std::size_t i = 0; i < std::min(most, header.channels.size()); ++i) {
        names += (i == 0 ? "" : ", ") + printable_ascii(header.channels[i].name);
    }
    return header.channels.size() > most ? names + ", ..." : names;
}

const ExrChannel& choose_channel(const std::filesystem::path& path, const ExrHeader& header,
                                 const std::string& wanted) {
    const auto find = [&header](std::string_view name) -> const ExrChannel* {
        const auto found = std::find_if(header.channels.begin(), header.channels.end(),
                                        [name](const ExrChannel& channel) { return channel.name == name; });
        return found == header.channels.end() ? nullptr : &*found;
    };
    if (!wanted.empty()) {
        if (const ExrChannel* const named = find(wanted)) {
            return *named;
        }
        refuse(path,
               fmt::format("the EXR file has no channel \"{}\"; it has: {}. Set map.channel to one of these.",
                           printable_ascii(wanted), channel_names(header)));
    }
    for (const std::string_view name : {"Y", "R"}) {
        if (const ExrChannel* const usual = find(name)) {
            return *usual;
        }
    }
    if (header.channels.size() != 1) {
        refuse(path,
               fmt::format(
                   "the EXR file has neither a channel Y nor R, and more than one: {}. Set map.channel to "
                   "the one with the heights.",
                   channel_names(header)));
    }
    return header.channels.front();
}

// Rows come top first, as in the file. Returns whether the file says of itself that nothing is missing.
bool read_pixels(const std::filesystem::path& path, const ExrHeader& header, const std::string& channel,
                 HeightMap& map) {
    Imf::setGlobalThreadCount(0);
    std::ifstream file(path, std::ios::binary);
    Imf::StdIFStream stream(file, path.filename().string().c_str());
    const Imath::Box2i window({header.left, header.top},
                              {header.left + map.width - 1, header.top + map.height - 1});
    Imf::FrameBuffer frame;
    frame.insert(channel, Imf::Slice::Make(Imf::FLOAT, map.values.data(), window, sizeof(float),
                                           sizeof(float) * static_cast<std::size_t>(map.width)));
    const auto check_window = [&](const Imf::Header& seen) {
        if (seen.dataWindow() != window) {
            refuse(path,
                   "libOpenEXR finds another data window in the EXR file than its header states. It is "
                   "damaged.");
        }
    };
    // InputFile would read tiles too, but through a buffer as large as a row of them.
    if (header.tiled) {
        Imf::TiledInputFile input(stream, 0);
        check_window(input.header());
        input.setFrameBuffer(frame);
        input.readTiles(0, input.numXTiles(0) - 1, 0, input.numYTiles(0) - 1);
        return input.isComplete();
    }
    Imf::InputFile input(stream, 0);
    check_window(input.header());
    input.setFrameBuffer(frame);
    input.readPixels(window.min.y, window.max.y);
    return input.isComplete();
}

void turn_bottom_up(HeightMap& map) {
    const auto width = static_cast<std::ptrdiff_t>(map.width);
    auto low = map.values.begin();
    for (auto high = map.values.end() - width; low < high; low += width, high -= width) {
        std::swap_ranges(low, low + width, high);
    }
}

void add_remarks(const ExrHeader& header, const ExrChannel& channel, bool complete, HeightMap& map) {
    for (const std::string& name : header.absent) {
        map.repairs.push_back(fmt::format(
            "The EXR header lacks the required attribute {}; the map does not depend on it.", name));
    }
    if (!complete) {
        map.repairs.push_back(
            "The EXR file's offset table is incomplete (its writer did not finish); the pixels were all "
            "found.");
    }
    if (channel.type == Imf::UINT) {
        map.repairs.push_back(
            fmt::format("Channel {} holds 32-bit unsigned integers; they were converted to float, which is "
                        "exact up to 16777216.",
                        printable_ascii(channel.name)));
        return;
    }
    const float smallest_normal = channel.type == Imf::HALF ? 0x1p-14F : 0x1p-126F;
    const auto subnormal = std::count_if(
        map.values.begin(), map.values.end(),
        [smallest_normal](float value) { return value != 0 && std::fabs(value) < smallest_normal; });
    if (subnormal > 0) {
        map.repairs.push_back(
            fmt::format("{} texel{} hold{} subnormal numbers (below {:.3g}); kept as they are.", subnormal,
                        subnormal == 1 ? "" : "s", subnormal == 1 ? "s" : "", smallest_normal));
    }
}

}  // namespace

HeightMap read_exr(const std::filesystem::path& path, const std::string& wanted) {
    const ExrHeader header = read_exr_header(path);
    const ExrChannel& channel = choose_channel(path, header, wanted);
    if (channel.x_sampling != 1 || channel.y_sampling != 1) {
        refuse(
            path,
            fmt::format(
                "the EXR file's channel {} holds only every {} x {} pixel; a map needs one value per texel. "
                "Save it without subsampling.",
                printable_ascii(channel.name), channel.x_sampling, channel.y_sampling));
    }
    HeightMap map;
    map.width = static_cast<int>(header.width);
    map.height = static_cast<int>(header.height);
    map.values.resize(static_cast<std::size_t>(header.width * header.height));
    bool complete = true;
    try {
        complete = read_pixels(path, header, channel.name, map);
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        refuse(path,
               fmt::format(
                   "OpenEXR cannot read the file: {} It is damaged or was cut off: save or download it anew.",
                   printable_ascii(error.what())));
    }
    turn_bottom_up(map);
    if (!repair_non_finite(map)) {
        refuse(
            path,
            fmt::format(
                "all {} texels of the EXR file's channel {} are NaN or infinite; a map needs finite heights.",
                map.values.size(), printable_ascii(channel.name)));
    }
    add_remarks(header, channel, complete, map);
    return map;
}

}  // namespace tessera

#include "testbench/input/map/exr_reader.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <new>
#include <string_view>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/input/map/exr_check.h"
#include "testbench/input/map/map_file.h"

namespace tessera {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view why) {
    throw InputError(fmt::format("{}: {}", path.string(), why));
}

std::string choose_channel(const std::filesystem::path& path, const Imf::ChannelList& channels,
                           const std::string& wanted) {
    std::vector<std::string> names;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        names.emplace_back(channel.name());
    const std::string list = printable_ascii(fmt::format("{}", fmt::join(names, ", ")));
    if (!wanted.empty()) {
        if (channels.findChannel(wanted) == nullptr)
            refuse(path, fmt::format("the EXR file has no channel \"{}\"; it has: {}. Set map.channel to one of these.",
                                     printable_ascii(wanted), list));
        return wanted;
    }
    for (const char* const usual : {"Y", "R"})
        if (channels.findChannel(usual) != nullptr)
            return usual;
    if (names.size() != 1)
        refuse(path,
               fmt::format("the EXR file has neither a channel Y nor R, and more than one: {}. Set map.channel to "
                           "the one with the heights.",
                           list));
    return names.front();
}

void turn_bottom_up(HeightMap& map) {
    const auto width = static_cast<std::ptrdiff_t>(map.width);
    auto low = map.values.begin();
    for (auto high = map.values.end() - width; low < high; low += width, high -= width)
        std::swap_ranges(low, low + width, high);
}

void add_remarks(const std::string& name, Imf::PixelType type, HeightMap& map) {
    if (type == Imf::UINT) {
        map.repairs.push_back(
            fmt::format("Channel {} holds 32-bit unsigned integers; they were converted to float, which is "
                        "exact up to 16777216.",
                        printable_ascii(name)));
        return;
    }
    const float smallest_normal = type == Imf::HALF ? 0x1p-14F : 0x1p-126F;
    const auto subnormal = std::count_if(map.values.begin(), map.values.end(), [smallest_normal](float value) {
        return value != 0 && std::fabs(value) < smallest_normal;
    });
    if (subnormal > 0)
        map.repairs.push_back(fmt::format("{} texel{} hold{} subnormal numbers (below {:.3g}); kept as they are.",
                                          subnormal, subnormal == 1 ? "" : "s", subnormal == 1 ? "s" : "",
                                          smallest_normal));
}

/// Makes every value of a floating-point map finite, and sets its range.
///
///     NaN, -infinity -> lowest finite value        (usually a hole in a scan or terrain)
///     +infinity      -> highest finite value
///
/// Each kind is counted and reported in `repairs`. range_low, range_high = lowest and highest finite value; equal
/// for a constant map. Returns false, and leaves the map unchanged, if no value is finite.
bool repair_non_finite(HeightMap& map) {
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    for (const float value : map.values) {
        if (std::isfinite(value)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    if (!(low <= high))
        return false;
    std::int64_t nan_count = 0;
    std::int64_t plus_count = 0;
    std::int64_t minus_count = 0;
    for (float& value : map.values) {
        if (std::isnan(value)) {
            ++nan_count;
            value = low;
        } else if (std::isinf(value)) {
            ++(value > 0 ? plus_count : minus_count);
            value = value > 0 ? high : low;
        }
    }
    const auto say = [&map](std::int64_t count, std::string_view kind, std::string_view which, float value) {
        if (count > 0)
            map.repairs.push_back(fmt::format("{} {} texel{} set to the {} finite value, {}.", count, kind,
                                              count == 1 ? "" : "s", which, value));
    };
    say(nan_count, "NaN", "lowest", low);
    say(plus_count, "+infinity", "highest", high);
    say(minus_count, "-infinity", "lowest", low);
    map.range_low = static_cast<double>(low);
    map.range_high = static_cast<double>(high);
    return true;
}

HeightMap read_checked(const std::filesystem::path& path, const std::string& wanted) {
    Imf::setGlobalThreadCount(0);
    Imf::InputFile file(path.c_str(), 0);
    const std::string name = choose_channel(path, file.header().channels(), wanted);
    const Imf::Channel channel = file.header().channels()[name];
    if (channel.xSampling != 1 || channel.ySampling != 1)
        refuse(path,
               fmt::format("the EXR file's channel {} holds only every {} x {} pixel; a map needs one value per texel. "
                           "Save it without subsampling.",
                           printable_ascii(name), channel.xSampling, channel.ySampling));
    const Imath::Box2i window = file.header().dataWindow();
    HeightMap map;
    map.width = window.max.x - window.min.x + 1;
    map.height = window.max.y - window.min.y + 1;
    map.values.resize(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
    Imf::FrameBuffer frame;
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, map.values.data(), window, sizeof(float),
                                        sizeof(float) * static_cast<std::size_t>(map.width)));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    turn_bottom_up(map);
    if (!repair_non_finite(map))
        refuse(path, fmt::format(
                         "all {} texels of the EXR file's channel {} are NaN or infinite; a map needs finite heights.",
                         map.values.size(), printable_ascii(name)));
    add_remarks(name, channel.type, map);
    return map;
}

}  // namespace

HeightMap read_exr(const std::filesystem::path& path, const std::string& channel) {
    const std::vector<std::string> remarks = check_exr(path);
    try {
        HeightMap map = read_checked(path, channel);
        map.repairs.insert(map.repairs.end(), remarks.begin(), remarks.end());
        return map;
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        refuse(path,
               fmt::format("OpenEXR cannot read the file: {} It is damaged or was cut off: save or download it again.",
                           printable_ascii(error.what())));
    }
}

}  // namespace tessera

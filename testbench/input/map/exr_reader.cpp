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
#include <cstring>
#include <exception>
#include <new>
#include <string_view>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/input/map/exr_check.h"
#include "testbench/input/map/map_file.h"
#include "testbench/input/map/no_data.h"

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

void remark_on_subnormal(Imf::PixelType type, HeightMap& map) {
    if (type == Imf::UINT)
        return;
    const float smallest_normal = type == Imf::HALF ? 0x1p-14F : 0x1p-126F;
    const auto subnormal = std::count_if(map.values.begin(), map.values.end(), [smallest_normal](float value) {
        return value != 0 && std::fabs(value) < smallest_normal;
    });
    if (subnormal > 0)
        map.repairs.push_back(fmt::format("{} texel{} hold{} subnormal numbers (below {:.3g}); kept as they are.",
                                          subnormal, subnormal == 1 ? "" : "s", subnormal == 1 ? "s" : "",
                                          smallest_normal));
}

/// Another channel of the file than the map's.
struct Other {
    std::string name;
    bool subsampled;
    bool is_alpha;  // of which an opaque one, all 1, is no anomaly
    std::int64_t different = 0;
    bool opaque = true;
};

class ExrMap {
  public:
    ExrMap(const std::filesystem::path& path, const PixelWindow& image)
        : file_(path.c_str(), 0), data_(file_.header().dataWindow()), image_(image) {}

    const Imf::ChannelList& channels() const { return file_.header().channels(); }

    /// Texels outside the data window are 0. Counts the texels in which the others differ, and those of unsigned integers
    /// that a float does not hold.
    HeightMap read(const std::string& name, std::vector<Other>& others) {
        HeightMap map;
        const bool whole = channels()[name].type == Imf::UINT;
        std::int64_t rounded = 0;
        map.width = static_cast<int>(image_.width());
        map.height = static_cast<int>(image_.height());
        map.values.resize(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
        // All channels are decoded anyway. OpenEXR keeps the block of lines that a strip ends in.
        constexpr std::size_t most_values = 4 << 20, most_lines = 256;
        const auto width = static_cast<std::size_t>(data_.max.x - data_.min.x) + 1;
        const std::size_t fitting = std::clamp(most_values / (width * (1 + others.size())), std::size_t{1}, most_lines);
        std::vector<std::vector<float>> strips(1 + others.size(), std::vector<float>(width * fitting));
        const int lines = static_cast<int>(fitting);
        const int top = std::max(data_.min.y, image_.top), bottom = std::min(data_.max.y, image_.bottom);
        const int left = std::max(data_.min.x, image_.left), right = std::min(data_.max.x, image_.right);
        for (int first = top; first <= bottom; first += lines) {
            const int last = std::min(bottom, first + lines - 1);
            read_strip(name, whole, others, first, last, strips);
            for (int y = first; y <= last; ++y) {
                const std::size_t from =
                    static_cast<std::size_t>(y - first) * width + static_cast<std::size_t>(left - data_.min.x);
                const std::size_t count = static_cast<std::size_t>(right - left) + 1;
                float* const row = strips[0].data() + from;
                if (whole)
                    rounded += round_integers(row, count);
                std::copy_n(row, count, &map.at(left - image_.left, map.height - 1 - (y - image_.top)));
                for (std::size_t k = 0; k < others.size(); ++k)
                    if (!others[k].subsampled)
                        compare(row, strips[k + 1].data() + from, count, others[k]);
            }
        }
        if (rounded > 0)
            map.repairs.push_back(fmt::format(
                "{} texel{} of channel {} hold{} unsigned integers beyond 16777216 that were rounded to 24 bits.",
                rounded, rounded == 1 ? "" : "s", printable_ascii(name), rounded == 1 ? "s" : ""));
        return map;
    }

  private:
    /// Replaces the bits of unsigned integers by the nearest floats, and counts those that differ.
    static std::int64_t round_integers(float* row, std::size_t count) {
        std::int64_t rounded = 0;
        for (std::size_t x = 0; x < count; ++x) {
            std::uint32_t integer = 0;
            std::memcpy(&integer, row + x, sizeof integer);
            row[x] = static_cast<float>(integer);
            rounded += static_cast<double>(row[x]) != integer ? 1 : 0;
        }
        return rounded;
    }

    static void compare(const float* row, const float* other, std::size_t count, Other& result) {
        for (std::size_t x = 0; x < count; ++x) {
            const bool same = row[x] == other[x] || (std::isnan(row[x]) && std::isnan(other[x]));
            result.different += same ? 0 : 1;
            result.opaque = result.opaque && other[x] == 1;
        }
    }

    void read_strip(const std::string& name, bool whole, const std::vector<Other>& others, int first, int last,
                    std::vector<std::vector<float>>& strips) {
        const Imath::Box2i window({data_.min.x, first}, {data_.max.x, last});
        const std::size_t row = sizeof(float) * (static_cast<std::size_t>(data_.max.x - data_.min.x) + 1);
        Imf::FrameBuffer frame;
        const auto insert = [&](const std::string& channel, std::vector<float>& strip,
                                Imf::PixelType type = Imf::FLOAT) {
            frame.insert(channel, Imf::Slice::Make(type, strip.data(), window, sizeof(float), row));
        };
        insert(name, strips[0], whole ? Imf::UINT : Imf::FLOAT);
        for (std::size_t k = 0; k < others.size(); ++k)
            if (!others[k].subsampled)
                insert(others[k].name, strips[k + 1]);
        file_.setFrameBuffer(frame);
        file_.readPixels(first, last);
    }

    Imf::InputFile file_;
    Imath::Box2i data_;
    const PixelWindow& image_;
};

/// The channels that the map leaves out, if they hold anything else.
std::string other_channels(const std::string& name, const std::vector<Other>& others) {
    std::vector<std::string> names;
    std::int64_t most = 0;
    for (const Other& other : others)
        if (other.subsampled || (other.different > 0 && !(other.is_alpha && other.opaque))) {
            names.push_back(other.name);
            most = std::max(most, other.different);
        }
    if (names.empty())
        return {};
    const bool one = names.size() == 1;
    return fmt::format(
        "The heights are those of channel {}; channel{} {} hold{} other values{}, and {} left out. map.channel takes "
        "another one.",
        printable_ascii(name), one ? "" : "s", printable_ascii(fmt::format("{}", fmt::join(names, ", "))),
        one ? "s" : "", most > 0 ? fmt::format(" (at up to {} texels)", most) : "", one ? "was" : "were");
}

HeightMap read_checked(const std::filesystem::path& path, const std::string& wanted, const std::vector<double>& no_data,
                       const PixelWindow& image) {
    Imf::setGlobalThreadCount(0);
    ExrMap exr(path, image);
    const std::string name = choose_channel(path, exr.channels(), wanted);
    const Imf::Channel channel = exr.channels()[name];
    const auto is_subsampled = [](const Imf::Channel& it) { return it.xSampling != 1 || it.ySampling != 1; };
    if (is_subsampled(channel))
        refuse(path,
               fmt::format("the EXR file's channel {} holds only every {} x {} pixel; a map needs one value per texel. "
                           "Save it without subsampling.",
                           printable_ascii(name), channel.xSampling, channel.ySampling));
    std::vector<Other> others;
    for (auto other = exr.channels().begin(); wanted.empty() && other != exr.channels().end(); ++other)
        if (other.name() != name)
            others.push_back({other.name(), is_subsampled(other.channel()), other.name() == std::string_view("A")});
    HeightMap map = exr.read(name, others);
    map.significant_bits = channel.type == Imf::HALF ? HeightMap::half_bits : HeightMap::float_bits;
    const auto range = replace_missing(map, no_data);
    if (!range)
        refuse(path, fmt::format("all {} texels of the EXR file's channel {} are NaN, infinite or of a value in "
                                 "map.no_data; a map needs finite heights.",
                                 map.values.size(), printable_ascii(name)));
    map.range_low = static_cast<double>((*range)[0]);
    map.range_high = static_cast<double>((*range)[1]);
    if (std::string text = other_channels(name, others); !text.empty())
        map.repairs.push_back(std::move(text));
    remark_on_subnormal(channel.type, map);
    return map;
}

}  // namespace

HeightMap read_exr(const std::filesystem::path& path, const std::string& channel, const std::vector<double>& no_data) {
    const ExrCheck check = check_exr(path);
    try {
        HeightMap map = read_checked(path, channel, no_data, check.image);
        map.repairs.insert(map.repairs.end(), check.remarks.begin(), check.remarks.end());
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

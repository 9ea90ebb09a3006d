#include "testbench/input/map/no_data.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

namespace tessera {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

float in_precision(double value, int significant_bits) {
    if (std::abs(value) >= 0x1.ffffffp127)  // rounds to infinity; the conversion would be undefined
        return value < 0 ? -infinity : infinity;
    const auto number = static_cast<float>(value);
    return significant_bits == HeightMap::half_bits ? static_cast<float>(Imath::half(number)) : number;
}

class NoData {
  public:
    NoData(const HeightMap& map, double value)
        : nearest_(in_precision(value / map.source_units, map.significant_bits)), value_(value) {}

    bool matches(float value) const {
        constexpr double no_height = 1e30, part = 0.01;
        return value == nearest_ || (std::abs(value_) >= no_height && std::isfinite(value) &&
                                     std::abs(static_cast<double>(value) - value_) <= part * std::abs(value_));
    }

  private:
    float nearest_;
    double value_;
};

/// What a texel holds: a height, one of these, or one of the no_data values, from `first_no_data` on.
enum Kind : std::size_t { height, not_a_number, above, below, first_no_data };

std::size_t kind_of(float value, const std::vector<NoData>& no_data) {
    for (std::size_t k = 0; k < no_data.size(); ++k)
        if (no_data[k].matches(value))
            return first_no_data + k;
    return std::isnan(value) ? not_a_number : std::isfinite(value) ? height : value > 0 ? above : below;
}

/// A value as in the source: of PGM and PNG the whole number, else the digits that identify it.
std::string in_source(float value, const HeightMap& map) {
    if (map.source_units == 1)
        return fmt::format("{}", value);
    return fmt::format("{}", std::llround(static_cast<double>(value) * map.source_units));
}

}  // namespace

std::optional<std::array<float, 2>> replace_missing(HeightMap& map, const std::vector<double>& no_data) {
    std::vector<NoData> wanted;
    wanted.reserve(no_data.size());
    for (const double value : no_data)
        wanted.emplace_back(map, value);
    std::vector<std::int64_t> counts(first_no_data + no_data.size(), 0);
    float low = infinity, high = -infinity;
    for (const float value : map.values) {
        const std::size_t kind = kind_of(value, wanted);
        ++counts[kind];
        if (kind == height) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    if (counts[height] == 0)
        return {};
    map.replaced.reserve(map.values.size() - static_cast<std::size_t>(counts[height]));
    for (std::size_t texel = 0; texel < map.values.size() && map.replaced.size() < map.replaced.capacity(); ++texel) {
        float& value = map.values[texel];
        const std::size_t kind = kind_of(value, wanted);
        if (kind == height)
            continue;
        map.replaced.push_back({static_cast<std::uint32_t>(texel), value});
        value = kind == above ? high : low;
    }
    const auto say = [&](std::size_t kind, const std::string& name, const char* which, float value) {
        if (counts[kind] > 0)
            map.repairs.push_back(fmt::format("{} {} texel{} set to the {} value, {}.", counts[kind], name,
                                              counts[kind] == 1 ? "" : "s", which, in_source(value, map)));
    };
    const char* const lowest = no_data.empty() ? "lowest finite" : "lowest remaining";
    say(not_a_number, "NaN", lowest, low);
    say(above, "+infinity", no_data.empty() ? "highest finite" : "highest remaining", high);
    say(below, "-infinity", lowest, low);
    for (std::size_t k = 0; k < no_data.size(); ++k) {
        say(first_no_data + k, fmt::format("no-data ({})", no_data[k]), lowest, low);
        if (counts[first_no_data + k] == 0)
            map.repairs.push_back(
                fmt::format("No texel has the value {} of map.no_data; the map's values are {} to {}.", no_data[k],
                            in_source(low, map), in_source(high, map)));
    }
    return std::array{low, high};
}

namespace {

/// A value, and how many texels hold it.
struct Level {
    float value;
    std::int64_t count = 0;
};

/// The values of a map between two limits, both excluded.
struct Between {
    const std::vector<float>* values;
    float floor = -infinity, ceiling = infinity;

    bool has(float value) const { return value > floor && value < ceiling; }

    /// The lowest or highest different values, the outermost first; infinite ones, which no texel holds, at the end.
    template <std::size_t Number>
    std::array<Level, Number> outermost(bool lowest) const {
        const auto before = [lowest](float a, float b) { return lowest ? a < b : a > b; };
        std::array<Level, Number> levels{};
        levels.fill({lowest ? infinity : -infinity});
        for (const float value : *values) {
            if (!has(value) || before(levels.back().value, value))
                continue;
            std::size_t place = 0;
            while (before(levels[place].value, value))
                ++place;
            if (value != levels[place].value) {
                for (std::size_t k = Number - 1; k > place; --k)
                    levels[k] = levels[k - 1];
                levels[place] = {value, 0};
            }
            ++levels[place].count;
        }
        return levels;
    }

    /// Up to `most` of the different values, in ascending order.
    std::set<float> some(std::size_t most) const {
        std::set<float> found;
        for (auto value = values->begin(); value != values->end() && found.size() < most; ++value)
            if (has(*value))
                found.insert(*value);
        return found;
    }
};

bool is_normalised(const HeightMap& map) {
    if (map.source_units != 1)
        return map.source_units <= 255;
    const auto [low, high] = map.extremes();
    return low >= 0 && high <= 1;
}

/// Values that seem to mark missing data: the outermost ones, or one of them.
struct Suspect {
    std::vector<float> values;
    std::int64_t count = 0;     ///< texels
    float next = 0;             ///< the value beside them
    double gap = 0, span = 0;   ///< between them and it; of it and the others
    bool ends_a_range = false;  ///< 0..1 or 8 bits, where floors and ceilings of ordinary maps lie

    bool stands_apart(const Between& others) const {
        constexpr std::size_t few = 8, many = 256;
        constexpr double beyond_heights = 1e30;  // in any unit
        // Gaps relative to the others' span; beside many others, which lie close together, less is enough.
        constexpr double far = 1, far_beside_many = 0.25, far_beside_few = 8, far_for_one = 1000,
                         far_for_one_beside_many = 4;
        constexpr double least_beside_one_level = 999;
        constexpr float dense = 16;  // gap by the largest between others
        if (gap < span * far_beside_many)
            return false;
        const std::set<float> levels = others.some(many);
        const double value = values.front(), other = next;
        if (std::abs(value) > beyond_heights && !levels.empty())
            return gap >= span * far;
        if (count == 1)
            return !ends_a_range && levels.size() >= few &&
                   gap >= span * (levels.size() == many ? far_for_one_beside_many : far_for_one);
        if (levels.size() == many)
            return true;
        if (levels.size() >= few) {
            double widest = 0;
            for (auto level = levels.begin(), above = std::next(level); above != levels.end(); level = above++)
                widest = std::max(widest, static_cast<double>(*above) - static_cast<double>(*level));
            return gap >= span * far || gap >= dense * widest;
        }
        if (levels.size() > 1)
            return !ends_a_range && value != 0 && gap >= span * far_beside_few;
        return levels.size() == 1 && value <= -least_beside_one_level && -value >= 2 * std::abs(other);
    }
};

std::string and_joined(const std::vector<std::string>& texts) {
    std::string result = texts.front();
    for (std::size_t k = 1; k < texts.size(); ++k)
        result += (k + 1 < texts.size() ? ", " : " and ") + texts[k];
    return result;
}

std::vector<std::string> in_source(const std::vector<float>& values, const HeightMap& map) {
    std::vector<std::string> texts;
    texts.reserve(values.size());
    for (const float value : values)
        texts.push_back(in_source(value, map));
    return texts;
}

std::string text_of(const Suspect& suspect, bool lowest, const HeightMap& map) {
    const bool one = suspect.values.size() == 1;
    return fmt::format(
        "{} texel{} {} the {} value{}, {}, which {} {:.6g} from the next, {}, while the others span {:.6g}",
        suspect.count, suspect.count == 1 ? " holds" : "s hold", one ? "exactly" : "one of",
        lowest ? "lowest" : "highest", one ? "" : "s", and_joined(in_source(suspect.values, map)), one ? "is" : "are",
        suspect.gap * map.source_units, in_source(suspect.next, map), suspect.span * map.source_units);
}

/// The fewest outermost values that stand apart from the others; none if these do not.
std::optional<Suspect> outermost_apart(const Between& rest, bool lowest, float opposite, bool normalised) {
    constexpr std::size_t most_values = 4;
    constexpr double close = 1.0 / 64;  // several differ by at most this part of the gap, and have two texels each
    const auto levels = rest.outermost<most_values + 1>(lowest);
    Suspect suspect;
    for (std::size_t k = 0; k < most_values && std::isfinite(levels[k + 1].value); ++k) {
        suspect.values.push_back(levels[k].value);
        suspect.count += levels[k].count;
        suspect.next = levels[k + 1].value;
        const double value = levels[k].value, next = suspect.next;
        suspect.gap = std::abs(next - value);
        suspect.span = std::abs(static_cast<double>(opposite) - next);
        suspect.ends_a_range = normalised && (value == 0 || value == 1);
        const double spread = std::abs(value - static_cast<double>(suspect.values.front()));
        if (k > 0 &&
            (spread > close * suspect.gap || suspect.count < 2 * static_cast<std::int64_t>(suspect.values.size())))
            continue;
        Between others = rest;
        (lowest ? others.floor : others.ceiling) = levels[k].value;
        if (suspect.stands_apart(others))
            return suspect;
    }
    return {};
}

/// Values that often mark missing data, as are their negatives; the last is -9999 in 16 bits without sign.
constexpr std::array markers{999.0, 9999.0, 32767.0, 32768.0, 65535.0, 99999.0, 55537.0};

bool marks_missing_data(double value, const HeightMap& map) {
    constexpr double lowest_height = -999, beyond_heights = 1e30;
    return value <= lowest_height || value >= beyond_heights || (map.source_units > 1 && value == map.source_units) ||
           std::find(markers.begin(), markers.end(), value) != markers.end();
}

/// Texels that hold one value, compared with the texels beside them.
struct Patch {
    float value;
    bool outermost;  ///< the lowest or the highest value
    std::int64_t count = 0, beside = 0;
    double differences = 0;  ///< from those beside them

    double mean_difference() const { return beside > 0 ? differences / static_cast<double>(beside) : 0; }

    bool stands_out(double span) const {
        constexpr std::int64_t few = 4, several = 64;
        constexpr double far = 0.1, far_of_several = 0.02;  // of all heights' span
        return count >= (outermost ? several : few) &&
               mean_difference() >= span * (outermost || count < several ? far : far_of_several);
    }
};

/// Counts the texels of each patch, given in the order of their values, and compares them.
void look_beside(const HeightMap& map, std::vector<Patch>& patches) {
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const float value = map.at(x, y);
            const auto patch = std::lower_bound(patches.begin(), patches.end(), value,
                                                [](const Patch& a, float b) { return a.value < b; });
            if (patch == patches.end() || patch->value != value)
                continue;
            ++patch->count;
            for (const auto& [column, row] : {std::pair{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}})
                if (column >= 0 && row >= 0 && column < map.width && row < map.height && map.at(column, row) != value) {
                    ++patch->beside;
                    patch->differences +=
                        std::abs(static_cast<double>(map.at(column, row)) - static_cast<double>(value));
                }
        }
}

/// The remark on values among the heights, or little apart from them, whose texels stand out from those beside them: one
/// that often marks missing data, or the lowest or the highest.
std::string remark_on_patches(const HeightMap& map, const Between& rest, std::vector<std::string>& values) {
    constexpr double apart = 0.05;  // of the heights' span: from the outermost value to the next
    constexpr std::size_t many = 256;
    if (rest.some(many).size() < many)
        return {};
    const auto lows = rest.outermost<2>(true), highs = rest.outermost<2>(false);
    const double span = static_cast<double>(highs[0].value) - static_cast<double>(lows[0].value);
    std::vector<Patch> patches;
    for (const auto& [outermost, next] : {lows, highs})
        if (std::abs(static_cast<double>(next.value) - static_cast<double>(outermost.value)) >= apart * span)
            patches.push_back({outermost.value, true});
    for (const double marker : markers)
        for (const double value : {marker, -marker})
            if (const float inside = in_precision(value / map.source_units, map.significant_bits);
                inside > lows[0].value && inside < highs[0].value)
                patches.push_back({inside, false});
    if (patches.empty())
        return {};
    std::sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) { return a.value < b.value; });
    look_beside(map, patches);
    std::vector<std::string> texts;
    for (const Patch& patch : patches)
        if (patch.stands_out(span)) {
            values.push_back(in_source(patch.value, map));
            texts.push_back(
                fmt::format("{} texels hold exactly {}, and those beside them differ from it by {:.6g} on average",
                            patch.count, values.back(), patch.mean_difference() * map.source_units));
        }
    return fmt::format("{}", fmt::join(texts, "; "));
}

/// Missing data that resampling has mixed with heights: near these texels, and only there, lie values between theirs and
/// all others.
struct Blurred {
    double value;  ///< of the missing data
    std::vector<bool> missing;
    std::int64_t mixed = 0;          ///< texels
    static constexpr int reach = 6;  // texels: of filters in use, also where they enlarge

    bool found_in(const HeightMap& map) {
        // Parts of the way from the missing data's value to the farthest one: of others like it, and of heights.
        constexpr double close = 1.0 / 64, far = 0.8;
        const Level lowest = Between{&map.values}.outermost<1>(true)[0],
                    highest = Between{&map.values}.outermost<1>(false)[0];
        const bool below = value <= static_cast<double>(lowest.value);
        const float farthest = (below ? highest : lowest).value;
        std::int64_t heights = 0, at_farthest = 0;
        for (int y = 0; y < map.height; ++y)
            for (int x = 0; x < map.width; ++x) {
                if (missing[texel(map, x, y)])
                    continue;
                const double here = map.at(x, y), part = (here - value) / (static_cast<double>(farthest) - value);
                if (part >= far) {
                    ++heights;
                    at_farthest += map.at(x, y) == farthest ? 1 : 0;
                } else if (part > close) {
                    if (!is_near(map, x, y))
                        return false;
                    ++mixed;
                }
            }
        // Smoothed edges between two levels, as of letters, are no missing data.
        return mixed > 0 && mixed < heights && 2 * at_farthest < heights;
    }

  private:
    static std::size_t texel(const HeightMap& map, int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
    }
    bool is_near(const HeightMap& map, int x, int y) const {
        for (int row = std::max(y - reach, 0); row <= std::min(y + reach, map.height - 1); ++row)
            for (int column = std::max(x - reach, 0); column <= std::min(x + reach, map.width - 1); ++column)
                if (missing[texel(map, column, row)])
                    return true;
        return false;
    }
};

/// The remark on a map with blurred borders of missing data; else empty.
std::string remark_on_blurred_borders(const HeightMap& map) {
    constexpr std::int64_t fewest = 4;  // texels of a value that is not given
    std::vector<double> values;
    for (const HeightMap::Replaced& replaced : map.replaced)
        if (const double was = replaced.was; std::isfinite(was) && (values.empty() || values.back() != was))
            values.push_back(was);
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    const std::size_t given = values.size();
    for (const bool lowest : {true, false})
        if (const Level level = Between{&map.values}.outermost<1>(lowest)[0];
            level.count >= fewest && marks_missing_data(static_cast<double>(level.value) * map.source_units, map))
            values.push_back(level.value);
    for (std::size_t k = 0; k < values.size(); ++k) {
        Blurred blurred{values[k], std::vector<bool>(map.values.size(), false)};
        for (std::size_t texel = 0; k >= given && texel < map.values.size(); ++texel)
            blurred.missing[texel] = static_cast<double>(map.values[texel]) == values[k];
        for (const HeightMap::Replaced& replaced : map.replaced)
            blurred.missing[replaced.texel] = true;
        if (!blurred.found_in(map))
            continue;
        const std::string value = in_source(static_cast<float>(values[k]), map);
        return fmt::format(
            "{} texels within {} of those that {} {} lie between that value and all others: {}the borders of missing data "
            "were blurred; export the map again without interpolation across them{}",
            blurred.mixed, Blurred::reach, k < given ? "held" : "hold", value,
            k < given ? "" : "if it marks missing data, ",
            k < given ? "" : fmt::format(", and set map.no_data = {}", value));
    }
    return {};
}

}  // namespace

void suspect_no_data(HeightMap& map, const std::vector<double>& given) {
    constexpr std::size_t most_suspects = 4;
    const bool normalised = is_normalised(map);
    if (!normalised)
        map.no_data_hint = remark_on_blurred_borders(map);
    if (!map.no_data_hint.empty())
        return;
    Between rest{&map.values};
    std::vector<std::string> texts, values;
    for (const double value : given)
        values.push_back(fmt::format("{}", value));
    for (bool found = true; found && texts.size() < most_suspects;) {
        found = false;
        const float low = rest.outermost<1>(true)[0].value, high = rest.outermost<1>(false)[0].value;
        for (const bool lowest : {true, false}) {
            const auto suspect = found ? std::nullopt : outermost_apart(rest, lowest, lowest ? high : low, normalised);
            if (!suspect)
                continue;
            texts.push_back(text_of(*suspect, lowest, map));
            for (const std::string& value : in_source(suspect->values, map))
                values.push_back(value);
            (lowest ? rest.floor : rest.ceiling) = suspect->values.back();
            found = true;
        }
    }
    if (!normalised)
        if (std::string patches = remark_on_patches(map, rest, values); !patches.empty())
            texts.push_back(std::move(patches));
    if (!texts.empty())
        map.no_data_hint = fmt::format("{}: if that marks missing data, set map.no_data = {}", fmt::join(texts, "; "),
                                       values.size() == 1 ? values[0] : fmt::format("[{}]", fmt::join(values, ", ")));
}

}  // namespace tessera

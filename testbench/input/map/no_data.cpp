#include "testbench/input/map/no_data.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>

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

/// A value as in the source, with the digits that identify it.
std::string in_source(float value, const HeightMap& map) {
    if (map.source_units == 1)
        return fmt::format("{}", value);
    return fmt::format("{:.9g}", static_cast<double>(value) * map.source_units);
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

/// The lowest or the highest of the values that are not yet suspected.
struct Extreme {
    float value, next;  // `next`: the value beside it
    std::int64_t count = 0;
};

/// The values of a map between two limits, both excluded.
struct Between {
    const std::vector<float>* values;
    float floor = -infinity, ceiling = infinity;

    bool has(float value) const { return value > floor && value < ceiling; }

    Extreme extreme(bool lowest) const {
        const auto before = [lowest](float a, float b) { return lowest ? a < b : a > b; };
        const float none = lowest ? infinity : -infinity;
        Extreme result{none, none};
        for (const float value : *values) {
            if (!has(value))
                continue;
            if (before(value, result.value)) {
                result = {value, result.value, 1};
            } else if (value == result.value) {
                ++result.count;
            } else if (before(value, result.next)) {
                result.next = value;
            }
        }
        return result;
    }

    bool has_values(std::size_t count) const {
        std::set<float> found;
        for (auto value = values->begin(); value != values->end() && found.size() < count; ++value)
            if (has(*value))
                found.insert(*value);
        return found.size() >= count;
    }
};

bool is_normalised(const HeightMap& map) {
    if (map.source_units != 1)
        return map.source_units <= 255;
    const auto [low, high] = map.extremes();
    return low >= 0 && high <= 1;
}

}  // namespace

void suspect_no_data(HeightMap& map, const std::vector<double>& given) {
    constexpr std::size_t fewest_others = 8, many_others = 256, most_suspects = 4;
    // Gaps beside an extreme value, relative to what the others span, from which it stands apart.
    constexpr double far = 1, far_for_one = 1000, far_beside_many = 0.25, far_for_one_beside_many = 4;
    constexpr double beyond_heights = 1e30;  // in any unit
    const bool normalised = is_normalised(map);
    Between rest{&map.values};
    std::vector<std::string> texts;
    std::vector<float> suspects;
    for (bool found = true; found && suspects.size() < most_suspects;) {
        found = false;
        const Extreme low = rest.extreme(true), high = rest.extreme(false);
        for (const bool lowest : {true, false}) {
            const Extreme& it = lowest ? low : high;
            if (low.value == high.value || (normalised && (it.value == 0 || it.value == 1)))
                continue;
            const double gap = std::abs(static_cast<double>(it.next) - static_cast<double>(it.value));
            const double others =
                std::abs(static_cast<double>(lowest ? high.value : low.value) - static_cast<double>(it.next));
            const bool one = it.count == 1;
            if (gap < others * (one ? far_for_one_beside_many : far_beside_many))
                continue;
            Between without = rest;
            (lowest ? without.floor : without.ceiling) = it.value;
            const bool is_no_height = std::abs(it.value) > beyond_heights;
            if (!without.has_values(is_no_height ? 1 : fewest_others) ||
                (gap < others * (one ? far_for_one : far) && !without.has_values(many_others)))
                continue;
            texts.push_back(fmt::format(
                "{} texel{} exactly the {} value, {}, which is {:.6g} from the next, {}, while the others "
                "span {:.6g}",
                it.count, it.count == 1 ? " holds" : "s hold", lowest ? "lowest" : "highest", in_source(it.value, map),
                gap * map.source_units, in_source(it.next, map), others * map.source_units));
            suspects.push_back(it.value);
            rest = without;
            found = true;
            break;
        }
    }
    if (suspects.empty())
        return;
    std::vector<std::string> values;
    values.reserve(given.size() + suspects.size());
    for (const double value : given)
        values.push_back(fmt::format("{}", value));
    for (const float value : suspects)
        values.push_back(in_source(value, map));
    map.no_data_hint = fmt::format("{}: if that marks missing data, set map.no_data = {}", fmt::join(texts, "; "),
                                   values.size() == 1 ? values[0] : fmt::format("[{}]", fmt::join(values, ", ")));
}

}  // namespace tessera

#include "testbench/input/map/no_data.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
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

/// Values that often mark missing data, as are their negatives; the last two are -9999 in 16 bits without sign.
constexpr std::array markers{999.0, 9999.0, 32767.0, 32768.0, 65535.0, 99999.0, 55537.0, 22769.0};

bool marks_missing_data(double value, const HeightMap& map) {
    constexpr double lowest_height = -999, beyond_heights = 1e30;
    return value <= lowest_height || value >= beyond_heights || (map.source_units > 1 && value == map.source_units) ||
           std::find(markers.begin(), markers.end(), value) != markers.end();
}

/// When texels that hold one value stand out from those beside them.
struct Rule {
    std::int64_t fewest;       ///< texels
    double far;                ///< mean difference from those beside them, by the heights' span
    double times;              ///< and by the mean difference elsewhere, which noise has, too
    bool may_be_floor = true;  ///< may hold most texels
    double all_round = 0;      ///< part of those beside them that differ so far
};
constexpr Rule rare{4, 0.1, 3}, frequent{64, 0.1, 3}, frequent_marker{64, 0.02, 3}, inner_zero{64, 0.1, 3, false},
    inner_value{64, 0.1, 8, false, 0.75};

/// Values, and each one's rules.
using Candidates = std::map<float, std::vector<const Rule*>>;

/// Texels that hold one value, compared with the texels beside them.
struct Patch {
    float value;
    std::vector<const Rule*> rules;
    std::int64_t count = 0, beside = 0, far = 0;
    double differences = 0;  ///< from those beside them

    double mean_difference() const { return beside > 0 ? differences / static_cast<double>(beside) : 0; }
};

/// The texels that hold heights, compared with those beside them.
class Neighbours {
  public:
    Neighbours(const HeightMap& map, const Between& heights) : map_(map) {
        missing_.reserve(map.values.size());
        for (const float value : map.values)
            missing_.push_back(!heights.has(value));
        for (const HeightMap::Replaced& replaced : map.replaced)
            missing_[replaced.texel] = true;
    }

    /// Values that differ by `step` or more from at least `fewest` texels beside them; none if such steps are common.
    std::vector<float> at_steps(double step, std::size_t fewest) const {
        constexpr std::size_t common = 2;  // texels by steps
        std::vector<float> values, found;
        for (std::size_t k = 0; k < map_.values.size() && values.size() <= map_.values.size() / common; ++k)
            for_those_beside(k, [&](float other) {
                if (std::abs(static_cast<double>(other) - static_cast<double>(map_.values[k])) >= step)
                    values.push_back(map_.values[k]);
            });
        if (values.size() > map_.values.size() / common)
            return {};
        std::sort(values.begin(), values.end());
        for (auto first = values.begin(), last = first; first != values.end(); first = last) {
            last = std::upper_bound(first, values.end(), *first);
            if (last - first >= static_cast<std::ptrdiff_t>(fewest))
                found.push_back(*first);
        }
        return found;
    }

    /// Fills in the patches, which have different values in ascending order. far: a difference.
    void look_at(std::vector<Patch>& patches, double far) {
        for (std::size_t k = 0; k < map_.values.size(); ++k) {
            if (missing_[k])
                continue;
            const float value = map_.values[k];
            auto patch = std::lower_bound(patches.begin(), patches.end(), value,
                                          [](const Patch& a, float b) { return a.value < b; });
            const bool found = patch != patches.end() && patch->value == value;
            if (found)
                ++patch->count;
            for_those_beside(k, [&](float other) {
                const double difference = std::abs(static_cast<double>(other) - static_cast<double>(value));
                ++pairs_;
                differences_ += difference;
                if (found && other != value) {
                    ++patch->beside;
                    patch->far += difference >= far ? 1 : 0;
                    patch->differences += difference;
                }
            });
        }
    }

    /// The first rule by which a patch stands out.
    const Rule* rule_met(const Patch& patch, double span) const {
        const std::int64_t pairs = pairs_ - 2 * patch.beside;  // each is seen from both its ends
        const double elsewhere = pairs > 0 ? (differences_ - 2 * patch.differences) / static_cast<double>(pairs) : 0;
        const bool floor = 2 * patch.count > static_cast<std::int64_t>(map_.values.size());
        for (const Rule* const rule : patch.rules)
            if (patch.count >= rule->fewest && (rule->may_be_floor || !floor) &&
                static_cast<double>(patch.far) >= rule->all_round * static_cast<double>(patch.beside) &&
                patch.mean_difference() >= std::max(rule->far * span, rule->times * elsewhere))
                return rule;
        return nullptr;
    }

  private:
    template <class At>
    void for_those_beside(std::size_t texel, At&& at) const {
        const auto width = static_cast<std::size_t>(map_.width);
        const std::size_t x = texel % width;
        const auto one = [&](bool within, std::size_t other) {
            if (within && !missing_[other])
                at(map_.values[other]);
        };
        if (missing_[texel])
            return;
        one(x > 0, texel - 1);
        one(x + 1 < width, texel + 1);
        one(texel >= width, texel - width);
        one(texel + width < map_.values.size(), texel + width);
    }

    const HeightMap& map_;
    std::vector<bool> missing_;
    std::int64_t pairs_ = 0;
    double differences_ = 0;
};

/// Values among the heights, or little apart from them, that may mark missing data.
Candidates candidates_for(const HeightMap& map, const std::array<Level, 2>& lows, const std::array<Level, 2>& highs,
                          bool normalised) {
    constexpr double apart = 0.05, marker_apart = 0.01;  // of the heights' span: from the outermost value to the next
    const float low = lows[0].value, high = highs[0].value;
    const double span = static_cast<double>(high) - static_cast<double>(low);
    const auto is_apart = [&](const std::array<Level, 2>& levels, double part) {
        return std::abs(static_cast<double>(levels[1].value) - static_cast<double>(levels[0].value)) >= part * span;
    };
    Candidates candidates;
    if (is_apart(lows, apart))
        candidates[low].push_back(low == 0 && !normalised ? &rare : &frequent);  // others are cliffs
    if (is_apart(highs, apart))
        candidates[high].push_back(&frequent);
    if (normalised)
        return candidates;
    if (low < 0 && lows[1].value >= 0)
        candidates[low].push_back(&rare);
    if (low < 0 && high > 0)
        candidates[0].push_back(&inner_zero);
    for (const double marker : markers)
        for (const double value : {marker, -marker}) {
            const float sought = in_precision(value / map.source_units, map.significant_bits);
            if (sought > low && sought < high) {
                candidates[sought] = {&rare, &frequent_marker};
            } else if ((sought == low && is_apart(lows, marker_apart)) ||
                       (sought == high && is_apart(highs, marker_apart)))
                candidates[sought].push_back(&rare);
        }
    return candidates;
}

/// The remark on such values whose texels stand out from those beside them.
std::string remark_on_patches(const HeightMap& map, const Between& rest, bool normalised,
                              std::vector<std::string>& values) {
    constexpr std::size_t many = 128;
    if (rest.some(many).size() < many)
        return {};
    const auto lows = rest.outermost<2>(true), highs = rest.outermost<2>(false);
    const double span = static_cast<double>(highs[0].value) - static_cast<double>(lows[0].value);
    Candidates candidates = candidates_for(map, lows, highs, normalised);
    const bool any_value = map.source_units == 1 && !normalised;
    if (candidates.empty() && !any_value)
        return {};
    Neighbours neighbours(map, rest);
    if (any_value) {
        constexpr std::size_t least_border = 16;  // of a square of inner_value.fewest texels in a corner of the map
        for (const float value : neighbours.at_steps(inner_value.far * span, least_border))
            if (value > lows[0].value && value < highs[0].value)
                candidates[value].push_back(&inner_value);
    }
    if (candidates.empty())
        return {};
    std::vector<Patch> patches;
    for (const auto& [value, rules] : candidates)
        patches.push_back({value, rules});
    neighbours.look_at(patches, inner_value.far * span);
    constexpr std::ptrdiff_t most_inner = 1;  // more are flat roofs
    std::vector<const Rule*> met(patches.size());
    std::transform(patches.begin(), patches.end(), met.begin(),
                   [&](const Patch& patch) { return neighbours.rule_met(patch, span); });
    const bool roofs = std::count(met.begin(), met.end(), &inner_value) > most_inner;
    std::vector<std::string> texts;
    for (std::size_t k = 0; k < patches.size(); ++k) {
        if (met[k] == nullptr || (roofs && met[k] == &inner_value))
            continue;
        values.push_back(in_source(patches[k].value, map));
        texts.push_back(
            fmt::format("{} texels hold exactly {}, and those beside them differ from it by {:.6g} on average",
                        patches[k].count, values.back(), patches[k].mean_difference() * map.source_units));
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
    if (std::string patches = remark_on_patches(map, rest, normalised, values); !patches.empty())
        texts.push_back(std::move(patches));
    if (!texts.empty())
        map.no_data_hint = fmt::format("{}: if that marks missing data, set map.no_data = {}", fmt::join(texts, "; "),
                                       values.size() == 1 ? values[0] : fmt::format("[{}]", fmt::join(values, ", ")));
}

}  // namespace tessera

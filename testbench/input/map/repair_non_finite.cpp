#include "testbench/input/map/repair_non_finite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace tessera {

bool repair_non_finite(HeightMap& map) {
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    for (const float value : map.values) {
        if (std::isfinite(value)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    if (!(low <= high)) {
        return false;
    }
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
        if (count > 0) {
            map.repairs.push_back(fmt::format("{} {} texel{} set to the {} finite value, {}.", count, kind,
                                              count == 1 ? "" : "s", which, value));
        }
    };
    say(nan_count, "NaN", "lowest", low);
    say(plus_count, "+infinity", "highest", high);
    say(minus_count, "-infinity", "lowest", low);
    map.range_low = static_cast<double>(low);
    map.range_high = static_cast<double>(high);
    return true;
}

}  // namespace tessera

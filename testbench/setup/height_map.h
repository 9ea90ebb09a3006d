#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tessera {

/// A displacement map before quantisation.
///
/// Texel (x, y) is values[y * width + x]; y = 0 is the BOTTOM row (v = 0): readers flip the image, since the texture
/// origin is at the bottom left (golden/ALGORITHM.md section 1).
struct HeightMap {
    int width = 0;
    int height = 0;
    std::vector<float> values;

    /// The values of the lowest and the highest displacement code. Integer sources (PGM, PNG) have values of sample /
    /// maxval and range 0..1; floating-point and uint EXR sources keep their values and are quantised over the range of
    /// their finite values. A constant map of the latter kind has range_low == range_high: check before dividing by the
    /// difference.
    double range_low = 0;
    double range_high = 1;

    /// The range that displacement.scale spans, in the unit of `values`: the whole range of the source, unless
    /// map.range is given (input/map/map_range.h).
    double span_low = 0;
    double span_high = 1;

    /// Units of the source per unit of value: PGM's maximum value, 255 or 65535 for PNG, 1 for others. An elevation of
    /// 1533 m in a PGM of maximum value 2478 has the value 0.6186, and 1533 source units.
    double source_units = 1;

    /// Significant bits of the source's values.
    static constexpr int half_bits = 11, float_bits = 24;
    int significant_bits = float_bits;

    /// Texels whose value in the source was no height, in ascending order, and that value: NaN, infinite, or one of
    /// map.no_data. `values` has what they were set to (input/map/no_data.h).
    struct Replaced {
        std::uint32_t texel;
        float was;
    };
    std::vector<Replaced> replaced;

    /// Which values look like missing data, and what to do; empty: none. No full stop.
    std::string no_data_hint;

    /// Repairs and anomalies found while reading, one sentence each without the file's name, for the report ("3 NaN
    /// texels set to ...").
    std::vector<std::string> repairs;

    float& at(int x, int y) {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    float at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }

    /// Lowest and highest value.
    std::array<double, 2> extremes() const {
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        return {static_cast<double>(*low), static_cast<double>(*high)};
    }
};

/// Largest map side in texels (12 integer bits of the texture coordinate).
inline constexpr int largest_map_side = 4096;

}  // namespace tessera

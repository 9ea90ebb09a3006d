#include "testbench/setup/quantised_map.h"

#include <algorithm>
#include <cmath>

namespace tessera {

QuantisedMap quantise_map(const HeightMap& map, int bits, datapath::AddressMode address_u,
                          datapath::AddressMode address_v) {
    QuantisedMap result;
    result.geometry = {static_cast<std::uint32_t>(map.width), static_cast<std::uint32_t>(map.height), address_u,
                       address_v};
    result.bits = bits;
    result.codes.reserve(map.values.size());
    const double range = map.range_high - map.range_low;
    const double highest = result.highest_code();
    for (const float value : map.values) {
        const double part = range > 0 ? (static_cast<double>(value) - map.range_low) / range : 0;
        const double unrounded = std::clamp(part, 0.0, 1.0) * highest, code = std::round(unrounded);
        result.codes.push_back(static_cast<std::uint16_t>(code));
        result.rounding = std::max(result.rounding, std::abs(code - unrounded));
    }
    return result;
}

namespace {

struct Neighbours {
    std::uint32_t before, after;
    double distance;  // in texels; 0: the axis has only one texel
};

Neighbours neighbours(std::uint32_t index, std::uint32_t size, datapath::AddressMode mode) {
    if (size == 1)
        return {0, 0, 0};
    if (mode == datapath::AddressMode::repeat)
        return {index == 0 ? size - 1 : index - 1, index + 1 == size ? 0 : index + 1, 2};
    const std::uint32_t before = index == 0 ? 0 : index - 1;
    const std::uint32_t after = index + 1 == size ? index : index + 1;
    return {before, after, static_cast<double>(after - before)};
}

/// Heights per `size` along u and v.
std::array<double, 2> slopes(const QuantisedMap& map, std::uint32_t x, std::uint32_t y, double height_per_code,
                             const std::array<double, 2>& size) {
    const Neighbours u = neighbours(x, map.geometry.width, map.geometry.address_u);
    const Neighbours v = neighbours(y, map.geometry.height, map.geometry.address_v);
    const auto slope = [&](int difference, double distance, double unit) {
        return distance > 0 ? height_per_code * difference / (distance * unit) : 0;
    };
    return {slope(map.code(u.after, y) - map.code(u.before, y), u.distance, size[0]),
            slope(map.code(x, v.after) - map.code(x, v.before), v.distance, size[1])};
}

}  // namespace

std::array<double, 2> map_rise(const QuantisedMap& map, std::uint32_t x, std::uint32_t y, double height_per_code) {
    return slopes(map, x, y, height_per_code, {1, 1});
}

datapath::Direction map_normal(const QuantisedMap& map, std::uint32_t x, std::uint32_t y, double height_per_code,
                               const std::array<double, 2>& texel_size, const datapath::Format& format) {
    const auto [du, dv] = slopes(map, x, y, height_per_code, texel_size);
    const double length = std::sqrt(du * du + dv * dv + 1);
    const auto component = [&](double value) {
        const double scaled = std::nearbyint(std::ldexp(value / length, format.fraction));
        return static_cast<std::int32_t>(
            std::clamp(scaled, static_cast<double>(format.lowest), static_cast<double>(format.highest)));
    };
    return {component(-du), component(-dv), component(1)};
}

}  // namespace tessera

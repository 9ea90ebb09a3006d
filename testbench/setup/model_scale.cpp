#include "testbench/setup/model_scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "testbench/common/error.h"
#include "testbench/setup/map_displacement.h"
#include "testbench/setup/rounding.h"

namespace tessera {

using datapath::Format;

DisplacementRange displacement_range(const DisplacementSettings& settings, const HeightMap& map) {
    const MapDisplacement displacement = MapDisplacement::from(settings, map);
    return {displacement.of(map.range_low), displacement.scale * (map.range_high - map.range_low)};
}

namespace {

/// The cause of a displacement that is too large by `factor`, and what to do.
std::string cause_of(const DisplacementSettings& settings, const HeightMap& map, const Format& position,
                     double factor) {
    const auto [low, high] = map.extremes();
    const auto source = [&](double value) { return value * map.source_units; };
    const std::string values = fmt::format(
        "The map's values are {:.6g} to {:.6g}, of which displacement.scale = {:.6g} spans {:.6g} to {:.6g}",
        source(low), source(high), settings.scale, source(map.span_low), source(map.span_high));
    if (!map.no_data_hint.empty())
        return fmt::format("{}. {}", values, map.no_data_hint);
    const double span = map.span_high - map.span_low;
    const double beyond = std::max(map.span_low - low, high - map.span_high);
    if (beyond > 8 * span && high > low)
        return fmt::format("{}: set map.range = \"data\"", values);
    const double halvings = std::isfinite(factor) ? std::ceil(std::log2(factor)) : 0;
    const bool far = std::abs(settings.bias) > std::abs(settings.scale);  // the surface is, rather than rough
    const int bits = position.bits + static_cast<int>(std::min(halvings, 64.0));
    return fmt::format("{}: check the map's values{}{}", values,
                       halvings > 0 ? fmt::format(", divide {} by {}", far ? "displacement.bias" : "displacement.scale",
                                                  std::exp2(halvings + 9))
                                    : "",
                       halvings == 0 || bits > datapath::FormatLimits::position_bits.most
                           ? ""
                           : fmt::format(", or set formats.position_bits = {}",
                                         std::max<std::int64_t>(bits, FormatSettings{}.position_bits)));
}

}  // namespace

ModelScale fit_model(const BaseMesh& mesh, const DisplacementSettings& settings, const HeightMap& map,
                     const Format& position, const std::string& map_name) {
    const DisplacementRange displacement = displacement_range(settings, map);
    const auto [low, high] = bounds_of(mesh.vertices);
    ModelScale result;
    result.centre = (low + high) / 2.0;
    const glm::dvec3 half = (high - low) / 2.0;
    const double reach = std::max({half.x, half.y, half.z}) +
                         std::max(std::abs(displacement.bias), std::abs(displacement.bias + displacement.range));
    // S and bias are registers of the same format; S is up to twice the range (bits = 1, see make_displacement)
    const double registers = std::max(2 * std::abs(displacement.range), std::abs(displacement.bias)) / 2;
    const double limit = std::ldexp(1.0, position.bits - position.fraction - 2);
    if (reach > 0 && std::isfinite(reach))
        result.scale = std::ldexp(1.0, static_cast<int>(std::floor(std::log2(limit / std::max(reach, registers)))));
    // with fewer steps across the whole mesh, the surface would be mostly rounding error
    constexpr double fewest_steps = 16;
    const double steps = std::ldexp(std::max({half.x, half.y, half.z}) * result.scale, position.fraction);
    if (!(steps >= fewest_steps) || !std::isfinite(reach)) {
        throw InputError(fmt::format(
            "{}: the displacement, {:.3g} to {:.3g} model units, is so large compared with the mesh (half its size "
            "is {:.3g}) that the mesh spans {:.3g} steps of its position format (at least {} are needed). {}",
            map_name, displacement.bias, displacement.bias + displacement.range, std::max({half.x, half.y, half.z}),
            steps, fewest_steps, cause_of(settings, map, position, fewest_steps / steps)));
    }
    return result;
}

datapath::DisplacementParameters make_displacement(const DisplacementRange& displacement, const ModelScale& model_scale,
                                                   std::uint32_t highest_code, const Format& position,
                                                   std::uint64_t& saturated) {
    // d = code / 2^bits reaches only 1 - 2^-bits; S compensates
    const double codes = static_cast<double>(highest_code);
    const double full = displacement.range * (codes + 1) / codes * model_scale.scale;
    return {to_format(full, position, saturated),
            to_format(displacement.bias * model_scale.scale, position, saturated)};
}

}  // namespace tessera

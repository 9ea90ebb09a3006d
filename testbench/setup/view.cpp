#include "testbench/setup/view.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "testbench/common/error.h"
#include "testbench/setup/rounding.h"
#include "testbench/setup/unit_vector.h"

namespace tessera {

using datapath::Format;

ViewAxes view_axes(const CameraSettings& camera) {
    const auto vector = [](const std::array<double, 3>& a) { return glm::dvec3(a[0], a[1], a[2]); };
    ViewAxes view;
    view.backward = unit_vector(vector(camera.eye) - vector(camera.target));
    view.right = unit_vector(glm::cross(brought_near_one(vector(camera.up)), view.backward));
    view.up = glm::cross(view.backward, view.right);
    return view;
}

double focal_length(const CameraSettings& camera) {
    return static_cast<double>(camera.viewport_height) / 2 / std::tan(camera.field_of_view * glm::pi<double>() / 360);
}

double corner_secant(const CameraSettings& camera) {
    const double half_diagonal =
        std::hypot(static_cast<double>(camera.viewport_width), static_cast<double>(camera.viewport_height)) / 2;
    return std::hypot(1.0, half_diagonal / focal_length(camera));
}

namespace {

/// Throws InputError if Transform's sums cannot hold `offset`, which the eye adds to them, at this distance in world
/// units. A position of fewer bits has larger LSBs: the model is scaled to its format.
void check_eye(double offset, double distance, const ModelScale& model_scale, const Format& position) {
    const double limit = std::ldexp(1.0, 61);
    if (offset <= limit)
        return;
    const int bits = position.bits - static_cast<int>(std::ceil(std::log2(offset / limit)));
    const int least = std::max(datapath::FormatLimits::position_bits.least, position.fraction + 1);
    throw InputError(fmt::format(
        "camera.eye is {:.3g} model units from the mesh's centre, ({:.4g}, {:.4g}, {:.4g}), and Transform's sums hold "
        "eyes in this direction up to {:.3g} away: move camera.eye nearer{}",
        distance / model_scale.scale, model_scale.centre.x, model_scale.centre.y, model_scale.centre.z,
        distance / model_scale.scale * limit / offset,
        bits < least ? "" : fmt::format(", or set formats.position_bits = {}", bits)));
}

}  // namespace

datapath::TransformParameters make_transform(const CameraSettings& camera, const ModelScale& model_scale,
                                             const datapath::Formats& formats, std::uint64_t& saturated) {
    const ViewAxes view = view_axes(camera);
    const glm::dvec3 eye = model_scale.to_world(glm::dvec3(camera.eye[0], camera.eye[1], camera.eye[2]));
    const double width = static_cast<double>(camera.viewport_width);
    const double height = static_cast<double>(camera.viewport_height);
    const double focal = focal_length(camera);
    const glm::dvec3 forward = -view.backward;
    const glm::dvec3 x = focal * view.right + width / 2 * forward;
    const glm::dvec3 y = focal * view.up + height / 2 * forward;
    const auto largest = [](const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };

    datapath::TransformParameters result;
    constexpr int fraction = datapath::TransformParameters::matrix_fraction;
    result.exponent = std::max(0, static_cast<int>(std::ceil(std::log2(std::max(largest(x), largest(y))))));
    const double fewer = std::ldexp(1.0, -result.exponent);
    const auto offset_of = [&](const glm::dvec3& direction, double scale) {
        return std::ldexp(-glm::dot(direction, eye) * scale, fraction + formats.position.fraction);
    };
    check_eye(std::max({std::abs(offset_of(x, fewer)), std::abs(offset_of(y, fewer)), std::abs(offset_of(forward, 1))}),
              glm::length(eye), model_scale, formats.position);
    const auto row = [&](const glm::dvec3& direction, double scale) {
        const double offset = offset_of(direction, scale);
        return std::array<std::int64_t, 4>{
            to_fixed(direction.x * scale, fraction), to_fixed(direction.y * scale, fraction),
            to_fixed(direction.z * scale, fraction), static_cast<std::int64_t>(std::nearbyint(offset))};
    };
    result.row_x = row(x, fewer);
    result.row_y = row(y, fewer);
    result.row_w = row(forward, 1);
    // No w reaches 2^62: everything is behind a near plane there, as with one farther away.
    result.near_plane = static_cast<std::int64_t>(std::min(
        std::ldexp(camera.near_plane * model_scale.scale, fraction + formats.position.fraction), std::ldexp(1.0, 62)));
    for (std::size_t k = 0; formats.distances && k < 3; ++k)
        result.eye[k] = to_fixed(eye[static_cast<glm::length_t>(k)], formats.position.fraction);
    const auto rotation = [&](const glm::dvec3& axis) {
        const datapath::Direction d = to_direction(axis, formats.normal, saturated);
        return std::array<std::int32_t, 3>{d.x, d.y, d.z};
    };
    result.normal_rows = {rotation(view.right), rotation(view.up), rotation(view.backward)};
    return result;
}

Format view_distance_format(const datapath::TransformParameters& transform, const Format& position) {
    const auto size = [](std::int64_t entry) { return std::abs(static_cast<double>(entry)); };
    const auto& row = transform.row_w;
    const double half_range = -static_cast<double>(position.lowest);
    const double farthest = std::ldexp((size(row[0]) + size(row[1]) + size(row[2])) * half_range + size(row[3]),
                                       -datapath::TransformParameters::matrix_fraction);
    int shift = 0;
    while (std::ldexp(farthest, -shift) > static_cast<double>(position.highest))
        ++shift;
    return Format::make_signed(position.bits, position.fraction - shift);
}

double distance_step(const datapath::Formats& formats) {
    return std::ldexp(1.0, -formats.view_distance.fraction);
}

}  // namespace tessera

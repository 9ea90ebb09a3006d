#include "golden/golden_setup.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tessera::golden {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

// The row that yields dot(direction, P' - eye).
glm::dvec4 row_about(const glm::dvec3& eye, const glm::dvec3& direction) {
    return {direction, -glm::dot(direction, eye)};
}

}  // namespace

glm::dvec3 unit(const glm::dvec3& v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest > 0 ? glm::normalize(v / largest) : v;
}

double focal_length(const Camera& camera) {
    return camera.viewport.y / 2 / std::tan(camera.field_of_view / 2 * degree);
}

View make_view(const Camera& camera, const Placement& placement) {
    View view;
    view.eye = placement.to_world(camera.eye);
    view.near_plane = placement.scale * camera.near_plane;
    view.backward = unit(camera.eye - camera.target);
    const glm::dvec3 sideways = glm::cross(unit(camera.up), view.backward);
    view.right = unit(sideways);
    view.up = glm::cross(view.backward, view.right);
    view.rounding = 0x1p-49 / glm::length(sideways);

    // A point at depth w and height y above the view axis appears y / (w tan(half the field of view)) half heights
    // above the viewport's centre. Pixels are square.
    const glm::dvec3 forward = -view.backward;
    const glm::dvec2 centre = camera.viewport / 2.0;
    const double pixels = focal_length(camera);
    view.row_x = row_about(view.eye, centre.x * forward + pixels * view.right);
    view.row_y = row_about(view.eye, centre.y * forward + pixels * view.up);
    view.row_w = row_about(view.eye, forward);
    return view;
}

Parameters make_parameters(const Scene& scene) {
    const View view = make_view(scene.camera, scene.placement);
    Parameters result;
    result.scale = scene.placement.scale * (scene.highest - scene.lowest) / scene.highest_code;
    result.bias = scene.placement.scale * scene.lowest;
    result.normal_threshold = scene.normal_threshold;
    result.eye = view.eye;
    result.view_threshold = scene.view_threshold;
    result.generation_limit = scene.generation_limit;
    // If the light is opposite the viewer, there is no half vector, and no normal lies in the highlight.
    const glm::dvec3 halfway = unit(scene.light) + view.backward;
    result.half_vector = glm::length(halfway) > 1e-9 ? unit(halfway) : glm::dvec3(0);
    result.highlight_cosine = std::cos(scene.highlight_angle * degree);
    result.highlight_normal_threshold = scene.highlight_normal_threshold;
    result.enabled = scene.enabled;
    result.diagonal = scene.diagonal;
    result.filter = scene.filter;
    result.texel_parts = scene.texel_parts;
    result.row_x = view.row_x;
    result.row_y = view.row_y;
    result.row_w = view.row_w;
    result.near_plane = view.near_plane;
    return result;
}

glm::dvec3 light_as_seen(const Scene& scene) {
    const View view = make_view(scene.camera, scene.placement);
    const glm::dvec3 light = unit(scene.light);
    return {glm::dot(light, view.right), glm::dot(light, view.up), glm::dot(light, view.backward)};
}

double code_of(double value, double low, double high, double highest_code) {
    return high > low ? std::clamp((value - low) / (high - low), 0.0, 1.0) * highest_code : 0;
}

namespace {

/// Whether `given`, rounded to the source's precision, is `value`.
bool is_nearest(double given, double value, int significant_bits) {
    const bool half = significant_bits < 24;
    if (std::isinf(value))
        return std::signbit(given) == std::signbit(value) && std::abs(given) >= (half ? 65520 : 0x1.ffffffp127);
    const int lowest_exponent = half ? -14 : -126;
    const int exponent = value == 0 ? lowest_exponent : std::max(std::ilogb(value), lowest_exponent);
    return std::abs(value - given) <= std::ldexp(1.0, exponent - significant_bits);
}

}  // namespace

std::vector<float> heights_of(std::vector<float> values, const MapSource& source) {
    const auto missing = [&](double value) {
        return std::any_of(source.no_data.begin(), source.no_data.end(), [&](double given) {
            return is_nearest(given / source.units, value, source.significant_bits) ||
                   (std::abs(given) >= 1e30 && std::abs(value / given - 1) <= 0.01);
        });
    };
    float low = std::numeric_limits<float>::infinity(), high = -low;
    std::vector<std::size_t> holes, peaks;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const float value = values[k];
        if (missing(static_cast<double>(value)) || std::isnan(value) || (std::isinf(value) && value < 0)) {
            holes.push_back(k);
        } else if (std::isinf(value)) {
            peaks.push_back(k);
        } else {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    for (const std::size_t k : holes)
        values[k] = low;
    for (const std::size_t k : peaks)
        values[k] = high;
    return values;
}

Vertex place_vertex(const Vertex& in_model_units, const glm::dvec2& uv, const Placement& placement, const Map& map,
                    bool beyond_map) {
    const auto texels = [beyond_map](double coordinate, int size, AddressMode mode) {
        return mode == AddressMode::clamp && !beyond_map ? std::clamp(coordinate * size, 0.0, double(size))
                                                         : coordinate * size;
    };
    Vertex result = in_model_units;
    result.position = placement.to_world(in_model_units.position);
    result.texture = {texels(uv.x, map.width(), map.address_u()), texels(uv.y, map.height(), map.address_v())};
    return result;
}

glm::dvec2 on_grid(const glm::dvec2& t, double step) {
    return {std::nearbyint(t.x / step) * step, std::nearbyint(t.y / step) * step};
}

}  // namespace tessera::golden

#include "testbench/render/illumination.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr double golden_angle = 2.39996322972865332;

constexpr std::size_t sky_directions = 64;
constexpr std::size_t key_directions = 64;
constexpr double key_radius = 0.15;  // tangent of the angle to the lamp's edge
// A warm sun and a cool sky, so that shadows differ from the lit side in hue, too.
const glm::dvec3 key_strength(0.80, 0.765, 0.70);
const glm::dvec3 fill_strength(0.13, 0.13, 0.14);
const glm::dvec3 zenith_strength(0.33, 0.36, 0.42);
const glm::dvec3 ground_strength(0.13, 0.12, 0.115);
constexpr double least = 0.035;  // keeps the deepest crevice from being black
constexpr double highlight_strength = 0.10;

/// Least cosine and largest sine, rounded up, of the angle between the first normal of a flat patch and any other.
constexpr double least_cosine = 0.9, largest_sine = 0.44;
static_assert(largest_sine * largest_sine + least_cosine * least_cosine > 1);

double to_the_16th(double x) {
    const double x2 = x * x;
    const double x4 = x2 * x2;
    const double x8 = x4 * x4;
    return x8 * x8;
}

bool is_flat(const std::vector<ShadingPoint>& points) {
    return std::all_of(points.begin(), points.end(), [&](const ShadingPoint& point) {
        return glm::dot(point.normal, points.front().normal) >= least_cosine;
    });
}

}  // namespace

Illumination::Illumination(const View& view, const Style& style, const RayScene& scene)
    : scene_(scene), eye_(view.backward) {
    const auto to_world = [&](const glm::dvec3& v) {
        return glm::normalize(v.x * view.right + v.y * view.up + v.z * view.backward);
    };
    const glm::dvec3 key = to_world(style.key_light);
    fill_ = to_world({0.8, 0.1, 0.6});

    // The sky: a spiral of equal areas over the whole sphere.
    for (std::size_t i = 0; i < sky_directions; ++i) {
        const double height = 1 - (2 * static_cast<double>(i) + 1) / sky_directions;
        const double angle = golden_angle * static_cast<double>(i);
        const double across = std::sqrt(1 - height * height);
        const glm::dvec3 direction = to_world({across * std::cos(angle), height, across * std::sin(angle)});
        const double overhead = height * 0.5 + 0.5;
        const glm::dvec3 radiance = glm::mix(ground_strength, zenith_strength, overhead);
        // 4 pi steradians over the directions, over pi: an even sky of radiance 1 makes a white surface 1.
        constexpr double share = 4.0 * samples_per_pixel / sky_directions;
        lamps_[i % samples_per_pixel].push_back({direction, radiance * share, 0, {}});
    }

    // The key light: a spiral of equal areas over a disc.
    const glm::dvec3 side =
        glm::normalize(glm::cross(std::abs(key.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), key));
    const glm::dvec3 other = glm::cross(key, side);
    constexpr double share = static_cast<double>(samples_per_pixel) / key_directions;
    for (std::size_t i = 0; i < key_directions; ++i) {
        const double radius = key_radius * std::sqrt((static_cast<double>(i) + 0.5) / key_directions);
        const double angle = golden_angle * static_cast<double>(i);
        const glm::dvec3 direction = glm::normalize(key + radius * (std::cos(angle) * side + std::sin(angle) * other));
        lamps_[i % samples_per_pixel].push_back(
            {direction, key_strength * share, highlight_strength * share, glm::normalize(direction + eye_)});
    }
}

/// Traces rays to the lamp; appends the results to scratch.occluded.
void Illumination::trace(const Lamp& lamp, const std::vector<ShadingPoint>& points, std::size_t first, std::size_t end,
                         Scratch& scratch) const {
    scratch.origins.clear();
    for (std::size_t f = first; f < end; ++f)
        scratch.origins.push_back(points[scratch.facing[f]].ray_origin);
    scene_.occlusions(scratch.origins, lamp.direction, scratch.occluded);
}

/// Adds the light common to all points of a flat patch to `even`, the diffuse light as a linear function of the normal.
void Illumination::add(const Lamp& lamp, const std::vector<ShadingPoint>& points, bool flat, glm::dmat3& even,
                       std::vector<Light>& lights, Scratch& scratch) const {
    const double first = glm::dot(points.front().normal, lamp.direction);
    if (flat && first < -largest_sine)
        return;
    std::vector<std::size_t>& facing = scratch.facing;
    std::vector<std::uint8_t>& occluded = scratch.occluded;
    facing.clear();
    occluded.clear();
    const auto keep_facing = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (glm::dot(points[i].normal, lamp.direction) > 0)
                facing.push_back(i);
    };
    const std::size_t probes = flat ? (points.size() + 3) / 4 : points.size();
    keep_facing(0, probes);
    const std::size_t facing_probes = facing.size();
    trace(lamp, points, 0, facing_probes, scratch);
    const auto hidden = static_cast<std::size_t>(std::count(occluded.begin(), occluded.end(), 1));
    if (facing_probes == probes && hidden == probes)
        return;
    const auto add_highlight = [&](std::size_t i) {
        if (lamp.highlight > 0)
            lights[i].highlight += lamp.highlight * to_the_16th(std::max(0.0, glm::dot(points[i].normal, lamp.half)));
    };
    const bool in_sight = facing_probes == probes && hidden == 0;
    if (in_sight && flat && first > largest_sine) {
        even += glm::outerProduct(lamp.diffuse, lamp.direction);
        for (std::size_t i = 0; i < points.size(); ++i)
            add_highlight(i);
        return;
    }
    keep_facing(probes, points.size());
    if (in_sight)
        occluded.resize(facing.size(), 0);
    else
        trace(lamp, points, facing_probes, facing.size(), scratch);
    for (std::size_t f = 0; f < facing.size(); ++f)
        if (!occluded[f]) {
            const std::size_t i = facing[f];
            lights[i].diffuse += lamp.diffuse * glm::dot(points[i].normal, lamp.direction);
            add_highlight(i);
        }
}

void Illumination::light(std::size_t sample, const Patch& patch, std::vector<Light>& lights, Scratch& scratch) const {
    const std::vector<ShadingPoint>& points = patch.points;
    lights.assign(points.size(), Light{});
    if (points.empty())
        return;
    const bool flat = patch.whole && is_flat(points);
    glm::dmat3 even(0);
    for (const Lamp& lamp : lamps_[sample])
        add(lamp, points, flat, even, lights, scratch);
    for (std::size_t i = 0; i < points.size(); ++i)
        lights[i].diffuse +=
            least + fill_strength * std::max(0.0, glm::dot(points[i].normal, fill_)) + even * points[i].normal;
}

}  // namespace tessera

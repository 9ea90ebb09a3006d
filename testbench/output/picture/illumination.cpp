#include "testbench/output/picture/illumination.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr double golden_angle = 2.39996322972865332;

constexpr std::size_t sky_directions = 64;
constexpr std::size_t key_directions = 64;
constexpr double key_radius = 0.15;  // tangent of the angle to the lamp's edge
// A warm sun and a cool sky: shadows differ from the lit side in hue, too.
const glm::dvec3 key_strength(0.80, 0.765, 0.70);
const glm::dvec3 fill_strength(0.13, 0.13, 0.14);
const glm::dvec3 zenith_strength(0.33, 0.36, 0.42);
const glm::dvec3 ground_strength(0.13, 0.12, 0.115);
constexpr double least = 0.035;  // so that the deepest crevice is not black
constexpr double highlight_strength = 0.10;

double to_the_16th(double x) {
    const double x2 = x * x;
    const double x4 = x2 * x2;
    const double x8 = x4 * x4;
    return x8 * x8;
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

/// Appends to scratch.occluded.
void Illumination::trace(const Lamp& lamp, const std::vector<ShadingPoint>& points, std::size_t first, std::size_t end,
                         Scratch& scratch) const {
    scratch.rays.clear();
    for (std::size_t f = first; f < end; ++f)
        scratch.rays.push_back({points[scratch.facing[f]].ray_origin, lamp.direction, 0});
    scene_.occlusions(scratch.rays, scratch.traced);
    scratch.occluded.insert(scratch.occluded.end(), scratch.traced.begin(), scratch.traced.end());
}

void Illumination::add(const Lamp& lamp, const std::vector<ShadingPoint>& points, std::size_t probes,
                       std::vector<Light>& lights, Scratch& scratch) const {
    auto& [rays, facing, traced, occluded] = scratch;
    facing.clear();
    occluded.clear();
    std::size_t facing_probes = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (glm::dot(points[i].normal, lamp.direction) > 0) {
            facing_probes += i < probes;
            facing.push_back(i);
        }
    trace(lamp, points, 0, facing_probes, scratch);
    const auto hidden = static_cast<std::size_t>(std::count(occluded.begin(), occluded.end(), 1));
    if (facing_probes == probes && hidden == probes)
        return;
    if (facing_probes == probes && hidden == 0)
        occluded.resize(facing.size(), 0);
    else
        trace(lamp, points, facing_probes, facing.size(), scratch);
    for (std::size_t f = 0; f < facing.size(); ++f)
        if (!occluded[f]) {
            const glm::dvec3& normal = points[facing[f]].normal;
            Light& light = lights[facing[f]];
            light.diffuse += lamp.diffuse * glm::dot(normal, lamp.direction);
            if (lamp.highlight > 0)
                light.highlight += lamp.highlight * to_the_16th(std::max(0.0, glm::dot(normal, lamp.half)));
        }
}

void Illumination::light(std::size_t sample, const std::vector<ShadingPoint>& points, std::size_t probes,
                         std::vector<Light>& lights, Scratch& scratch) const {
    lights.assign(points.size(), Light{});
    for (std::size_t i = 0; i < points.size(); ++i)
        lights[i].diffuse = least + fill_strength * std::max(0.0, glm::dot(points[i].normal, fill_));
    for (const Lamp& lamp : lamps_[sample])
        add(lamp, points, probes, lights, scratch);
}

}  // namespace tessera

#include "golden/golden_frames.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "golden/golden_setup.h"

namespace tessera::golden {
namespace {

using Corner = std::uint32_t;  // 3 * triangle + k

constexpr double epsilon = 0x1p-49;  // a few operations in double precision

auto order(const glm::dvec3& v) {
    return std::make_tuple(v.x, v.y, v.z);
}

// A number for each point, equal for equal position and normal.
std::vector<std::uint32_t> number_places(const std::vector<BasePoint>& points) {
    const auto key = [&](std::uint32_t i) {
        return std::tuple_cat(order(points[i].position), order(points[i].normal));
    };
    std::vector<std::uint32_t> sorted(points.size()), number(points.size());
    std::iota(sorted.begin(), sorted.end(), 0U);
    std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::uint32_t last = 0;
    for (std::size_t k = 0; k < sorted.size(); ++k) {
        if (k > 0 && key(sorted[k - 1]) != key(sorted[k]))
            ++last;
        number[sorted[k]] = last;
    }
    return number;
}

// One triangle's side at an edge: places, and texture coordinates in multiples of 2^-16, the first end's within one
// period.
struct Side {
    std::uint32_t low, high;
    std::array<double, 4> texture;  // first end, change to the other
    Corner at_low, at_high;
    auto edge() const { return std::tie(low, high, texture); }
};

// Joins corners into classes: each refers to a corner of its class, the representative to itself.
Corner representative(std::vector<Corner>& refers, Corner c) {
    Corner root = c;
    while (refers[root] != root)
        root = refers[root];
    while (refers[c] != root) {
        const Corner next = refers[c];
        refers[c] = root;
        c = next;
    }
    return root;
}

std::vector<Corner> join_corners(const std::vector<BasePoint>& points,
                                 const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const std::vector<std::uint32_t> places = number_places(points);
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            Corner low = k, high = (k + 1) % 3;
            if (places[triangles[t][low]] > places[triangles[t][high]])
                std::swap(low, high);
            const glm::dvec2 a = points[triangles[t][low]].uv, b = points[triangles[t][high]].uv;
            Side side{places[triangles[t][low]], places[triangles[t][high]], {}, 3 * t + low, 3 * t + high};
            for (int axis = 0; axis < 2; ++axis) {
                const double from = std::nearbyint(a[axis] * 65536), to = std::nearbyint(b[axis] * 65536);
                side.texture[static_cast<std::size_t>(axis)] = from - 65536 * std::floor(from / 65536);
                side.texture[static_cast<std::size_t>(axis) + 2] = to - from;
            }
            sides.push_back(side);
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.edge() < b.edge(); });
    std::vector<Corner> refers(sides.size());
    std::iota(refers.begin(), refers.end(), 0U);
    const auto join = [&](Corner a, Corner b) { refers[representative(refers, a)] = representative(refers, b); };
    for (std::size_t s = 1; s < sides.size(); ++s)
        if (sides[s].edge() == sides[s - 1].edge()) {
            join(sides[s].at_low, sides[s - 1].at_low);
            join(sides[s].at_high, sides[s - 1].at_high);
        }
    return refers;
}

// A triangle as a map from texture to space. Errors are relative.
struct Unwrapped {
    bool has_texture = false;
    double texture_area = 0, area = 0, area_error = 0;  // the error times the area
    glm::dvec3 along_u{0}, facing{0};
    double turn_error = 0;  // of along_u's direction
    double length_u = 0, length_v = 0, length_error = 0;
    bool mirrored = false;  // seen from the side that the winding faces
};

Unwrapped unwrap(const BasePoint& a, const BasePoint& b, const BasePoint& c) {
    Unwrapped result;
    const glm::dvec2 st = a.uv - c.uv, sb = b.uv - c.uv;
    const glm::dvec3 p = a.position - c.position, q = b.position - c.position;
    const glm::dvec2 third = b.uv - a.uv;
    const double largest = std::max(
        {std::abs(st.x), std::abs(st.y), std::abs(sb.x), std::abs(sb.y), std::abs(third.x), std::abs(third.y)});
    const double determinant = st.x * sb.y - st.y * sb.x;
    if (!(largest > 0) || !(std::abs(st.x / largest * (sb.y / largest) - st.y / largest * (sb.x / largest)) > 1e-12))
        return result;
    // Along u: v does not change.
    const glm::dvec3 step_u = p * sb.y - q * st.y, step_v = q * st.x - p * sb.x;
    result.length_u = glm::length(step_u) / std::abs(determinant);
    result.length_v = glm::length(step_v) / std::abs(determinant);
    if (!std::isfinite(result.length_u + result.length_v))
        return result;
    result.has_texture = true;
    result.texture_area = std::abs(determinant) / 2;
    result.mirrored = determinant < 0;
    const double sizes = glm::length(p) * glm::length(q);
    const glm::dvec3 doubled = glm::cross(p, q);
    result.facing = unit(doubled);
    result.area = glm::length(doubled) / 2;
    result.area_error = epsilon * sizes;
    result.along_u = unit(step_u * (determinant < 0 ? -1.0 : 1.0));
    const auto error = [&](double x, double y, const glm::dvec3& step) {
        const double length = glm::length(step);
        return length > 0 ? epsilon * (glm::length(p) * std::abs(x) + glm::length(q) * std::abs(y)) / length : 0;
    };
    result.turn_error = error(sb.y, st.y, step_u);
    result.length_error = std::max(result.turn_error, error(sb.x, st.x, step_v)) +
                          epsilon * (std::abs(st.x * sb.y) + std::abs(st.y * sb.x)) / std::abs(determinant);
    return result;
}

struct Sum {
    glm::dvec3 direction{0};
    double area = 0, error = 0;
    void add(const Unwrapped& triangle) {
        direction += triangle.area * triangle.along_u;
        area += triangle.area;
        error += triangle.area * triangle.turn_error + triangle.area_error + epsilon * area;
    }
};

Frame make_frame(const Sum& straight, const Sum& mirrored, const glm::dvec3& normal) {
    Frame frame;
    if (std::min(straight.area, mirrored.area) > 0.06 * (straight.area + mirrored.area))
        return frame;
    const Sum& sum = mirrored.area > straight.area ? mirrored : straight;
    frame.handedness = &sum == &mirrored ? -1 : 1;
    const glm::dvec3 in_plane = sum.direction - glm::dot(normal, sum.direction) * normal;
    const double length = glm::length(in_plane);
    if (!(length > 1e-6 * sum.area))
        return frame;
    frame.tangent = unit(in_plane);
    frame.rounding = (sum.error + epsilon * sum.area) / length;
    return frame;
}

}  // namespace

BaseFrames derive_frames(const std::vector<BasePoint>& points,
                         const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    std::vector<Corner> classes = join_corners(points, triangles);
    std::vector<std::array<Sum, 2>> sums(classes.size());
    std::vector<Unwrapped> unwrapped;
    unwrapped.reserve(triangles.size());
    long double surface = 0, texture = 0;
    for (const auto& [a, b, c] : triangles) {
        unwrapped.push_back(unwrap(points[a], points[b], points[c]));
        if (unwrapped.back().has_texture) {
            surface += unwrapped.back().area;
            texture += unwrapped.back().texture_area;
        }
    }
    glm::dvec2 lengths(0), errors(0);
    double area = 0;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        const Unwrapped& triangle = unwrapped[t];
        if (!triangle.has_texture)
            continue;
        const bool turned = glm::dot(triangle.facing, points[a].normal + points[b].normal + points[c].normal) < -1e-6;
        for (std::uint32_t k = 0; k < 3; ++k) {
            sums[representative(classes, 3 * t + k)][triangle.mirrored != turned ? 1 : 0].add(triangle);
        }
        // A sliver in the map says nothing of a texel's size.
        if (triangle.texture_area / texture < 1e-4L * triangle.area / surface)
            continue;
        const glm::dvec2 its(triangle.length_u, triangle.length_v);
        lengths += triangle.area * its;
        area += triangle.area;
        errors += (triangle.area * triangle.length_error + 2 * triangle.area_error) * its;
    }
    BaseFrames result;
    if (area > 0) {
        result.size = lengths / area;
        const glm::dvec2 relative = errors / lengths;
        result.size_rounding = std::max(relative.x, relative.y) + epsilon * static_cast<double>(triangles.size());
    }
    result.corners.resize(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const auto& [straight, mirrored] = sums[representative(classes, 3 * t + k)];
            result.corners[t][k] = make_frame(straight, mirrored, points[triangles[t][k]].normal);
        }
    return result;
}

}  // namespace tessera::golden

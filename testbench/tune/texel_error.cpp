#include "testbench/tune/texel_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera {

namespace {

/// Texture coordinates in half units of their format, in which a texel's centre is an integer.
struct Point {
    std::int64_t u = 0, v = 0;
};

/// Twice the signed area of (a, b, p): positive if p lies to the left.
std::int64_t side(const Point& a, const Point& b, const Point& p) {
    return (b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u);
}

/// Of two triangles at an edge, one owns the points on it: the one below or, at a horizontal edge, to the left.
bool owns(const Point& a, const Point& b) {
    return b.v < a.v || (b.v == a.v && b.u > a.u);
}

}  // namespace

TexelError::TexelError(const MachineSetup& setup, const HeightMap& map, const DisplacementOf& displacement)
    : setup_(setup),
      map_(map),
      displacement_(displacement),
      units_{setup.registers.formats, setup.registers.map, setup.model_scale.scale, setup.model_scale.centre} {
    bases_.reserve(setup.base_triangles.size());
    for (const datapath::Triangle& triangle : setup.base_triangles)
        bases_.push_back(make_base(triangle));
}

TexelError::Base TexelError::make_base(const datapath::Triangle& triangle) const {
    const double texel = std::ldexp(1.0, -setup_.registers.formats.texture.fraction);
    std::array<glm::dvec2, 3> t;
    std::array<glm::dvec3, 3> p, n;
    for (std::size_t k = 0; k < 3; ++k) {
        const datapath::Vertex& v = triangle.vertices[k];
        t[k] = glm::dvec2(v.texture.u, v.texture.v) * texel;
        p[k] = units_.position(v.position);
        n[k] = glm::dvec3(v.normal.x, v.normal.y, v.normal.z);
        const double length = glm::length(n[k]);
        n[k] = length > 0 ? n[k] / length : glm::dvec3(0);
    }
    Base base;
    const glm::dvec2 b = t[1] - t[0], c = t[2] - t[0];
    const double area = b.x * c.y - b.y * c.x;
    if (area == 0)
        return base;
    base.weight = glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / std::abs(area);
    const auto gradient = [&](const std::array<glm::dvec3, 3>& at, glm::dvec3& origin, glm::dvec3& along_u,
                              glm::dvec3& along_v) {
        const glm::dvec3 to_b = at[1] - at[0], to_c = at[2] - at[0];
        along_u = (c.y * to_b - b.y * to_c) / area;
        along_v = (b.x * to_c - c.x * to_b) / area;
        origin = at[0] - t[0].x * along_u - t[0].y * along_v;
    };
    gradient(p, base.position, base.position_u, base.position_v);
    gradient(n, base.normal, base.normal_u, base.normal_v);
    base.flat = n[0] == n[1] && n[1] == n[2];
    if (base.flat)
        base.normal = n[0];
    return base;
}

TexelError::Sum TexelError::of(const std::array<const datapath::Vertex*, 3>& corners, std::uint32_t base_number) const {
    Sum sum;
    const Base& base = bases_[base_number];
    if (base.weight == 0)
        return sum;
    std::array<Point, 3> t;
    std::array<glm::dvec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
        t[k] = {2 * std::int64_t{corners[k]->texture.u}, 2 * std::int64_t{corners[k]->texture.v}};
        p[k] = units_.position(corners[k]->displaced);
    }
    std::int64_t area = side(t[0], t[1], t[2]);
    if (area == 0)
        return sum;
    if (area < 0) {
        area = -area;
        std::swap(t[1], t[2]);
        std::swap(p[1], p[2]);
    }
    const int shift = setup_.registers.formats.texture.fraction + 1;
    const std::int64_t texel = std::int64_t{1} << shift, half = texel / 2;
    const auto [low_u, high_u] = std::minmax({t[0].u, t[1].u, t[2].u});
    const auto [low_v, high_v] = std::minmax({t[0].v, t[1].v, t[2].v});
    // an edge's owner has points with side >= 0, the other with side > 0
    const std::int64_t least_0 = owns(t[1], t[2]) ? 0 : 1, least_1 = owns(t[2], t[0]) ? 0 : 1,
                       least_2 = owns(t[0], t[1]) ? 0 : 1;
    const std::int64_t step_0 = -(t[2].v - t[1].v) * texel, step_1 = -(t[0].v - t[2].v) * texel,
                       step_2 = -(t[1].v - t[0].v) * texel;
    const double scale = 1 / static_cast<double>(area);
    const auto inside = [](std::int64_t last, int size, Addressing address) {
        return address == Addressing::clamp ? std::min<std::int64_t>(last, size - 1) : last;
    };
    const std::int64_t first_u = (low_u + half - 1) >> shift;
    const std::int64_t last_u = inside((high_u - half) >> shift, map_.width, displacement_.address_u);
    const std::int64_t last_v = inside((high_v - half) >> shift, map_.height, displacement_.address_v);
    for (std::int64_t y = (low_v + half - 1) >> shift; y <= last_v; ++y) {
        const Point start{(first_u << shift) + half, (y << shift) + half};
        std::int64_t w0 = side(t[1], t[2], start), w1 = side(t[2], t[0], start), w2 = side(t[0], t[1], start);
        const int row = static_cast<int>(addressed(y, map_.height, displacement_.address_v));
        for (std::int64_t x = first_u; x <= last_u; ++x, w0 += step_0, w1 += step_1, w2 += step_2) {
            if (w0 < least_0 || w1 < least_1 || w2 < least_2)
                continue;
            const glm::dvec3 mesh =
                (static_cast<double>(w0) * p[0] + static_cast<double>(w1) * p[1] + static_cast<double>(w2) * p[2]) *
                scale;
            const double u = static_cast<double>(x) + 0.5, v = static_cast<double>(y) + 0.5;
            glm::dvec3 normal = base.normal;
            if (!base.flat) {
                normal += u * base.normal_u + v * base.normal_v;
                const double length = glm::length(normal);
                normal = length > 0 ? normal / length : glm::dvec3(0);
            }
            const int column = static_cast<int>(addressed(x, map_.width, displacement_.address_u));
            const glm::dvec3 wanted = base.position + u * base.position_u + v * base.position_v +
                                      displacement_.of(static_cast<double>(map_.at(column, row))) * normal;
            const glm::dvec3 off = mesh - wanted;
            const double squared = glm::dot(off, off);
            sum.squares += base.weight * squared;
            sum.weight += base.weight;
            sum.max = std::max(sum.max, squared);
        }
    }
    sum.max = std::sqrt(sum.max);
    return sum;
}

}  // namespace tessera

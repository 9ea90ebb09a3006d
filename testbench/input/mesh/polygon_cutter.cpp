#include "testbench/input/mesh/polygon_cutter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera {
namespace {

constexpr std::size_t most_checked_for_crossing = 256;
constexpr std::size_t most_fanned = 8;
constexpr double nonplanar_part = 0.05;  // quads of a curved surface usually bend less
constexpr double on_line = 1e-14;        // relative to the polygon's squared size

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// +1 if the outline turns left at b, -1 if right, 0 if it is straight, reverses, or a point repeats.
int turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const glm::dvec2 ab = b - a, bc = c - b;
    const double twice_area = cross(ab, bc);
    const double flat = flattest_triangle * std::max(glm::dot(ab, ab), glm::dot(bc, bc));
    return twice_area > flat ? 1 : twice_area < -flat ? -1 : 0;
}

bool in_or_on(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return cross(b - a, p - a) >= -on_line && cross(c - b, p - b) >= -on_line && cross(a - c, p - c) >= -on_line;
}

/// Whether the outline has left turns only and winds once: a pentagram has left turns only, but winds twice.
bool strictly_convex(const std::vector<glm::dvec2>& points) {
    const std::size_t n = points.size();
    int reversals = 0;
    bool right = false, known = false;
    for (std::size_t i = 0; i <= n; ++i) {
        const glm::dvec2& a = points[i % n];
        const glm::dvec2& b = points[(i + 1) % n];
        if (turn(a, b, points[(i + 2) % n]) <= 0)
            return false;
        if (b.x != a.x) {
            reversals += known && right != (b.x > a.x);
            right = b.x > a.x;
            known = true;
        }
    }
    return reversals <= 2;
}

/// Twice the vector area (Newell); its direction is the mean normal given by the winding.
glm::dvec3 vector_area(const std::vector<glm::dvec3>& points) {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < points.size(); ++i)
        sum += glm::cross(points[i], points[(i + 1) % points.size()]);
    return sum;
}

void fan(const std::vector<std::uint32_t>& corners, PolygonCut& result) {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        result.triangles.push_back({corners[0], corners[i], corners[i + 1]});
}

/// Cuts off every second corner, round by round, until few enough remain for a fan. A fan of thousands of triangles has
/// slivers with overlapping bounding boxes, and box searches would take quadratic time.
void cut_convex(std::vector<std::uint32_t> corners, PolygonCut& result) {
    while (corners.size() > most_fanned) {
        std::vector<std::uint32_t> left;
        const std::size_t n = corners.size();
        for (std::size_t i = 0; i < n; i += 2) {
            left.push_back(corners[i]);
            if (i + 1 < n)
                result.triangles.push_back({corners[i], corners[i + 1], corners[(i + 2) % n]});
        }
        corners = std::move(left);
    }
    fan(corners, result);
}

bool outline_crosses_itself(const std::vector<glm::dvec2>& points) {
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 2; j < n && (i > 0 || j + 1 < n); ++j) {
            const glm::dvec2 &a = points[i], &b = points[(i + 1) % n], &c = points[j], &d = points[(j + 1) % n];
            if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0)
                return true;
        }
    }
    return false;
}

/// Clips ears of `outline` until three corners or no ears remain. False if the work limit is reached.
bool clip_ears(const std::vector<glm::dvec2>& points, std::vector<std::uint32_t> outline, PolygonCut& result,
               std::uint64_t& work_left) {
    // Only a corner that does not turn left can lie in an ear.
    std::vector<bool> blocks(points.size());
    const auto around = [&](std::size_t k) {
        const std::size_t n = outline.size();
        return std::array<std::uint32_t, 3>{outline[(k + n - 1) % n], outline[k % n], outline[(k + 1) % n]};
    };
    const auto classify = [&](std::size_t k) {
        const auto [a, b, c] = around(k);
        blocks[b] = turn(points[a], points[b], points[c]) <= 0;
    };
    for (std::size_t k = 0; k < outline.size(); ++k)
        classify(k);
    std::uint64_t work = 0;
    const auto is_ear = [&](const std::array<std::uint32_t, 3>& t) {
        const glm::dvec2 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
        // in_or_on() accepts any point if the triangle is far smaller than the polygon.
        const double left = std::min({a.x, b.x, c.x}), right = std::max({a.x, b.x, c.x});
        return !blocks[t[1]] && std::none_of(outline.begin(), outline.end(), [&](std::uint32_t i) {
            const glm::dvec2& p = points[i];
            work += blocks[i];
            return blocks[i] && p.x >= left && p.x <= right && p != a && p != b && p != c && in_or_on(p, a, b, c);
        });
    };
    std::size_t at = 0;
    for (std::size_t tried = 0; outline.size() > 3 && tried < outline.size();) {
        if (++work > work_left)
            return false;
        const std::array<std::uint32_t, 3> triangle = around(at);
        if (!is_ear(triangle)) {
            at = (at + 1) % outline.size();
            ++tried;
            continue;
        }
        result.triangles.push_back(triangle);
        outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(at));
        classify((at + outline.size() - 1) % outline.size());
        classify(at % outline.size());
        tried = 0;
        at = (at + 1) % outline.size();  // skip one corner: adjacent ears make slivers
    }
    work_left -= std::min(work, work_left);
    std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(at), outline.end());
    result.crosses_itself |= outline.size() > 3 || turn(points[outline[0]], points[outline[1]], points[outline[2]]) < 0;
    fan(outline, result);
    return true;
}

}  // namespace

std::optional<PolygonCut> cut_polygon(const std::vector<glm::dvec3>& corners, std::uint64_t& work_left) {
    PolygonCut result;
    const std::size_t n = corners.size();
    std::vector<std::uint32_t> outline(n);
    std::iota(outline.begin(), outline.end(), 0u);
    if (n == 3) {
        fan(outline, result);
        return result;
    }
    double size = 0;
    for (const glm::dvec3& p : corners) {
        const glm::dvec3 d = p - corners[0];
        size = std::max({size, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    }
    std::vector<glm::dvec3> local(n);
    glm::dvec3 centre(0);
    for (std::size_t i = 0; i < n; ++i) {
        local[i] = size > 0 ? (corners[i] - corners[0]) / size : glm::dvec3(0);
        centre += local[i] / static_cast<double>(n);
    }
    const glm::dvec3 area = vector_area(local);
    if (!(safe_length(area) > flattest_triangle)) {  // a bow tie whose halves cancel, or collinear points
        fan(outline, result);
        for (const auto& t : result.triangles)
            result.crosses_itself |= triangle_normal(corners[t[0]], corners[t[1]], corners[t[2]]) != glm::dvec3(0);
        return result;
    }
    const glm::dvec3 normal = unit_or_zero(area);
    int axis = 2;
    for (int k = 0; k < 2; ++k)
        if (std::abs(normal[k]) > std::abs(normal[axis]))
            axis = k;
    const int first = (axis + 1) % 3, second = (axis + 2) % 3;
    std::vector<glm::dvec2> points;
    for (const glm::dvec3& p : local) {
        result.nonplanar |= std::abs(glm::dot(normal, p - centre)) > nonplanar_part;
        points.push_back(normal[axis] > 0 ? glm::dvec2(p[first], p[second]) : glm::dvec2(p[second], p[first]));
    }
    if (strictly_convex(points)) {
        cut_convex(outline, result);
        return result;
    }
    if (n <= most_checked_for_crossing) {
        if (work_left < n * n)
            return std::nullopt;
        work_left -= n * n;
        result.crosses_itself = outline_crosses_itself(points);
    }
    if (!clip_ears(points, outline, result, work_left))
        return std::nullopt;
    return result;
}

}  // namespace tessera

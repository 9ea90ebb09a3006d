#include "testbench/meshes/polygon_cutter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "testbench/meshes/triangle_geometry.h"

namespace tessera {
namespace {

constexpr std::size_t most_checked_for_crossing = 256;
constexpr std::size_t most_fanned = 8;
constexpr double nonplanar_part = 0.05;  // quads of a curved surface are bent by less as a rule
constexpr double on_line = 1e-14;        // of the polygon's squared size

double cross(glm::dvec2 const& a, glm::dvec2 const& b) {
    return a.x * b.y - a.y * b.x;
}

/// +1 where the outline turns left at b, -1 right, 0 straight on, back, or nowhere.
int turn(glm::dvec2 const& a, glm::dvec2 const& b, glm::dvec2 const& c) {
    const glm::dvec2 ab = b - a, bc = c - b;
    const double twice_area = cross(ab, bc);
    const double flat = flattest_triangle * std::max(glm::dot(ab, ab), glm::dot(bc, bc));
    return twice_area > flat ? 1 : twice_area < -flat ? -1 : 0;
}

bool in_or_on(glm::dvec2 const& p, glm::dvec2 const& a, glm::dvec2 const& b, glm::dvec2 const& c) {
    return cross(b - a, p - a) >= -on_line && cross(c - b, p - b) >= -on_line &&
           cross(a - c, p - c) >= -on_line;
}

/// Left turns only, and once around: a pentagram turns left only, but twice around.
bool strictly_convex(std::vector<glm::dvec2> const& points) {
    const std::size_t n = points.size();
    int reversals = 0;
    bool right = false, known = false;
    for (std::size_t i = 0; i <= n; ++i) {
        glm::dvec2 const& a = points[i % n];
        glm::dvec2 const& b = points[(i + 1) % n];
        if (turn(a, b, points[(i + 2) % n]) <= 0) {
            return false;
        }
        if (b.x != a.x) {
            reversals += known && right != (b.x > a.x);
            right = b.x > a.x;
            known = true;
        }
    }
    return reversals <= 2;
}

/// Twice the vector area (Newell): its direction is the mean normal by the winding.
glm::dvec3 vector_area(std::vector<glm::dvec3> const& points) {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        sum += glm::cross(points[i], points[(i + 1) % points.size()]);
    }
    return sum;
}

void fan(std::vector<std::uint32_t> const& corners, PolygonCutter::Cut& result) {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        result.triangles.push_back({corners[0], corners[i], corners[i + 1]});
    }
}

/// Cuts off every second corner, round by round, until few enough are left for a fan. A fan of thousands would be
/// slivers that all lie in one another's boxes: what searches the mesh by boxes would take quadratic time.
void cut_convex(std::vector<std::uint32_t> corners, PolygonCutter::Cut& result) {
    while (corners.size() > most_fanned) {
        std::vector<std::uint32_t> left;
        const std::size_t n = corners.size();
        for (std::size_t i = 0; i < n; i += 2) {
            left.push_back(corners[i]);
            if (i + 1 < n) {
                result.triangles.push_back({corners[i], corners[i + 1], corners[(i + 2) % n]});
            }
        }
        corners = std::move(left);
    }
    fan(corners, result);
}

std::vector<std::uint32_t> numbers_up_to(std::size_t n) {
    std::vector<std::uint32_t> numbers(n);
    for (std::size_t i = 0; i < n; ++i) {
        numbers[i] = static_cast<std::uint32_t>(i);
    }
    return numbers;
}

}  // namespace

bool PolygonCutter::spend(std::uint64_t work) {
    const bool enough = work <= work_left_;
    work_left_ -= std::min(work, work_left_);
    return enough;
}

bool PolygonCutter::crosses_itself(std::vector<glm::dvec2> const& points) {
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 2; j < n && (i > 0 || j + 1 < n); ++j) {
            glm::dvec2 const& a = points[i];
            glm::dvec2 const& b = points[(i + 1) % n];
            glm::dvec2 const& c = points[j];
            glm::dvec2 const& d = points[(j + 1) % n];
            if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0) {
                return true;
            }
        }
    }
    return false;
}

void PolygonCutter::clip_ears(std::vector<glm::dvec2> const& points, Cut& result) {
    const auto n = static_cast<std::uint32_t>(points.size());
    std::vector<std::uint32_t> next(n), previous(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        next[i] = (i + 1) % n;
        previous[(i + 1) % n] = i;
    }
    // only a corner that does not turn left can lie in an ear
    constexpr std::uint32_t absent = UINT32_MAX;
    std::vector<std::uint32_t> blockers, place(n, absent);
    auto classify = [&](std::uint32_t i, bool in_outline) {
        const bool blocks = in_outline && turn(points[previous[i]], points[i], points[next[i]]) <= 0;
        if (blocks && place[i] == absent) {
            place[i] = static_cast<std::uint32_t>(blockers.size());
            blockers.push_back(i);
        } else if (!blocks && place[i] != absent) {
            place[blockers.back()] = place[i];
            blockers[place[i]] = blockers.back();
            blockers.pop_back();
            place[i] = absent;
        }
    };
    for (std::uint32_t i = 0; i < n; ++i) {
        classify(i, true);
    }
    std::uint64_t work = 0;
    auto is_ear = [&](std::uint32_t i) {
        glm::dvec2 const& a = points[previous[i]];
        glm::dvec2 const& b = points[i];
        glm::dvec2 const& c = points[next[i]];
        if (place[i] != absent || turn(a, b, c) <= 0) {
            return false;
        }
        const double left = std::min({a.x, b.x, c.x}), right = std::max({a.x, b.x, c.x});
        for (std::size_t k = 0; k < blockers.size(); ++k) {
            glm::dvec2 const& p = points[blockers[k]];
            if (p.x >= left && p.x <= right && p != a && p != b && p != c && in_or_on(p, a, b, c)) {
                work += k;
                return false;
            }
        }
        work += blockers.size();
        return true;
    };

    std::uint32_t remaining = n, at = 0, tried = 0;
    while (remaining > 3 && tried < remaining) {
        const bool ear = is_ear(at);
        if (!spend(work + 1)) {
            result.out_of_work = true;
            return;
        }
        work = 0;
        if (!ear) {
            at = next[at];
            ++tried;
            continue;
        }
        const std::uint32_t a = previous[at], c = next[at];
        result.triangles.push_back({a, at, c});
        next[a] = c;
        previous[c] = a;
        classify(at, false);
        classify(a, true);
        classify(c, true);
        --remaining;
        tried = 0;
        at = next[c];  // not c: ears cut side by side make slivers
    }
    std::vector<std::uint32_t> rest;
    for (std::uint32_t i = 0; i < remaining; ++i) {
        rest.push_back(at);
        at = next[at];
    }
    if (remaining > 3 || turn(points[rest[0]], points[rest[1]], points[rest[2]]) < 0) {
        result.crosses_itself = true;
    }
    fan(rest, result);
}

PolygonCutter::Cut PolygonCutter::cut(std::vector<glm::dvec3> const& corners) {
    Cut result;
    const std::size_t n = corners.size();
    result.triangles.reserve(n - 2);
    if (n == 3) {
        result.triangles.push_back({0, 1, 2});
        return result;
    }
    double size = 0;
    for (glm::dvec3 const& p : corners) {
        const glm::dvec3 d = p - corners[0];
        size = std::max({size, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    }
    if (!(size > 0)) {
        fan(numbers_up_to(n), result);
        return result;
    }
    std::vector<glm::dvec3> local(n);
    for (std::size_t i = 0; i < n; ++i) {
        local[i] = (corners[i] - corners[0]) / size;
    }
    const glm::dvec3 area = vector_area(local);
    if (!(safe_length(area) > flattest_triangle)) {  // a bow tie whose halves cancel, or all on one line
        fan(numbers_up_to(n), result);
        for (auto const& t : result.triangles) {
            result.crosses_itself |=
                triangle_normal(corners[t[0]], corners[t[1]], corners[t[2]]) != glm::dvec3(0);
        }
        return result;
    }
    const glm::dvec3 normal = unit_or_zero(area);
    glm::dvec3 centre(0);
    for (glm::dvec3 const& p : local) {
        centre += p / static_cast<double>(n);
    }
    for (glm::dvec3 const& p : local) {
        result.nonplanar |= std::abs(glm::dot(normal, p - centre)) > nonplanar_part;
    }

    int axis = 2;
    for (int k = 0; k < 2; ++k) {
        if (std::abs(normal[k]) > std::abs(normal[axis])) {
            axis = k;
        }
    }
    const int first = (axis + 1) % 3, second = (axis + 2) % 3;
    std::vector<glm::dvec2> points(n);
    for (std::size_t i = 0; i < n; ++i) {
        points[i] = normal[axis] > 0 ? glm::dvec2(local[i][first], local[i][second])
                                     : glm::dvec2(local[i][second], local[i][first]);
    }
    if (strictly_convex(points)) {
        cut_convex(numbers_up_to(n), result);
        return result;
    }
    if (n <= most_checked_for_crossing) {
        if (!spend(n * n)) {
            result.out_of_work = true;
            return result;
        }
        result.crosses_itself = crosses_itself(points);
    }
    clip_ears(points, result);
    return result;
}

}  // namespace tessera

#include "testbench/geometry/nearest_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera {
namespace {

// The box of a triangle at an angle to the axes has about ten times its area, that of a long thin one far more.
constexpr double least_thin = 16, most_thin = 4096;
constexpr unsigned most_halvings = 5;

// Heights over the longest edge, relative to its length. Below thin_height barycentric coordinates are too inaccurate;
// below least_height the plane is undefined and a triangle is treated as its edges.
constexpr double thin_height = 1e-3, least_height = 1e-8;

using Corners = std::array<glm::dvec3, 3>;

/// Limit on the number of boxes: with many triangles memory matters more than time.
std::size_t most_parts(std::size_t triangles) {
    constexpr std::size_t many = 1'000'000;
    return triangles < many ? 8 * triangles : 2 * triangles;
}

/// Halves a triangle at its longest edge.
std::array<Corners, 2> halves(const Corners& triangle) {
    const auto& [a, b, c] = triangle;
    const auto squared = [](const glm::dvec3& edge) { return glm::dot(edge, edge); };
    const auto halve = [](const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& opposite) {
        const glm::dvec3 middle = from / 2.0 + to / 2.0;
        return std::array<Corners, 2>{{{from, middle, opposite}, {middle, to, opposite}}};
    };
    const double ab = squared(b - a), bc = squared(c - b), ca = squared(a - c);
    if (ab >= bc && ab >= ca)
        return halve(a, b, c);
    return bc >= ca ? halve(b, c, a) : halve(c, a, b);
}

/// Calls at(path) for the parts of a triangle, halved until each part's box has at most `thin` times its area. A path
/// is a 1 followed by one bit per halving, the first halving first: 1 for the second half.
template <class At>
void for_each_part(const Corners& triangle, double thin, unsigned path, const At& at) {
    const BoxHierarchy::Box box = BoxHierarchy::Box::about(triangle);
    const glm::dvec3 side = box.high - box.low;
    const double surface = 2 * (side.x * side.y + side.y * side.z + side.z * side.x);
    const double area = glm::length(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0])) / 2;
    if (path >> most_halvings != 0 || !(surface > thin * area)) {
        at(path);
        return;
    }
    const std::array<Corners, 2> half = halves(triangle);
    for (unsigned k = 0; k < 2; ++k)
        for_each_part(half[k], thin, 2 * path + k, at);
}

BoxHierarchy::Box box_of_part(Corners triangle, unsigned path) {
    if (path == 1)
        return BoxHierarchy::Box::about(triangle);
    unsigned bit = most_halvings;
    while (path >> bit == 0)
        --bit;
    while (bit-- > 0)
        triangle = halves(triangle)[path >> bit & 1];
    BoxHierarchy::Box box = BoxHierarchy::Box::about(triangle);
    const glm::dvec3 rounding = 0x1p-50 * glm::max(glm::abs(box.low), glm::abs(box.high));  // of new corners
    box.low -= rounding;
    box.high += rounding;
    return box;
}

glm::dvec3 closest_point_of_edge(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p) {
    const glm::dvec3 ab = b - a;
    const double squared = glm::dot(ab, ab);
    return squared > 0 ? a + std::clamp(glm::dot(ab, p - a) / squared, 0.0, 1.0) * ab : a;
}

/// Uses axes along and across the longest edge, ab: barycentric coordinates lose all accuracy if ab and ac are nearly
/// parallel.
glm::dvec3 closest_point_of_thin(const Corners& triangle, const glm::dvec3& p) {
    const auto& [a, b, c] = triangle;
    const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
    const double length = glm::length(ab);
    const glm::dvec3 along = ab / length;
    const double c_along = glm::dot(along, ac);
    glm::dvec3 across = ac - c_along * along;
    const double height = glm::length(across);
    if (height > least_height * length) {
        across /= height;
        const double x = glm::dot(along, ap), y = glm::dot(across, ap);
        const double left = c_along * (y / height), right = length + (c_along - length) * (y / height);
        if (y >= 0 && y <= height && x >= left && x <= right)
            return a + x * along + y * across;
    }
    glm::dvec3 nearest = closest_point_of_edge(a, b, p);
    for (const glm::dvec3& other : {closest_point_of_edge(b, c, p), closest_point_of_edge(c, a, p)})
        if (glm::dot(other - p, other - p) < glm::dot(nearest - p, nearest - p))
            nearest = other;
    return nearest;
}

}  // namespace

// Ericson, Real-Time Collision Detection, 5.1.5: finds the Voronoi region (corner, edge or face) that contains p.
glm::dvec3 closest_point(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& p) {
    const auto& [a, b, c] = triangle;
    const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0)
        return a;
    const glm::dvec3 bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3)
        return b;
    const glm::dvec3 cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6)
        return c;
    const glm::dvec3 bc = c - b, normal = glm::cross(ab, ac);
    const double ab2 = glm::dot(ab, ab), bc2 = glm::dot(bc, bc), ca2 = glm::dot(ac, ac);
    const double longest = std::max({ab2, bc2, ca2});
    if (!(glm::dot(normal, normal) > thin_height * thin_height * longest * longest)) {
        if (ab2 == longest)
            return closest_point_of_thin({a, b, c}, p);
        return bc2 == longest ? closest_point_of_thin({b, c, a}, p) : closest_point_of_thin({c, a, b}, p);
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3)
        return a + d1 / (d1 - d3) * ab;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6)
        return a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    const double to_c = d4 - d3, to_b = d5 - d6;
    if (va <= 0 && to_c >= 0 && to_b >= 0 && to_c + to_b > 0)
        return b + to_c / (to_c + to_b) * bc;
    const double sum = va + vb + vc;
    if (!(sum > 0))
        return a;
    return a + vb / sum * ab + vc / sum * ac;
}

std::vector<NearestTriangle::Part> NearestTriangle::cut(const TriangleSoup& soup) {
    double thin = least_thin;
    std::size_t count = 0;
    for (;; thin *= 2) {
        if (thin > most_thin)  // most triangles have no area, and halving them does not help
            thin = std::numeric_limits<double>::infinity();
        count = 0;
        for (std::size_t k = 0; k < soup.size(); ++k)
            for_each_part(soup[k], thin, 1, [&](unsigned) { ++count; });
        if (count <= most_parts(soup.size()))
            break;
    }
    std::vector<Part> parts;
    parts.reserve(count);
    for (std::size_t k = 0; k < soup.size(); ++k)
        for_each_part(soup[k], thin, 1, [&](unsigned path) { parts.push_back({static_cast<std::uint32_t>(k), path}); });
    return parts;
}

NearestTriangle::NearestTriangle(const TriangleSoup& soup)
    : soup_(soup),
      parts_(cut(soup)),
      boxes_(parts_.size(), BoxHierarchy::Box::about(soup.vertices()),
             [&](std::size_t box) { return box_of_part(soup[parts_[box].triangle], parts_[box].path); }) {}

NearestTriangle::Found NearestTriangle::nearest(const glm::dvec3& p, Guess& guess) const {
    Found found{guess.triangle, squared_distance(soup_[guess.triangle], p)};
    double radius = std::sqrt(found.squared);
    const auto look_within = [&](double within) {
        boxes_.visit_near(p, within, [&](std::size_t box) {
            const std::size_t triangle = parts_[box].triangle;
            const double squared = squared_distance(soup_[triangle], p);
            if (found.is_beaten_by(squared, triangle)) {
                found = {triangle, squared};
                radius = std::sqrt(squared);
            }
            return std::min(radius, within);
        });
    };
    // First within a few times the last point's distance: usually sufficient, and much less than the distance to the
    // triangle nearest to that point.
    const double near = 4 * guess.distance;
    const bool far = !(near < radius);
    if (!far)
        look_within(near);
    if (far || radius > near)
        look_within(radius);
    guess = {found.triangle, radius};
    return found;
}

std::size_t NearestTriangle::boxes_around(const glm::dvec3& p) const {
    std::size_t count = 0;
    boxes_.visit_near(p, 0, [&](std::size_t) {
        ++count;
        return 0.0;
    });
    return count;
}

bool NearestTriangle::within(const glm::dvec3& p, double radius, std::size_t most, std::vector<Found>& found) const {
    found.clear();
    const double largest = radius * radius * rounding_slack;
    const auto drop_doubles = [&] {
        std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.triangle < b.triangle; });
        found.erase(std::unique(found.begin(), found.end(),
                                [](const Found& a, const Found& b) { return a.triangle == b.triangle; }),
                    found.end());
    };
    bool all = true;
    boxes_.visit_near(p, radius, [&](std::size_t box) {
        const std::size_t triangle = parts_[box].triangle;
        const double squared = squared_distance(soup_[triangle], p);
        if (squared > largest)
            return radius;
        found.push_back({triangle, squared});
        if (found.size() > most)
            drop_doubles();
        all = found.size() <= most;
        return all ? radius : 0.0;
    });
    drop_doubles();
    return all;
}

}  // namespace tessera

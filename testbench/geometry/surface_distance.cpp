#include "testbench/geometry/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "testbench/common/parallel.h"
#include "testbench/common/random.h"

namespace tessera {
namespace {

constexpr std::size_t chunk_points = 256;
constexpr std::uint64_t usual_looks = 32;  // for a point in a few boxes
constexpr std::size_t pilot_points = 256;

/// Every vertex once, in the order of its first use, then every centroid.
class Points {
  public:
    explicit Points(const TriangleSoup& soup) : soup_(soup) {}

    std::size_t size() const { return soup_.vertices().size() + soup_.size(); }

    glm::dvec3 operator[](std::size_t index) const {
        if (index < soup_.vertices().size())
            return soup_.vertices()[index];
        const auto t = soup_[index - soup_.vertices().size()];
        return (t[0] + t[1] + t[2]) / 3.0;
    }

  private:
    const TriangleSoup& soup_;
};

/// Index among `all` points of the k-th of the `chosen` points.
std::size_t choice(std::size_t k, std::size_t chosen, std::size_t all) {
    if (chosen == all)
        return k;
    const double place = static_cast<double>(k) + Random(k).real(0, 1);
    return std::min(all - 1, static_cast<std::size_t>(place / static_cast<double>(chosen) * static_cast<double>(all)));
}

/// Number of points to measure: all, or a power of two.
std::size_t affordable(const Points& points, const NearestTriangle& nearest, std::uint64_t most) {
    const std::size_t pilots = std::min(pilot_points, points.size());
    std::uint64_t boxes = 0;
    for (std::size_t k = 0; k < pilots; ++k)
        boxes += nearest.boxes_around(points[choice(k, pilots, points.size())]);
    const std::uint64_t count = most / (usual_looks + boxes / pilots);
    if (points.size() <= count)
        return points.size();
    std::size_t power = 1;
    while (2 * power <= count)
        power *= 2;
    return power;
}

}  // namespace

// If a fraction q of the points were farther away, all n measured points would have missed it with a probability of at
// most (1 - q)^n: with fractions q_i of n equal parts it is the product of 1 - q_i, largest if all q_i equal q.
double SurfaceDistance::unseen(double confidence) const {
    if (measured >= points)
        return 0;
    return -std::expm1(std::log1p(-confidence) / static_cast<double>(measured));
}

SurfaceDistance distance_between(const TriangleSoup& from, const TriangleSoup& to, std::uint64_t most, double near) {
    SurfaceDistance result;
    if (from.empty())
        return result;
    const Points points(from);
    result.points = points.size();
    if (to.empty()) {
        result.max = result.rms = std::numeric_limits<double>::infinity();
        return result;
    }
    const NearestTriangle nearest(to);
    result.measured = affordable(points, nearest, most);
    struct Part {
        double largest = 0, squares = 0;
        std::uint64_t farther = 0;
    };
    std::vector<Part> parts((result.measured + chunk_points - 1) / chunk_points);
    for_each_chunk(parts.size(), [&] {
        return [&](std::size_t chunk) {
            NearestTriangle::Guess guess;
            const std::size_t end = std::min<std::size_t>((chunk + 1) * chunk_points, result.measured);
            for (std::size_t k = chunk * chunk_points; k < end; ++k) {
                const double squared =
                    nearest.nearest(points[choice(k, result.measured, points.size())], guess).squared;
                parts[chunk].largest = std::max(parts[chunk].largest, squared);
                parts[chunk].squares += squared;
                parts[chunk].farther += squared > near * near ? 1U : 0U;
            }
        };
    });
    double squares = 0;
    for (const Part& part : parts) {
        result.max = std::max(result.max, std::sqrt(part.largest));
        squares += part.squares;
        result.farther += part.farther;
    }
    result.rms = std::sqrt(squares / static_cast<double>(result.measured));
    return result;
}

}  // namespace tessera

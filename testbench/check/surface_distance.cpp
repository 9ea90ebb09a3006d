#include "testbench/check/surface_distance.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>

namespace tessera {
namespace {

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

float rounded_down(double value) {
    const auto result = static_cast<float>(value);
    return static_cast<double>(result) <= value
               ? result
               : std::nextafter(result, -std::numeric_limits<float>::infinity());
}
float rounded_up(double value) {
    return -rounded_down(-value);
}

/// Nearest-triangle look-up. The triangles are Embree user geometry: their boxes are rounded outwards, and
/// the search radius upwards, so that the single-precision hierarchy never leaves out the nearest; distances
/// are ours.
class NearestTriangle {
  public:
    explicit NearestTriangle(const TriangleSoup& soup) : soup_(soup), device_(rtcNewDevice("threads=1")) {
        if (!device_)
            throw std::runtime_error("Embree could not start (error " +
                                     std::to_string(rtcGetDeviceError(nullptr)) + ")");
        scene_.reset(rtcNewScene(device_.get()));
        RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(soup.size()));
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryBoundsFunction(geometry, &NearestTriangle::bounds, nullptr);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_.get());
        const RTCError error = rtcGetDeviceError(device_.get());
        if (error != RTC_ERROR_NONE)
            throw std::runtime_error("Embree could not build its hierarchy (error " + std::to_string(error) +
                                     ")");
    }

    double distance(const glm::dvec3& p) {
        point_ = p;
        RTCPointQuery query;
        query.x = static_cast<float>(p.x);
        query.y = static_cast<float>(p.y);
        query.z = static_cast<float>(p.z);
        query.time = 0;
        point_rounding_ = glm::length(p - glm::dvec3(query.x, query.y, query.z));
        // A neighbour's nearest triangle is a good first guess.
        nearest_squared_ = std::numeric_limits<double>::infinity();
        look_at(nearest_);
        query.radius = radius();
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene_.get(), &query, &context, &NearestTriangle::visit, this);
        return std::sqrt(nearest_squared_);
    }

  private:
    static void bounds(const RTCBoundsFunctionArguments* arguments) {
        const auto& self = *static_cast<const NearestTriangle*>(arguments->geometryUserPtr);
        const auto& t = self.soup_[arguments->primID];
        const glm::dvec3 low = glm::min(t[0], glm::min(t[1], t[2]));
        const glm::dvec3 high = glm::max(t[0], glm::max(t[1], t[2]));
        RTCBounds& box = *arguments->bounds_o;
        box.lower_x = rounded_down(low.x);
        box.lower_y = rounded_down(low.y);
        box.lower_z = rounded_down(low.z);
        box.upper_x = rounded_up(high.x);
        box.upper_y = rounded_up(high.y);
        box.upper_z = rounded_up(high.z);
    }

    static bool visit(RTCPointQueryFunctionArguments* arguments) {
        auto& self = *static_cast<NearestTriangle*>(arguments->userPtr);
        if (!self.look_at(arguments->primID))
            return false;
        arguments->query->radius = self.radius();
        return true;
    }

    bool look_at(std::size_t triangle) {
        const glm::dvec3 away = closest_point(soup_[triangle], point_) - point_;
        const double squared = glm::dot(away, away);
        if (!(squared < nearest_squared_))
            return false;
        nearest_squared_ = squared;
        nearest_ = triangle;
        return true;
    }

    /// The last factor makes up for the rounding inside Embree's own box distances.
    float radius() const {
        return rounded_up((std::sqrt(nearest_squared_) + point_rounding_) * (1 + 0x1p-18));
    }

    const TriangleSoup& soup_;
    std::unique_ptr<RTCDeviceTy, ReleaseDevice> device_;
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene_;
    glm::dvec3 point_{0};
    double point_rounding_ = 0;
    double nearest_squared_ = 0;
    std::size_t nearest_ = 0;
};

std::vector<glm::dvec3> distinct_vertices(const TriangleSoup& soup) {
    std::vector<glm::dvec3> vertices;
    vertices.reserve(3 * soup.size());
    for (const auto& t : soup)
        vertices.insert(vertices.end(), t.begin(), t.end());
    std::sort(vertices.begin(), vertices.end(), [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    });
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

}  // namespace

// Ericson, Real-Time Collision Detection, 5.1.5: by the Voronoi region of corner, edge or face that p lies
// in.
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
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3)
        return a + d1 / (d1 - d3) * ab;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6)
        return a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    const double to_c = d4 - d3, to_b = d5 - d6;
    if (va <= 0 && to_c >= 0 && to_b >= 0 && to_c + to_b > 0)
        return b + to_c / (to_c + to_b) * (c - b);
    const double sum = va + vb + vc;
    if (!(sum > 0))
        return a;
    return a + vb / sum * ab + vc / sum * ac;
}

SurfaceDistance distance_between(const TriangleSoup& from, const TriangleSoup& to) {
    SurfaceDistance result;
    if (from.empty())
        return result;
    if (to.empty()) {
        const double infinity = std::numeric_limits<double>::infinity();
        return {from.size(), infinity, infinity};
    }
    NearestTriangle nearest(to);
    double squares = 0;
    const auto measure = [&](const glm::dvec3& p) {
        const double distance = nearest.distance(p);
        result.max = std::max(result.max, distance);
        squares += distance * distance;
        ++result.points;
    };
    for (const glm::dvec3& p : distinct_vertices(from))
        measure(p);
    for (const auto& t : from)
        measure((t[0] + t[1] + t[2]) / 3.0);
    result.rms = std::sqrt(squares / static_cast<double>(result.points));
    return result;
}

}  // namespace tessera

#include "testbench/geometry/box_hierarchy.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "testbench/common/error.h"

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
    return static_cast<double>(result) <= value ? result
                                                : std::nextafter(result, -std::numeric_limits<float>::infinity());
}
float rounded_up(double value) {
    return -rounded_down(-value);
}

[[noreturn]] void fail(const char* what, RTCError error) {
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw ResourceError(std::string("Embree ran out of memory and could not ") + what +
                            "; measure a smaller mesh or give the process more");
    throw std::runtime_error(std::string("Embree could not ") + what + " (error " + std::to_string(error) + ")");
}

using BoxOf = std::function<BoxHierarchy::Box(std::size_t)>;

void bounds(const RTCBoundsFunctionArguments* arguments) {
    const BoxHierarchy::Box box = (*static_cast<const BoxOf*>(arguments->geometryUserPtr))(arguments->primID);
    RTCBounds& result = *arguments->bounds_o;
    result.lower_x = rounded_down(box.low.x);
    result.lower_y = rounded_down(box.low.y);
    result.lower_z = rounded_down(box.low.z);
    result.upper_x = rounded_up(box.high.x);
    result.upper_y = rounded_up(box.high.y);
    result.upper_z = rounded_up(box.high.z);
}

struct Asker {
    double (*visit)(void*, std::size_t);
    void* context;
    double point_rounding;
    double radius;

    /// The last factor covers the rounding of Embree's own box distances.
    float embree_radius() const { return rounded_up((radius + point_rounding) * (1 + 0x1p-18)); }
};

bool visit_box(RTCPointQueryFunctionArguments* arguments) {
    auto& asker = *static_cast<Asker*>(arguments->userPtr);
    const double radius = asker.visit(asker.context, arguments->primID);
    if (!(radius < asker.radius))
        return false;
    asker.radius = radius;
    arguments->query->radius = asker.embree_radius();
    return true;
}

}  // namespace

struct BoxHierarchy::Handles {
    std::unique_ptr<RTCDeviceTy, ReleaseDevice> device;
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene;
};

BoxHierarchy::BoxHierarchy(std::size_t count, const BoxOf& box) : handles_(std::make_unique<Handles>()) {
    if (count > std::numeric_limits<unsigned>::max())
        throw ResourceError("more than 2^32 triangles cannot be sorted; measure a smaller mesh");
    handles_->device.reset(rtcNewDevice("threads=1"));
    if (!handles_->device)
        fail("start", rtcGetDeviceError(nullptr));
    handles_->scene.reset(rtcNewScene(handles_->device.get()));
    RTCGeometry geometry = rtcNewGeometry(handles_->device.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
    BoxOf copy = box;  // needed until the hierarchy is built
    rtcSetGeometryUserData(geometry, &copy);
    rtcSetGeometryBoundsFunction(geometry, &bounds, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(handles_->scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(handles_->scene.get());
    const RTCError error = rtcGetDeviceError(handles_->device.get());
    if (error != RTC_ERROR_NONE)
        fail("build its hierarchy", error);
}

BoxHierarchy::~BoxHierarchy() = default;

void BoxHierarchy::query(const glm::dvec3& p, double radius, Callback visit, void* context) const {
    RTCPointQuery query;
    query.x = static_cast<float>(p.x);
    query.y = static_cast<float>(p.y);
    query.z = static_cast<float>(p.z);
    query.time = 0;
    Asker asker{visit, context, glm::length(p - glm::dvec3(query.x, query.y, query.z)), radius};
    query.radius = asker.embree_radius();
    RTCPointQueryContext query_context;
    rtcInitPointQueryContext(&query_context);
    rtcPointQuery(handles_->scene.get(), &query, &query_context, &visit_box, &asker);
}

}  // namespace tessera

#include "testbench/render/ray_scene.h"

#if TESSERA_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "testbench/common/error.h"

namespace tessera {
namespace {

constexpr std::size_t packet = 8;

void check(RTCDevice device, std::size_t triangles) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw ResourceError(
            fmt::format("picture: out of memory for the ray hierarchy of {} triangles; set "
                        "output.picture = false or reduce their number",
                        triangles));
    if (error != RTC_ERROR_NONE)
        throw std::runtime_error(fmt::format("picture: Embree reports error {}", static_cast<int>(error)));
}

void put(const Ray& ray, std::size_t lane, RTCRay8& to) {
    to.org_x[lane] = static_cast<float>(ray.origin.x);
    to.org_y[lane] = static_cast<float>(ray.origin.y);
    to.org_z[lane] = static_cast<float>(ray.origin.z);
    to.dir_x[lane] = static_cast<float>(ray.direction.x);
    to.dir_y[lane] = static_cast<float>(ray.direction.y);
    to.dir_z[lane] = static_cast<float>(ray.direction.z);
    to.tnear[lane] = static_cast<float>(ray.near);
    to.tfar[lane] = std::numeric_limits<float>::infinity();
    to.time[lane] = 0;
    to.mask[lane] = ~0u;
    to.id[lane] = 0;
    to.flags[lane] = 0;
}

/// Calls trace(first, count, valid) for each packet of a batch.
template <typename Trace>
void for_each_packet(std::size_t rays, const Trace& trace) {
    for (std::size_t first = 0; first < rays; first += packet) {
        const std::size_t count = std::min(packet, rays - first);
        alignas(32) int valid[packet];
        for (std::size_t lane = 0; lane < packet; ++lane)
            valid[lane] = lane < count ? -1 : 0;
        trace(first, count, valid);
    }
}

// Embree 3 and 4 take the flag that a packet's rays are coherent in different ways.
#if RTC_VERSION_MAJOR == 3
RTCIntersectContext coherent_context() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}
void intersect(const int* valid, RTCScene scene, RTCRayHit8& hits) {
    RTCIntersectContext context = coherent_context();
    rtcIntersect8(valid, scene, &context, &hits);
}
void occlude(const int* valid, RTCScene scene, RTCRay8& rays) {
    RTCIntersectContext context = coherent_context();
    rtcOccluded8(valid, scene, &context, &rays);
}
#else
void intersect(const int* valid, RTCScene scene, RTCRayHit8& hits) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &hits, &arguments);
}
void occlude(const int* valid, RTCScene scene, RTCRay8& rays) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded8(valid, scene, &rays, &arguments);
}
#endif

}  // namespace

RayScene::RayScene(const RenderMesh& mesh) {
    RTCDevice device = rtcNewDevice("threads=1");
    if (!device)
        check(nullptr, mesh.triangles.size());
    device_ = {device, rtcReleaseDevice};
    RTCScene scene = rtcNewScene(device);
    check(device, mesh.triangles.size());
    scene_ = {scene, rtcReleaseScene};
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    check(device, mesh.triangles.size());
    const std::shared_ptr<RTCGeometryTy> release(geometry, rtcReleaseGeometry);
    // Copied, since Embree reads up to 16 bytes at a buffer's last element, beyond the end of a vector.
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), mesh.triangles.size()));
    check(device, mesh.triangles.size());
    if (!mesh.triangles.empty()) {
        for (const glm::vec3& p : mesh.positions)
            for (int k = 0; k < 3; ++k)
                *positions++ = p[k];
        for (const RenderMesh::Triangle& triangle : mesh.triangles)
            indices = std::copy(triangle.vertices.begin(), triangle.vertices.end(), indices);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);
    check(device, mesh.triangles.size());
}

void RayScene::first_hits(const std::vector<Ray>& rays, std::vector<std::uint32_t>& triangles) const {
    triangles.resize(rays.size());
    for_each_packet(rays.size(), [&](std::size_t first, std::size_t count, const int* valid) {
        RTCRayHit8 hits;
        for (std::size_t lane = 0; lane < count; ++lane) {
            put(rays[first + lane], lane, hits.ray);
            hits.hit.primID[lane] = hits.hit.geomID[lane] = hits.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
        intersect(valid, scene_.get(), hits);
        for (std::size_t lane = 0; lane < count; ++lane)
            triangles[first + lane] =
                hits.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID ? nothing : hits.hit.primID[lane];
    });
}

void RayScene::occlusions(const std::vector<glm::vec3>& origins, const glm::dvec3& direction,
                          std::vector<std::uint8_t>& occluded) const {
    RTCRay8 rays{};
    for (std::size_t lane = 0; lane < packet; ++lane)
        put({{}, direction}, lane, rays);
    for_each_packet(origins.size(), [&](std::size_t first, std::size_t count, const int* valid) {
        for (std::size_t lane = 0; lane < count; ++lane) {
            const glm::vec3& origin = origins[first + lane];
            rays.org_x[lane] = origin.x;
            rays.org_y[lane] = origin.y;
            rays.org_z[lane] = origin.z;
            rays.tfar[lane] = std::numeric_limits<float>::infinity();
        }
        occlude(valid, scene_.get(), rays);
        for (std::size_t lane = 0; lane < count; ++lane)
            occluded.push_back(rays.tfar[lane] < 0);
    });
}

}  // namespace tessera

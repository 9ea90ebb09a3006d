#include "testbench/host/simulation.h"

#include <fmt/core.h>

#include "testbench/common/error.h"

namespace tessera {

Simulation::Simulation(const Setup& setup, std::uint64_t triangle_limit)
    : pipeline("tessera", setup.registers, setup.design),
      host("host", setup),
      rasteriser("rasteriser"),
      monitor("mesh_monitor", setup.registers.back_face_culling, triangle_limit) {
    host.to_get_triangle.bind(pipeline.get_triangle.from_host);
    host.displacement_map.bind(pipeline.displacement_map.socket);
    host.normal_map.bind(pipeline.normal_map.socket);
    host.summed_height_table.bind(pipeline.summed_height_table.socket);
    pipeline.lighting.to_rasteriser.bind(rasteriser.from_lighting);
    pipeline.pass_or_tessellate.finished.bind(monitor);
}

std::string Simulation::run() {
    sc_core::sc_start();
    if (monitor.limit_reached())
        throw ResourceError(
            fmt::format("limits.triangles = {}: the mesh has more triangles than that; raise the thresholds "
                        "under [tests], lower "
                        "tests.generation_limit, or raise the limit",
                        monitor.mesh.triangles.size()));
    return drained() ? std::string{} : stuck();
}

bool Simulation::drained() const {
    return host.idle() && pipeline.idle();
}

std::string Simulation::stuck() const {
    const auto& counts = pipeline.pass_or_tessellate.counts();
    return fmt::format(
        "host: {} of {} base triangles sent{}\n"
        "triangle_queue: holds {} triangles{}\n"
        "pass_or_tessellate: {} triangles finished{}\n",
        host.sent(), host.total(), host.idle() ? "" : ", waits for get_triangle",
        pipeline.triangle_queue.waiting(), pipeline.triangle_queue.idle() ? "" : ", waits for get_triangle",
        counts.finished,
        pipeline.pass_or_tessellate.idle() ? "" : ", holds a triangle, waits for its other branch");
}

}  // namespace tessera

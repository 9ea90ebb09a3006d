#include "testbench/check/end_to_end.h"

#include <cmath>

#include "testbench/check/surface_distance.h"

namespace tessera {

namespace {

using BaseTriangles = std::vector<std::array<golden::Vertex, 3>>;

EndToEndResult compare(const Setup& setup, const BaseTriangles& base, const golden::Map& map,
                       golden::Parameters parameters, const EmittedMesh& hardware) {
    parameters.texture_step = std::ldexp(1.0, -setup.registers.formats.texture.fraction);
    EndToEndResult result;
    result.hardware_triangles = hardware.triangles.size();
    result.bound = 4 * result.hardware_triangles + 1000;

    TriangleSoup golden_soup;
    golden_soup.reserve(hardware.triangles.size() + hardware.triangles.size() / 8);
    const golden::Tessellation run =
        golden::tessellate(base, map, parameters, result.bound, [&](const golden::Triangle& t) {
            const auto& v = t.vertices;
            golden_soup.push_back(
                {v[0].displaced_position, v[1].displaced_position, v[2].displaced_position});
        });
    result.golden_triangles = run.triangles_emitted;
    result.golden_edges = run.edges_evaluated;
    result.golden_largest_generation = run.largest_generation;
    result.bound_hit = run.bound_hit;
    if (run.bound_hit)
        return result;

    const Dequantise dequantise(setup.registers.formats);
    TriangleSoup hardware_soup;
    hardware_soup.reserve(hardware.triangles.size());
    for (const EmittedTriangle& t : hardware.triangles)
        hardware_soup.push_back({dequantise.position(t.corners[0].displaced),
                                 dequantise.position(t.corners[1].displaced),
                                 dequantise.position(t.corners[2].displaced)});

    const auto measure = [&](const TriangleSoup& from, const TriangleSoup& to) {
        const SurfaceDistance d = distance_between(from, to);
        const double lsb = std::ldexp(1.0, setup.registers.formats.position.fraction);
        const double model = 1 / setup.model_scale.scale;
        return EndToEndResult::Distance{d.points,    d.measured,    d.unseen(EndToEndResult::confidence),
                                        d.max,       d.rms,         d.max * lsb,
                                        d.rms * lsb, d.max * model, d.rms * model};
    };
    // One after the other, each on both cores: of two Embree devices at a time, releasing one may abort without memory.
    result.hardware_to_golden = measure(hardware_soup, golden_soup);
    result.golden_to_hardware = measure(golden_soup, hardware_soup);
    return result;
}

/// See compare_end_to_end(); model units.
double allowed_rms(const Setup& setup, const golden::Scene& scene, int generations,
                   double allowed_triangles) {
    const datapath::Formats& formats = setup.registers.formats;
    const double largest = std::max(std::abs(scene.lowest), std::abs(scene.highest));
    const double position =
        (generations / 2.0 + 2) * std::ldexp(1.0, -formats.position.fraction) / scene.placement.scale;
    const double normal = 2.0 * (generations + 1) * std::ldexp(1.0, -formats.normal.fraction) * largest;
    return std::sqrt(3.0) * (position + normal) +
           std::sqrt(allowed_triangles / 100) * std::abs(scene.highest - scene.lowest);
}

}  // namespace

double EndToEndResult::more_triangles() const {
    const auto count = static_cast<double>(hardware_triangles);
    return count == 0 ? 0 : 100 * (static_cast<double>(golden_triangles) / count - 1);
}

bool EndToEndResult::passed() const {
    return !bound_hit && std::abs(more_triangles()) <= allowed.triangles && rms_model() <= allowed.rms_model;
}

EndToEndResult compare_end_to_end(const Setup& setup, const GoldenJob& golden,
                                  const std::vector<std::uint32_t>& base_triangles,
                                  const EmittedMesh& hardware, double allowed_triangles) {
    const double step = std::ldexp(1.0, -setup.registers.formats.texture.fraction);
    BaseTriangles base;
    base.reserve(base_triangles.size());
    for (const std::uint32_t triangle : base_triangles) {
        auto& corners = base.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = golden.vertex(golden.mesh().triangles[triangle][k]);
            corners[k].texture = golden::on_grid(corners[k].texture, step);
        }
    }
    EndToEndResult result = compare(setup, base, golden.map(), golden.parameters(), hardware);
    result.allowed = {allowed_triangles, allowed_rms(setup, golden.scene(), result.golden_largest_generation,
                                                     allowed_triangles)};
    return result;
}

EndToEndResult compare_end_to_end(const Setup& setup, const GoldenInputs& inputs,
                                  const EmittedMesh& hardware) {
    return compare(setup, golden_base_triangles(setup), inputs.map, inputs.parameters, hardware);
}

}  // namespace tessera

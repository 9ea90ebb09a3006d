#include "testbench/check/end_to_end.h"

#include <cmath>

#include "testbench/check/surface_distance.h"
#include "testbench/common/parallel.h"

namespace tessera {
namespace {

constexpr std::size_t most_side_by_side = 2'000'000;  // triangles: beyond, memory for one search at a time

}  // namespace

EndToEndResult compare_end_to_end(const Setup& setup, const GoldenInputs& inputs,
                                  const EmittedMesh& hardware) {
    EndToEndResult result;
    result.hardware_triangles = hardware.triangles.size();
    result.bound = 4 * result.hardware_triangles + 1000;

    TriangleSoup golden_soup;
    golden_soup.reserve(hardware.triangles.size() + hardware.triangles.size() / 8);
    const golden::Tessellation run =
        golden::tessellate(golden_base_triangles(setup), inputs.map, inputs.parameters, result.bound,
                           [&](const golden::Triangle& t) {
                               const auto& v = t.vertices;
                               golden_soup.push_back({v[0].displaced_position, v[1].displaced_position,
                                                      v[2].displaced_position});
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
    const auto there = [&] { result.hardware_to_golden = measure(hardware_soup, golden_soup); };
    const auto back = [&] { result.golden_to_hardware = measure(golden_soup, hardware_soup); };
    if (hardware_soup.size() + golden_soup.size() > most_side_by_side) {
        there();
        back();
    } else {
        for_each_chunk(2, [&] { return [&](std::size_t direction) { direction == 0 ? there() : back(); }; });
    }
    return result;
}

}  // namespace tessera

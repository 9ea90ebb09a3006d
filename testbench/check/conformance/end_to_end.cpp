#include "testbench/check/conformance/end_to_end.h"

#include <algorithm>
#include <cmath>

#include "testbench/geometry/surface_distance.h"

namespace tessera {

namespace {

constexpr std::size_t triangles_between_progress = 256;

using BaseTriangles = std::vector<std::array<golden::Vertex, 3>>;

/// `allowed` is called with the largest generation. Golden's run counts as half of the progress and is assumed to have
/// as many triangles as the hardware's.
template <typename AllowedAt>
EndToEndResult compare(const MachineSetup& setup, const BaseTriangles& base, const golden::Map& map,
                       golden::Parameters parameters, const EmittedMesh& hardware, AllowedAt allowed,
                       const std::function<void(double)>& progress) {
    parameters.texture_step = std::ldexp(1.0, -setup.registers.formats.texture.fraction);
    EndToEndResult result;
    result.hardware_triangles = hardware.triangles.size();
    result.bound = 4 * result.hardware_triangles + 1000;

    const auto tell = [&](double part) {
        if (progress)
            progress(part);
    };
    TriangleSoup golden_soup;
    golden_soup.reserve(hardware.triangles.size() + hardware.triangles.size() / 8);
    const golden::Tessellation run =
        golden::tessellate(base, map, parameters, result.bound, [&](const golden::Triangle& t) {
            const auto& v = t.vertices;
            golden_soup.push_back({v[0].displaced_position, v[1].displaced_position, v[2].displaced_position});
            if (golden_soup.size() % triangles_between_progress == 0)
                tell(0.5 * std::min(1.0, static_cast<double>(golden_soup.size()) /
                                             static_cast<double>(result.hardware_triangles)));
        });
    result.golden_triangles = run.triangles_emitted;
    result.golden_edges = run.edges_evaluated;
    result.golden_largest_generation = run.largest_generation;
    result.bound_hit = run.bound_hit;
    result.allowed = allowed(run.largest_generation);
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
        const double lsb = std::ldexp(1.0, setup.registers.formats.position.fraction);
        const double model = 1 / setup.model_scale.scale;
        const SurfaceDistance d = distance_between(from, to, most_looks, result.allowed.rounding / model);
        return EndToEndResult::Distance{d.points,
                                        d.measured,
                                        d.unseen(EndToEndResult::confidence),
                                        d.farther_percent(),
                                        d.max,
                                        d.rms,
                                        d.max * lsb,
                                        d.rms * lsb,
                                        d.max * model,
                                        d.rms * model};
    };
    // One after the other: with two Embree devices at once, releasing one may abort when memory runs out.
    tell(0.5);
    result.hardware_to_golden = measure(hardware_soup, golden_soup);
    tell(0.75);
    result.golden_to_hardware = measure(golden_soup, hardware_soup);
    tell(1);
    return result;
}

/// The largest |n - m| of two unit normals n, m of one base triangle.
double largest_turn(const BaseTriangles& base) {
    double turn = 0;
    for (const auto& t : base)
        for (std::size_t k = 0; k < 3; ++k)
            turn = std::max(turn, glm::length(t[k].normal - t[(k + 1) % 3].normal));
    return turn;
}

/// Whether all normals of each base triangle are one unit vector along an axis, so that they and their means are exact.
bool normals_are_exact(const BaseTriangles& base) {
    return largest_turn(base) == 0 && std::all_of(base.begin(), base.end(), [](const auto& t) {
               const glm::dvec3 n = glm::abs(t[0].normal);
               return n.x + n.y + n.z == 1 && std::max({n.x, n.y, n.z}) == 1;
           });
}

/// See compare_end_to_end().
EndToEndResult::Allowed allowed_after(int generations, const MachineSetup& setup, const golden::Scene& scene,
                                      const BaseTriangles& base, double allowed_triangles) {
    const datapath::Formats& formats = setup.registers.formats;
    const double largest = std::max(std::abs(scene.lowest), std::abs(scene.highest));
    const double position =
        (generations / 2.0 + 2) * std::ldexp(1.0, -formats.position.fraction) / scene.placement.scale;
    const double normal =
        normals_are_exact(base) ? 0 : 2.0 * (generations + 1) * std::ldexp(1.0, -formats.normal.fraction) * largest;
    return {allowed_triangles, std::sqrt(3.0) * (position + normal),
            std::abs(scene.highest - scene.lowest) + largest * largest_turn(base)};
}

}  // namespace

double EndToEndResult::more_triangles() const {
    const auto count = static_cast<double>(hardware_triangles);
    return count == 0 ? 0 : 100 * (static_cast<double>(golden_triangles) / count - 1);
}

bool EndToEndResult::passed() const {
    return !bound_hit && std::abs(more_triangles()) <= allowed.triangles && farther() <= allowed_farther() &&
           rms_model() <= allowed_rms_model();
}

EndToEndResult compare_end_to_end(const MachineSetup& setup, const GoldenJob& golden,
                                  const std::vector<std::uint32_t>& base_triangles, const EmittedMesh& hardware,
                                  double allowed_triangles, const std::function<void(double)>& progress) {
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
    return compare(
        setup, base, golden.map(), golden.parameters(), hardware,
        [&](int generations) { return allowed_after(generations, setup, golden.scene(), base, allowed_triangles); },
        progress);
}

EndToEndResult compare_end_to_end(const MachineSetup& setup, const GoldenInputs& inputs, const EmittedMesh& hardware) {
    return compare(
        setup, golden_base_triangles(setup), inputs.map, inputs.parameters, hardware,
        [](int) { return EndToEndResult::Allowed{}; }, nullptr);
}

}  // namespace tessera

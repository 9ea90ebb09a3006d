#include "testbench/check/conformance/end_to_end.h"

#include <algorithm>
#include <cmath>

#include "modules/datapath/bilinear.h"
#include "testbench/common/parallel.h"
#include "testbench/geometry/surface_distance.h"

namespace tessera {

namespace {

using BaseTriangles = std::vector<std::array<golden::Vertex, 3>>;

using Told = std::function<void(double)>;

std::uint64_t bound_of(const EmittedMesh& hardware) {
    return 4 * hardware.triangles.size() + 1000;
}

golden::Parameters with_steps(golden::Parameters parameters, std::int64_t texture_fraction,
                              std::int64_t normal_fraction, int view_distance_fraction) {
    parameters.texture_step = std::ldexp(1.0, -static_cast<int>(texture_fraction));
    parameters.direction_step = std::ldexp(1.0, -static_cast<int>(normal_fraction));
    parameters.distance_step = std::ldexp(1.0, -view_distance_fraction);
    return parameters;
}

void tell(const Told& progress, double part) {
    if (progress)
        progress(part);
}

GoldenSurface run_golden(const BaseTriangles& base, const golden::Map& map, const golden::Parameters& parameters,
                         std::uint64_t bound) {
    GoldenSurface surface;
    surface.run = golden::tessellate(base, map, parameters, bound, [&](const golden::Triangle& t) { surface.add(t); });
    return surface;
}

/// P' of all triangles.
TriangleSoup soup_of(const EmittedMesh& mesh, const Dequantise& dequantise) {
    TriangleSoup soup;
    soup.reserve(mesh.triangles.size());
    std::vector<std::uint32_t> vertices;
    vertices.reserve(mesh.triangles.corners().size());
    for (const EmittedTriangle::Corner& corner : mesh.triangles.corners())
        vertices.push_back(soup.vertex(dequantise.position(corner.displaced)));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles.corner_indices(t);
        soup.push_back({vertices[a], vertices[b], vertices[c]});
    }
    return soup;
}

EndToEndResult compare(const MachineSetup& setup, const GoldenSurface& golden, const EmittedMesh& hardware,
                       const EndToEndResult::Allowed& allowed, const Told& progress) {
    EndToEndResult result;
    result.hardware_triangles = hardware.triangles.size();
    result.bound = bound_of(hardware);
    result.golden_triangles = golden.run.triangles_emitted;
    result.golden_edges = golden.run.edges_evaluated;
    result.golden_largest_generation = golden.run.largest_generation;
    result.bound_hit = golden.run.bound_hit;
    result.allowed = allowed;
    if (result.bound_hit)
        return result;

    const TriangleSoup hardware_soup = soup_of(hardware, Dequantise(setup.registers.formats));
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
    // Sequential, to limit memory: each uses all cores.
    result.hardware_to_golden = measure(hardware_soup, golden.triangles);
    tell(progress, 0.5);
    result.golden_to_hardware = measure(golden.triangles, hardware_soup);
    tell(progress, 1);
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

/// Whether each base triangle's normals are all the same unit vector along an axis: they and their means are exact.
bool normals_are_exact(const BaseTriangles& base) {
    return largest_turn(base) == 0 && std::all_of(base.begin(), base.end(), [](const auto& t) {
               const glm::dvec3 n = glm::abs(t[0].normal);
               return n.x + n.y + n.z == 1 && std::max({n.x, n.y, n.z}) == 1;
           });
}

/// See GoldenRun::compare().
EndToEndResult::Allowed allowed_after(int generations, const MachineSetup& setup, const golden::Scene& scene,
                                      const BaseTriangles& base, double allowed_triangles) {
    const datapath::Formats& formats = setup.registers.formats;
    const double largest = std::max(std::abs(scene.lowest), std::abs(scene.highest));
    const double position =
        (generations / 2.0 + 2) * std::ldexp(1.0, -formats.position.fraction) / scene.placement.scale;
    const double normal =
        normals_are_exact(base) ? 0 : 2.0 * (generations + 1) * std::ldexp(1.0, -formats.normal.fraction) * largest;
    // a code between texels, rounded to nearest
    const double code = formats.filter == datapath::MapFilter::nearest
                            ? 0
                            : std::ldexp(std::abs(scene.highest - scene.lowest) / scene.highest_code,
                                         -datapath::code_fraction(formats) - 1);
    return {allowed_triangles, std::sqrt(3.0) * (position + normal + code),
            std::abs(scene.highest - scene.lowest) + largest * largest_turn(base)};
}

}  // namespace

double EndToEndResult::more_triangles() const {
    const auto count = static_cast<double>(hardware_triangles);
    return count == 0 ? 0 : 100 * (static_cast<double>(golden_triangles) / count - 1);
}

bool EndToEndResult::passed() const {
    return !bound_hit && std::abs(more_triangles()) <= allowed.triangles && farther() <= allowed_farther() &&
           rms_model() <= allowed_rms_model() && !empty();
}

void GoldenSurface::add(const golden::Triangle& t) {
    const auto& v = t.vertices;
    triangles.push_back({v[0].displaced_position, v[1].displaced_position, v[2].displaced_position});
}

GoldenRun::GoldenRun(const GoldenJob& golden, const std::vector<std::uint32_t>& base_triangles, std::uint64_t most)
    : golden_(golden),
      parameters_(with_steps(golden.parameters(), golden.job().formats.texture_fraction,
                             golden.job().formats.normal_fraction, golden.view_distance_fraction())),
      most_(most) {
    const double step = parameters_.texture_step;
    base_.reserve(base_triangles.size());
    for (const std::uint32_t triangle : base_triangles) {
        auto& corners = base_.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = golden.vertex(triangle, k);
            corners[k].texture = golden::on_grid(corners[k].texture, step);
        }
    }
    surface_ = beside([this] {
        GoldenSurface surface;
        surface.run = golden::tessellate(base_, golden_.map(), parameters_, most_,
                                         [&](const golden::Triangle& t) { surface.add(t); });
        return surface;
    });
}

GoldenRun::~GoldenRun() {
    most_ = 0;
}

EndToEndResult GoldenRun::compare(const MachineSetup& setup, const EmittedMesh& hardware, double allowed_triangles,
                                  const Told& progress) {
    const std::uint64_t bound = bound_of(hardware);
    most_ = std::min(most_.load(), bound);
    GoldenSurface surface = surface_.get();
    if (surface.run.bound_hit || surface.run.triangles_emitted > bound) {
        surface = {};  // releases its memory
        surface = run_golden(base_, golden_.map(), parameters_, bound);
    }
    return tessera::compare(
        setup, surface, hardware,
        allowed_after(surface.run.largest_generation, setup, golden_.scene(), base_, allowed_triangles), progress);
}

EndToEndResult compare_end_to_end(const MachineSetup& setup, const GoldenInputs& inputs, const EmittedMesh& hardware) {
    const datapath::Formats& formats = setup.registers.formats;
    const golden::Parameters parameters = with_steps(inputs.parameters, formats.texture.fraction,
                                                     formats.normal.fraction, formats.view_distance.fraction);
    const GoldenSurface surface = run_golden(golden_base_triangles(setup), inputs.map, parameters, bound_of(hardware));
    return compare(setup, surface, hardware, {}, nullptr);
}

}  // namespace tessera

#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <future>
#include <vector>

#include "testbench/check/conformance/golden_inputs.h"
#include "testbench/check/conformance/golden_job.h"
#include "testbench/geometry/nearest_triangle.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Comparison of the hardware's mesh with the golden model's own, run end to end.
///
/// A decision that flips near its threshold changes the triangulation locally, of the same surface. Triangle counts and
/// distances measure the effect.
struct EndToEndResult {
    /// Distances from points on one surface (every vertex, every triangle's centroid) to the other.
    struct Distance {
        std::uint64_t points = 0;
        /// Points measured; fewer than all if that would take too long (surface_distance.h).
        std::uint64_t measured = 0;
        /// With the confidence below, at most this fraction of the points is farther away than the maximum.
        double unseen = 0;
        double farther = 0;                   ///< percent of the measured points farther away than Allowed::rounding
        double max_world = 0, rms_world = 0;  ///< the machine's world units
        double max_position_lsb = 0, rms_position_lsb = 0;  ///< LSB of the position's format
        double max_model = 0, rms_model = 0;                ///< the model's units
    };
    /// The allowed differences: rounding moves points of the surface, and parts of the surface may be triangulated
    /// differently, since decisions flip near their thresholds. Model units.
    struct Allowed {
        double triangles = 100;      ///< percent more or fewer
        double rounding = INFINITY;  ///< largest movement of a vertex by rounding
        double displacement = 0;     ///< largest distance of two displacements of one base surface point
    };

    static constexpr double confidence = 0.999;

    std::uint64_t hardware_triangles = 0;
    std::uint64_t golden_triangles = 0;
    std::uint64_t golden_edges = 0;  ///< evaluated
    int golden_largest_generation = 0;
    std::uint64_t bound = 0;  ///< triangles at which golden's run stops: 4 * hardware's + 1000
    bool bound_hit = false;   ///< golden's run stopped: its mesh is incomplete, no distances

    Distance hardware_to_golden;
    Distance golden_to_hardware;
    Allowed allowed;

    /// Excess of golden's triangles over the hardware's, in percent of the hardware's.
    double more_triangles() const;
    double rms_model() const { return std::max(hardware_to_golden.rms_model, golden_to_hardware.rms_model); }
    double max_model() const { return std::max(hardware_to_golden.max_model, golden_to_hardware.max_model); }
    double farther() const { return std::max(hardware_to_golden.farther, golden_to_hardware.farther); }
    /// Percent of the points. An edge with the opposite decision adds one triangle per side, two of N in all. It
    /// affects its own vertex and the centroids of at most four triangles per side: 9 of the 1.5 N points.
    double allowed_farther() const { return 3 * allowed.triangles; }
    /// From the points within `rounding` and the points farther away, which are within `displacement`.
    double allowed_rms_model() const { return allowed.rounding + std::sqrt(farther() / 100) * allowed.displacement; }
    /// The least Allowed::triangles with which these numbers pass.
    double least_allowed() const { return std::max(std::abs(more_triangles()), farther() / 3); }
    bool empty() const { return hardware_to_golden.measured == 0 || golden_to_hardware.measured == 0; }
    bool passed() const;
};

/// The surface of golden's own run.
struct GoldenSurface {
    TriangleSoup triangles;
    golden::Tessellation run;

    void add(const golden::Triangle& triangle);
};

/// Runs golden from the job itself (GoldenJob) and judges the result. Camera, heights, normal map and thresholds are
/// golden's own; positions and normals are not rounded. Map values (to codes) and texture coordinates are rounded as in
/// the hardware (the base's to nearest, midpoints down): reading a texel is discontinuous, so that otherwise one LSB of
/// t could select another texel.
///
/// The run begins at once, beside the simulation, whose mesh then bounds it. The result depends on the meshes alone.
class GoldenRun {
  public:
    /// `golden` must outlive it.
    /// `base_triangles`: indices of those triangles of the mesh that the machine received (SetupResult).
    /// `most`: number of triangles at which the run waits for the hardware's mesh.
    GoldenRun(const GoldenJob& golden, const std::vector<std::uint32_t>& base_triangles,
              std::uint64_t most = UINT64_MAX);
    ~GoldenRun();
    GoldenRun(const GoldenRun&) = delete;
    GoldenRun& operator=(const GoldenRun&) = delete;

    /// Call once only.
    /// `allowed_triangles`: in percent; infinite if values of the machine saturated, since golden's do not.
    /// `progress`: called with the fraction done, 0..1; may be null.
    /// Where both split the same triangles, a point of one surface lies within r of the other. The other points are at
    /// most a fraction f of all (allowed_farther) and lie within h. Hence
    ///     points farther than r <= f      RMS <= r + sqrt(points farther than r) h
    /// r: per axis, after G generations, (G / 2 + 2) LSB of the position plus 2 (G + 1) LSB of the normal times the
    /// largest displacement; the second term is 0 for a plane perpendicular to an axis, whose normals are exact. h: at
    /// a point of a base triangle, |a n - b m| <= |a - b| + |b| |n - m| for displacements a, b along normals n, m of
    /// the triangle.
    EndToEndResult compare(const MachineSetup& setup, const EmittedMesh& hardware, double allowed_triangles,
                           const std::function<void(double)>& progress = nullptr);

  private:
    const GoldenJob& golden_;
    golden::Parameters parameters_;
    std::vector<std::array<golden::Vertex, 3>> base_;
    std::atomic<std::uint64_t> most_;
    std::future<GoldenSurface> surface_;  // last: the run reads the others
};

/// Runs golden from the machine's own registers, tables and base triangles, dequantised. Not judged. Both are
/// deterministic, multi-threaded, and take about 200 bytes per triangle of both meshes together.
EndToEndResult compare_end_to_end(const MachineSetup& setup, const GoldenInputs& inputs, const EmittedMesh& hardware);

}  // namespace tessera

#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "testbench/check/conformance/golden_inputs.h"
#include "testbench/check/conformance/golden_job.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// The hardware's mesh against the golden model's own, run end to end.
///
/// A decision that flips near its threshold leads to another local mesh of the same surface: counts and
/// distances tell how much that amounts to.
struct EndToEndResult {
    /// From points on one surface (every vertex, every triangle's centroid) to the nearest point of the
    /// other.
    struct Distance {
        std::uint64_t points = 0;
        /// Of the points; fewer than all where that would take too long (surface_distance.h).
        std::uint64_t measured = 0;
        /// With the confidence below, at most this part of the points is farther away than the maximum.
        double unseen = 0;
        double farther = 0;  ///< percent of those measured, farther away than Allowed::rounding
        double max_world = 0, rms_world = 0;                ///< the machine's world units
        double max_position_lsb = 0, rms_position_lsb = 0;  ///< LSB of the position's format
        double max_model = 0, rms_model = 0;                ///< the model's units
    };
    /// What the result is judged by: rounding moves a point of the surface a little, and a part of the surface may be
    /// triangulated otherwise, since decisions flip near their thresholds. Model units.
    struct Allowed {
        double triangles = 100;      ///< percent: more or fewer
        double rounding = INFINITY;  ///< the farthest that rounding moves a vertex
        double displacement = 0;     ///< between two displacements of one point of the base surface
    };

    static constexpr double confidence = 0.999;

    std::uint64_t hardware_triangles = 0;
    std::uint64_t golden_triangles = 0;
    std::uint64_t golden_edges = 0;  ///< evaluated
    int golden_largest_generation = 0;
    std::uint64_t bound = 0;  ///< triangles at which golden's run gives up: 4 * hardware's + 1000
    bool bound_hit = false;   ///< it did: golden's mesh is incomplete, no distances

    Distance hardware_to_golden;
    Distance golden_to_hardware;
    Allowed allowed;

    /// Golden's triangles beyond the hardware's, in percent of these.
    double more_triangles() const;
    double rms_model() const { return std::max(hardware_to_golden.rms_model, golden_to_hardware.rms_model); }
    double max_model() const { return std::max(hardware_to_golden.max_model, golden_to_hardware.max_model); }
    double farther() const { return std::max(hardware_to_golden.farther, golden_to_hardware.farther); }
    /// Percent of the points. An edge decided otherwise adds a triangle on each of its sides, two of N. It
    /// moves its own vertex and the centroids of at most four triangles a side: 9 of the 1.5 N points.
    double allowed_farther() const { return 3 * allowed.triangles; }
    /// The points within `rounding` and those farther away, which are within `displacement`.
    double allowed_rms_model() const {
        return allowed.rounding + std::sqrt(farther() / 100) * allowed.displacement;
    }
    bool passed() const;
};

/// Golden from the job itself (GoldenJob), judged. Camera, heights, normal map and thresholds are golden's
/// own, positions and normals are not rounded. Map values (to codes) and texture coordinates are, as in the
/// hardware (the base's to nearest, midpoints down): reading a texel is discontinuous, so that without it an
/// LSB would decide on a whole texel.
/// `progress`: told the part done, 0..1, now and then; null: nobody.
/// `base_triangles`: which of the mesh's triangles the machine was given (SetupResult).
/// `allowed_triangles`: in percent; infinite where the machine's values saturated, which golden's do not.
/// Where both cut the same triangles, a point of one surface lies within r of the other; the rest is at most
/// a share f of the points (allowed_farther), and lies within h. So
///     points farther than r <= f      RMS <= r + sqrt(points farther than r) h
/// r: per axis (G / 2 + 2) LSB of the position after G generations and, by the normal, 2 (G + 1) LSB of it
/// times the largest displacement; nothing by the normals of a plane across an axis, which are exact. h: over
/// one point of the base surface, |a n - b m| <= |a - b| + |b| |n - m| for displacements a, b along normals
/// n, m of one base triangle.
EndToEndResult compare_end_to_end(const MachineSetup& setup, const GoldenJob& golden,
                                  const std::vector<std::uint32_t>& base_triangles,
                                  const EmittedMesh& hardware, double allowed_triangles,
                                  const std::function<void(double)>& progress = nullptr);

/// Golden from the machine's own registers, tables and base triangles, dequantised. Not judged. Both are
/// deterministic, on both cores, and take about 300 bytes per triangle of both meshes together.
EndToEndResult compare_end_to_end(const MachineSetup& setup, const GoldenInputs& inputs,
                                  const EmittedMesh& hardware);

}  // namespace tessera

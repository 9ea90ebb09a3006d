#pragma once
#include <cstdint>

#include "testbench/check/golden_inputs.h"
#include "testbench/host/emitted_mesh.h"
#include "testbench/host/setup.h"

namespace tessera {

/// The hardware's mesh against the golden model's own, run end to end from the same base triangles.
///
/// A decision that flips near its threshold leads to another local mesh of the same surface: counts and
/// distances tell how much that amounts to. They are measured, not judged.
struct EndToEndResult {
    /// From points on one surface (every vertex, every triangle's centroid) to the nearest point of the
    /// other.
    struct Distance {
        std::uint64_t points = 0;
        std::uint64_t measured =
            0;  ///< of them; fewer than all where that would take too long (surface_distance.h)
        double unseen =
            0;  ///< with the confidence below, at most this part of the points is farther away than the maximum
        double max_world = 0, rms_world = 0;                ///< the machine's world units
        double max_position_lsb = 0, rms_position_lsb = 0;  ///< LSB of the position's format
        double max_model = 0, rms_model = 0;                ///< the model's units
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
};

/// Deterministic, on both cores. Memory: about 300 bytes per triangle of both meshes together.
EndToEndResult compare_end_to_end(const Setup& setup, const GoldenInputs& inputs,
                                  const EmittedMesh& hardware);

}  // namespace tessera

#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "testbench/common/random.h"

namespace tessera {

/// The result of random edges.
struct EdgeTrial {
    static constexpr std::uint64_t edges_a_machine = 5000;

    std::uint64_t edges = 0;
    std::uint64_t machines = 0;               ///< sets of formats, map, registers
    std::uint64_t moved = 0;                  ///< edges tried again, shifted by whole periods
    std::array<std::uint64_t, 6> yes{};       ///< by test, in the order of TestBits
    std::array<std::uint64_t, 4> at_limit{};  ///< the value equals its threshold: NT, height test, VT, HT
    std::uint64_t splits = 0;
    std::uint64_t behind = 0;           ///< edges with an end on or behind the near plane
    std::uint64_t degenerate = 0;       ///< inserted vertices whose normal has no direction
    std::uint64_t unlike_reversed = 0;  ///< decision or inserted vertex differs from the other end
    std::uint64_t unlike_moved = 0;     ///< differs when shifted by whole periods
    std::uint64_t unlike_direct = 0;    ///< differs from the definitions, or does not fit its declared width
    std::string first_fault;            ///< with all operands; empty: none

    std::uint64_t faults() const { return unlike_reversed + unlike_moved + unlike_direct; }
};

/// Tries each edge from both ends, with different third vertices, and against the definitions (direct_edge.h); of the
/// height tests the Summed Height Test only. Formats are usual, narrow, wide, any in turn. Of every four thresholds one
/// equals the compared value and one is 1 less.
EdgeTrial try_random_edges(std::uint64_t seed, std::uint64_t edges);

}  // namespace tessera

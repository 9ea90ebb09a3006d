#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "testbench/common/random.h"

namespace tessera {

/// What random edges came to.
struct EdgeTrial {
    static constexpr std::uint64_t edges_a_machine = 5000;

    std::uint64_t edges = 0;
    std::uint64_t machines = 0;               ///< sets of formats, map, registers
    std::uint64_t moved = 0;                  ///< edges tried once more whole periods away
    std::array<std::uint64_t, 6> yes{};       ///< by test, in the order of TestBits
    std::array<std::uint64_t, 4> at_limit{};  ///< measure equal to its threshold: NT, SHT, VT, HT
    std::uint64_t splits = 0;
    std::uint64_t behind = 0;           ///< edges with an end on or behind the near plane
    std::uint64_t degenerate = 0;       ///< inserted vertices whose normal has no direction
    std::uint64_t unlike_reversed = 0;  ///< decided, or their vertex inserted, otherwise from the other side
    std::uint64_t unlike_moved = 0;     ///< otherwise whole periods away
    std::uint64_t unlike_direct = 0;    ///< otherwise than the definitions say
    std::string first_fault;            ///< with all operands; empty: none

    std::uint64_t faults() const { return unlike_reversed + unlike_moved + unlike_direct; }
};

/// Each edge from its one end and from its other, with whatever third vertex on either side, and against the
/// definitions (direct_edge.h). Formats in turn usual, narrow, wide, any. Of four thresholds one is exactly
/// what it is compared with and one is 1 less.
EdgeTrial try_random_edges(std::uint64_t seed, std::uint64_t edges);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <string>

#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Whether the tessellation of a base mesh is closed, decided without looking at places: every vertex is known by its
/// descent, "inserted on the edge of these two", so two vertices that rounding puts on one place remain two.
///
/// Base vertices are one if they agree in P, N, T, handedness, and in t but for whole periods of a repeated
/// axis; an edge is known by its two ends and the way in t from one to the other. The datapath by itself is
/// run over the mesh. Each piece of a base edge must have the triangles on either side that its base edge
/// has, each inner edge one on each, and no edge may be split by one of its triangles and whole in another.
/// Every vertex must come out the same, all it carries, from all triangles that insert it.
/// For any formats, exactly: nothing is excused. It is a statement about the machine because the machine's mesh is the
/// datapath's, bit for bit, which is checked elsewhere.
struct LineageResult {
    std::uint64_t triangles = 0;
    std::uint64_t edges = 0;     ///< evaluated
    std::uint64_t vertices = 0;  ///< distinct
    std::uint64_t cracks = 0;    ///< edges without the triangles they should have
    std::uint64_t t_vertices = 0;
    std::uint64_t unlike_vertices = 0;  ///< that come out differently from one side and the other
    std::string first_fault;            ///< empty: none

    bool passed() const { return cracks + t_vertices + unlike_vertices == 0; }
};

LineageResult check_lineage(const MachineSetup& setup);

}  // namespace tessera

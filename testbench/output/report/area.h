#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/timing/design.h"
#include "testbench/machine/simulation.h"

namespace tessera {

/// Hardware of one unit or memory of a design, counted from the design's parameters.
struct UnitArea {
    std::string name;               ///< "transform"
    std::uint64_t multipliers = 0;  ///< with one result per initiation interval; those for addresses are excluded
    /// Input buffers, pipeline registers, state: the widths of the items they hold; for a memory, the waiting
    /// addresses. Excluded: control, and a cache's bookkeeping.
    std::uint64_t register_bits = 0;
    /// A table's entries, or those in its cache (without tags), or the Triangle Queue's places on chip.
    std::uint64_t memory_bits = 0;
    std::uint64_t ports = 0;  ///< of a table: entries per cycle, all banks together
};

/// In the order of the figures; the units of several Tessellation Tests are added up. queue_places: the Triangle
/// Queue's places on chip; for an unbounded queue, as many as a run needed.
std::vector<UnitArea> design_area(const Design& design, const datapath::Registers& registers, std::size_t queue_places);

/// The area of a run's design, all machines together.
std::vector<UnitArea> area_of(const Simulation& simulation);

/// The sum, named "total".
UnitArea total_area(const std::vector<UnitArea>& units);

/// Multiplications of the datapath's functions (modules/datapath/README.md).
struct Multiplications {
    static constexpr unsigned normalise = 12, bump = 15 + normalise, displace = 4;
    static constexpr unsigned transform = 15, transform_normal = 9, light = 4, faces_away = 2;
    static constexpr unsigned summed_height_limit = 2, curvature_measure = 6, highlight_test = 9, interpolate = 3;
};

}  // namespace tessera

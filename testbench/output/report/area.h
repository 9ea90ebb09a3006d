#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/timing/design.h"
#include "testbench/machine/simulation.h"

namespace tessera {

/// The widths of a multiplication's operands in bits, the wider first.
using OperandWidths = std::pair<int, int>;

/// Hardware of one unit or memory of a design, counted from the design's parameters.
struct UnitArea {
    std::string name;  ///< "transform"
    /// With one result per initiation interval; those for addresses are excluded.
    std::map<OperandWidths, std::uint64_t> multipliers{};
    /// Input buffers, pipeline registers, state: the widths of the items they hold; for a memory, the waiting
    /// addresses. Excluded: control, and a cache's bookkeeping.
    std::uint64_t register_bits = 0;
    /// A table's entries, or those in its cache (without tags), once for each port of a bank; or the Triangle Queue's
    /// places on chip, none if it is unbounded. A memory of the usual cells has one read port, so that p ports take p
    /// copies, written together (LaForest and Steffan, Efficient Multi-Ported Memories for FPGAs, FPGA 2010). Banks
    /// divide the entries.
    std::uint64_t memory_bits = 0;
    std::uint64_t ports = 0;  ///< of a table: entries per cycle, all banks together

    std::uint64_t multiplier_count() const;
    /// One bit for each bit of one operand and bit of the other: about what a multiplier's area is proportional to.
    std::uint64_t partial_product_bits() const;
};

/// In the order of the figures; the units of several Tessellation Tests are added up.
std::vector<UnitArea> design_area(const Design& design, const datapath::Registers& registers);

/// The area of a run's design, all machines together.
std::vector<UnitArea> area_of(const Simulation& simulation);

/// The sum, named "total".
UnitArea total_area(const std::vector<UnitArea>& units);

/// The multiplications of the datapath's functions (modules/datapath/README.md), one element each.
struct Multiplications {
    const datapath::Formats& f;
    using List = std::vector<OperandWidths>;

    List normalise(int component_bits) const;
    List bump() const;  ///< with its normalise
    List displace() const;
    List transform() const;
    List transform_normal() const;
    List light() const;
    List faces_away() const;
    List summed_height_limit() const;
    List curvature_measure() const;
    List highlight_test() const;
    List interpolate() const;  ///< one value
};

}  // namespace tessera

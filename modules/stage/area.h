#pragma once
#include <cstdint>
#include <map>

#include "modules/datapath/multiplications.h"
#include "modules/sockets/items.h"
#include "modules/timing/design.h"

namespace tessera {

/// Hardware of a unit or memory, counted from its parameters.
struct Area {
    /// With one result per initiation interval; those for addresses are excluded.
    std::map<datapath::OperandWidths, std::uint64_t> multipliers{};
    /// Input buffers, pipeline registers, state: the widths of the items they hold; for a memory, the waiting
    /// addresses. Excluded: control, and a cache's bookkeeping.
    std::uint64_t register_bits = 0;
    /// A table's entries, or those in its cache (without tags), once for each port of a bank; or the Triangle Queue's
    /// places on chip, none if it is unbounded. A memory of the usual cells has one read port, so that p ports take p
    /// copies, written together (LaForest and Steffan, Efficient Multi-Ported Memories for FPGAs, FPGA 2010). Banks
    /// divide the entries.
    std::uint64_t memory_bits = 0;
    std::uint64_t ports = 0;  ///< of a table: entries per cycle, all banks together

    /// Multipliers for these multiplications, in `copies` pipelines. An interval above one reuses a multiplier for as
    /// many multiplications, the widest of which it fits.
    void multiply(const datapath::Multiplications& multiplications, unsigned interval = 1, unsigned copies = 1);
    Area& operator+=(const Area& more);

    std::uint64_t multiplier_count() const;
    /// One bit for each bit of one operand and bit of the other: about what a multiplier's area is proportional to.
    std::uint64_t partial_product_bits() const;
};

/// The widths of items in a design, with the tag of timed mode.
struct ItemWidths {
    explicit ItemWidths(const UnitContext& context)
        : formats(context.registers.formats), tag(tag_bits(context.design)) {}

    template <class Item>
    std::uint64_t of() const {
        return item_bits<Item>(formats, tag);
    }

    const datapath::Formats& formats;
    int tag;
};

}  // namespace tessera

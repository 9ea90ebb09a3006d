#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/datapath/parameters.h"
#include "modules/timing/timing.h"

namespace tessera {

/// The mapping from a table's entries to its banks.
///
/// entry:        entry k, counted row by row, lies in bank k mod `banks`. If `banks` is a power of two and the pitch
///               one more than a multiple of it, as for a Summed Height Table, two corners of each square share a bank.
/// exclusive_or: bit b of the bank is the parity of selected bits of the column and of the row. Of the lowest bits of
///               the column, as many as the bank number has, bit b occurs only in the mask of bank bit b, so that the
///               column's other bits and the row address an entry within its bank.
class BankOfEntry {
  public:
    struct Masks {
        std::uint32_t column;
        std::uint32_t row;
    };
    /// The masks of bank bit b. A search that changes one or two bits at a time, from 24 random starts, found them: for
    /// the fewest cycles of an edge's twelve reads, summed over 2 to 64 banks, with edges of all lengths up to 250
    /// texels, half of them powers of two, a third parallel to each axis. With 4, 8, 16 banks an edge takes 4.1, 2.9,
    /// 2.3 cycles; interleaved by entry 5.2, 4.2, 3.6; with random banks 5.2, 3.8, 3.0.
    static constexpr std::array<Masks, 6> masks{
        {{0x041, 0x0cd}, {0x142, 0x1b4}, {0x184, 0x127}, {0x188, 0x1fa}, {0x010, 0x0b7}, {0x120, 0x022}}};

    BankOfEntry(const MemoryTiming& timing, const datapath::TableLayout& layout)
        : base_(layout.base),
          entry_bytes_(layout.entry_bytes),
          columns_(layout.columns),
          banks_(timing.banks),
          interleave_(timing.interleave) {}

    /// Sets the table's number of columns.
    void lay_out(std::uint32_t columns) { columns_ = columns; }

    std::size_t operator()(std::uint64_t address) const {
        if (banks_ == 1)
            return 0;
        const std::uint64_t entry = (address - base_) / entry_bytes_;
        if (interleave_ == Interleave::entry)
            return entry % banks_;
        return of(static_cast<std::uint32_t>(entry % columns_), static_cast<std::uint32_t>(entry / columns_), banks_);
    }

    /// The bank of an entry with exclusive_or.
    static constexpr std::size_t of(std::uint32_t column, std::uint32_t row, unsigned banks) {
        std::size_t bank = 0;
        for (std::size_t b = 0; (1u << b) < banks; ++b)
            bank |= static_cast<std::size_t>(__builtin_parity((column & masks[b].column) ^ (row & masks[b].row))) << b;
        return bank;
    }

  private:
    std::uint64_t base_;
    std::uint32_t entry_bytes_;
    std::uint32_t columns_;
    unsigned banks_;
    Interleave interleave_;
};

}  // namespace tessera

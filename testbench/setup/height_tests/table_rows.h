#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/parameters.h"
#include "testbench/common/error.h"
#include "testbench/setup/prepared_scene.h"

namespace tessera {

/// Writes row by row; calls entry(x, y) for column x of row y in this order. Throws InputError if one does not fit.
template <class Entry>
void write_rows(const datapath::TableLayout& layout, const TableSink& sink, Entry entry) {
    std::vector<unsigned char> bytes(std::size_t{layout.columns} * layout.entry_bytes);
    for (std::uint32_t y = 0; y < layout.rows; ++y) {
        for (std::uint32_t x = 0; x < layout.columns; ++x) {
            const std::uint64_t value = entry(x, y);
            if (layout.entry_bytes < sizeof value && value >> (8 * layout.entry_bytes) != 0)
                throw InputError("entry (" + std::to_string(x) + ", " + std::to_string(y) + ") of a table is " +
                                 std::to_string(value) + ", but an entry has " + std::to_string(layout.entry_bytes) +
                                 " bytes");
            for (std::uint32_t k = 0; k < layout.entry_bytes; ++k)
                bytes[std::size_t{x} * layout.entry_bytes + k] = static_cast<unsigned char>(value >> (8 * k));
        }
        sink(layout.address(0, y), bytes.data(), bytes.size());
    }
}

}  // namespace tessera

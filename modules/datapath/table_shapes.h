#pragma once
#include "modules/datapath/height_tests.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/parameters.h"

namespace tessera::datapath {

/// Columns, rows and entries of the three tables, which follow from the other registers; their bases stay.
inline void shape_tables(Registers& r) {
    r.displacement_map = {r.displacement_map.base, r.map.width, r.map.height, entry_bytes(r.formats.displacement.bits)};
    r.normal_map = {r.normal_map.base, r.map.width, r.map.height, entry_bytes(3 * r.formats.normal.bits)};
    TableLayout& table = r.height_table;
    table.entry_bytes = entry_bytes(height_entry_bits(r.formats));
    functions_of(r.formats.height_test).shape(r, table);
}

}  // namespace tessera::datapath

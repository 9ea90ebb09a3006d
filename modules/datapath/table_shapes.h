#pragma once
#include "modules/datapath/curvature.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/mipmap.h"
#include "modules/datapath/parameters.h"

namespace tessera::datapath {

/// Columns, rows and entries of the three tables, which follow from the other registers; their bases stay.
constexpr void shape_tables(Registers& r) {
    r.displacement_map = {r.displacement_map.base, r.map.width, r.map.height, entry_bytes(r.formats.displacement.bits)};
    r.normal_map = {r.normal_map.base, r.map.width, r.map.height, entry_bytes(3 * r.formats.normal.bits)};
    TableLayout& table = r.height_table;
    table.entry_bytes = entry_bytes(height_entry_bits(r.formats));
    switch (r.formats.height_test) {
        case HeightTest::summed_height:
            table.columns = r.map.width + 1;
            table.rows = r.map.height + 1;
            break;
        case HeightTest::rank:
            table.columns = r.covered.columns;
            table.rows = r.covered.rows;
            break;
        case HeightTest::curvature:  // cells of all levels, in one row
            table.columns =
                r.covered.columns == 0 ? 0 : static_cast<std::uint32_t>(curvature_entries(covered_texels(r)));
            table.rows = 1;
            break;
        case HeightTest::mipmap:  // blocks of all levels, likewise
            table.columns = static_cast<std::uint32_t>(mipmap_entries(r.map));
            table.rows = 1;
            break;
    }
}

}  // namespace tessera::datapath

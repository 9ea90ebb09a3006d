#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include "modules/datapath/format.h"
#include "modules/timing/timing.h"

namespace tessera {

/// A test that a design may have as its height test, each with its own table: its names, timing, and reads per edge.
/// One entry for each datapath::HeightTest, the paper's Summed Height Test first.
struct HeightTestKind {
    std::string_view name;  ///< value of the key hardware.height_test
    const char* title;
    const char* unit;   ///< module name of the unit
    const char* table;  ///< module name of the table
    UnitTiming Timing::*unit_timing;
    MemoryTiming Timing::*table_timing;
    unsigned requests;  ///< requests to the table, unless codes are read
    unsigned codes;     ///< displacement map entries read instead for a short edge; 0: none
    bool rectangles;    ///< a request reads the corners of a rectangle; otherwise one entry
    unsigned feature;   ///< its bit of the device's register `features`; 0: none
};

inline constexpr std::array<HeightTestKind, 4> height_test_kinds = {{
    {"summed_height", "Summed Height Test", "summed_height_test", "summed_height_table", &Timing::summed_height_test,
     &Timing::summed_height_table, 3, 1, true, 0},
    {"rank", "Rank Test", "rank_test", "rank_table", &Timing::rank_test, &Timing::rank_table, 1, 0, false, 32},
    {"curvature", "Curvature Test", "curvature_test", "curvature_table", &Timing::curvature_test,
     &Timing::curvature_table, 1, 3, false, 64},
    {"mipmap", "Mipmap Test", "mipmap_test", "mipmap_table", &Timing::mipmap_test, &Timing::mipmap_table, 3, 0, false,
     4096},
}};

constexpr const HeightTestKind& kind_of(datapath::HeightTest test) {
    return height_test_kinds[static_cast<std::size_t>(test)];
}

/// Returns an empty name if there is no such test.
constexpr std::string_view name_of(datapath::HeightTest test) {
    const auto number = static_cast<std::size_t>(test);
    return number < height_test_kinds.size() ? height_test_kinds[number].name : std::string_view{};
}

}  // namespace tessera

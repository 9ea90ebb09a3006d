#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include "modules/datapath/format.h"
#include "modules/timing/timing.h"

namespace tessera {

/// What a design may have in the Summed Height Test's place, with a table of its own: names, figures, and what is read
/// for an edge. One entry for each datapath::HeightTest, the paper's first.
struct HeightTestKind {
    std::string_view name;  ///< of the key hardware.height_test
    const char* title;
    const char* unit;   ///< the modules' names
    const char* table;  ///< likewise
    UnitTiming Timing::*unit_timing;
    MemoryTiming Timing::*table_timing;
    unsigned requests;  ///< to the table, unless codes tell
    unsigned codes;     ///< entries of the displacement map that are read in its place, of a short edge; 0: none
    bool rectangles;    ///< a request is for the corners of a rectangle; else for one entry
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

/// Empty: there is no such test.
constexpr std::string_view name_of(datapath::HeightTest test) {
    const auto number = static_cast<std::size_t>(test);
    return number < height_test_kinds.size() ? height_test_kinds[number].name : std::string_view{};
}

}  // namespace tessera

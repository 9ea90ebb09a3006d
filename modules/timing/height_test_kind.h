#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include "modules/datapath/format.h"
#include "modules/datapath/height_tests.h"
#include "modules/timing/all_units.h"
#include "modules/timing/timing.h"

namespace tessera {

/// A test that a design may have as its height test, with its own table.
struct HeightTestKind {
    std::string_view name;  ///< value of the key hardware.height_test
    unsigned feature;       ///< its bit of the device's register `features`; 0: none
    const datapath::HeightTestFunctions* functions;
    const UnitSpec* spec;
    const MemorySpec* memory;
    const char* title = spec->title;
    const char* unit = spec->name;     ///< module name of the unit
    const char* table = memory->name;  ///< module name of the table
    UnitTiming Timing::*unit_timing = spec->timing;
    MemoryTiming Timing::*table_timing = memory->timing;
    bool rectangles = memory->rectangles;
};

/// One entry for each datapath::HeightTest, the paper's Summed Height Test first.
inline constexpr std::array<HeightTestKind, 4> height_test_kinds = {{
    {"summed_height", 0, &functions_of(datapath::HeightTest::summed_height), &named(all_units, "summed_height_test"),
     &named(all_table_memories, "summed_height_table")},
    {"rank", 32, &functions_of(datapath::HeightTest::rank), &named(all_units, "rank_test"),
     &named(all_table_memories, "rank_table")},
    {"curvature", 64, &functions_of(datapath::HeightTest::curvature), &named(all_units, "curvature_test"),
     &named(all_table_memories, "curvature_table")},
    {"mipmap", 4096, &functions_of(datapath::HeightTest::mipmap), &named(all_units, "mipmap_test"),
     &named(all_table_memories, "mipmap_table")},
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

#pragma once
#include "modules/datapath/height_tests.h"
#include "modules/timing/all_units.h"
#include "modules/timing/timing.h"

namespace tessera {

static_assert(datapath::HeightTestFunctions::most_latency == most_cycles);

/// The timing of a design's height test.
inline UnitTiming height_test_timing(const Timing& timing, const datapath::Formats& formats) {
    UnitTiming its = timing.height_test;
    if (its.latency == 0)
        its.latency = functions_of(formats.height_test).latency;
    return its;
}

/// The memory of its table. Its name is that of the keys; the module has the test's (HeightTestFunctions::table).
inline const MemorySpec& height_table_spec(const datapath::Formats& formats) {
    return named(all_table_memories,
                 functions_of(formats.height_test).rectangles ? "summed_height_table" : "height_table");
}
inline const MemoryTiming& height_table_timing(const Timing& timing, const datapath::Formats& formats) {
    return timing.*height_table_spec(formats).timing;
}

}  // namespace tessera

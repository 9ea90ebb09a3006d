#pragma once
#include <systemc>

namespace tessera {

/// A unit's pipeline: cycles from an item's arrival to its departure, and between the arrivals of two items.
struct UnitTiming {
    unsigned latency = 1;
    unsigned interval = 1;
};

/// Clock period and the datasheet figures of every unit and memory, in cycles. The defaults are the paper's design
/// where it says (one table read a cycle, so four cycles a rectangle) and plain choices where it is silent.
struct Timing {
    sc_core::sc_time cycle{5, sc_core::SC_NS};
    UnitTiming get_triangle{1, 1};
    UnitTiming calculate_new_p{1, 1};
    UnitTiming displace_vertex{6, 1};  ///< normalise and multiply-accumulate; the map read comes on top
    UnitTiming transform{20, 1};
    UnitTiming calculate_new_u{1, 1};
    UnitTiming tex_coord_test{1, 1};
    UnitTiming summed_height_test{3, 1};  ///< differences, addresses, compare; the table reads come on top
    UnitTiming normal_test{9, 1};         ///< normalise, bump, normalise, compare; the map read comes on top
    UnitTiming view_test{1, 1};
    UnitTiming pass_or_tessellate{1, 1};
    UnitTiming tessellation{1, 1};
    UnitTiming triangle_queue{1, 1};
    UnitTiming lighting{4, 1};
    unsigned memory_read = 1;  ///< cycles for one entry of any of the three tables
};

}  // namespace tessera

#pragma once
#include <cstdint>

#include "modules/timing/random_stalls.h"

namespace tessera {

inline constexpr unsigned most_cycles = 1000000;  ///< of a latency or interval
inline constexpr unsigned most_places = 65536;    ///< of a buffer

/// A unit's pipeline, in cycles.
struct UnitTiming {
    unsigned latency = 1;   ///< from an item's start to its result, at least 1
    unsigned interval = 1;  ///< between the starts of two items, at least 1
    unsigned buffer = 1;    ///< items that may wait at its input, at least 1
};

/// The mapping from a table's entries to its banks (memories/interleave.h).
enum class Interleave {
    entry,         ///< consecutive entries in consecutive banks
    exclusive_or,  ///< exclusive ORs of bits of its column and row; banks: a power of two
};

/// A cache in front of a table that lies in off-chip memory.
struct CacheTiming {
    unsigned bytes = 0;        ///< 0: no cache, the table is on chip; less than a line: one line
    unsigned line_bytes = 64;  ///< a line holds as many entries as fit
    unsigned ways = 4;
    unsigned fills = 16;  ///< lines being filled, and requests that wait for one, at least 1
};

/// A memory's ports, in cycles.
struct MemoryTiming {
    unsigned ports = 1;    ///< entries per cycle, from each bank
    unsigned banks = 1;    ///< at most 64
    unsigned latency = 1;  ///< from an entry's address to its data
    unsigned width = 0;    ///< bytes a port moves in a cycle; 0: a whole entry
    unsigned buffer = 1;   ///< requests that may wait, at least 1
    Interleave interleave = Interleave::entry;
    unsigned window = 0;  ///< requests whose reads may overlap; 0: a request waits until each of its banks is free
    CacheTiming cache{};  ///< if present, ports, banks and latency are those of the cache
};

/// Off-chip memory, as the Triangle Queue sees it.
struct OffChipTiming {
    unsigned latency = 40;    ///< cycles from a request's last byte to its answer
    unsigned bandwidth = 16;  ///< bytes per cycle, both directions together
    unsigned buffer = 4;      ///< requests that may wait, at least 1

    /// Cycles in which the channel transfers this many bytes.
    constexpr std::uint64_t cycles(std::uint64_t bytes) const { return (bytes + bandwidth - 1) / bandwidth; }
};

/// Clock period and the datasheet figures of every unit and memory. Defaults follow the paper where it states them
/// (one port on the Summed Height Table: four cycles per rectangle; tests one edge after another). Declared only here;
/// configuration and reports refer to them.
struct Timing {
    unsigned cycle_picoseconds = 5000;  ///< the clock's period
    UnitTiming get_triangle{1, 1, 1};
    UnitTiming calculate_new_p{1, 1, 1};
    UnitTiming displace_vertex{6, 1, 1};  ///< normalise and multiply-accumulate; the map read comes on top
    UnitTiming transform{20, 1, 1};
    UnitTiming calculate_new_u{1, 1, 1};
    UnitTiming tex_coord_test{1, 1, 1};
    UnitTiming height_test{0, 1, 1};      ///< latency 0: the test's own; the table reads come on top
    UnitTiming normal_test{9, 1, 1};      ///< normalise, bump, normalise, compare; the map read comes on top
    unsigned highlight_test_latency = 1;  ///< N'.H: on top of the Normal Test's, in a design with a Highlight Test
    UnitTiming view_test{1, 1, 1};
    UnitTiming pass_or_tessellate{1, 1, 8};  ///< buffer: triangles that are not complete
    UnitTiming tessellation{1, 1, 1};
    UnitTiming triangle_queue{1, 1, 1};
    UnitTiming lighting{4, 1, 1};
    unsigned results_buffer = 4;  ///< results of a test that wait for the other tests of their edge
    unsigned edges_in_sequence =
        32;  ///< tests cheapest first: edges between their cheap tests' results and their departure
    MemoryTiming displacement_map;
    MemoryTiming normal_map;
    MemoryTiming summed_height_table;  ///< of a height test that reads rectangles
    MemoryTiming height_table;         ///< of any other
    OffChipTiming off_chip_memory;
    StallParameters stalls;

    /// Cycles from a request for table entries to their data, if nothing delays it and, with a cache, all lines miss.
    constexpr unsigned read_latency(const MemoryTiming& table) const {
        if (table.cache.bytes == 0)
            return table.latency;
        return table.latency + off_chip_memory.latency +
               static_cast<unsigned>(off_chip_memory.cycles(table.cache.line_bytes));
    }
};

}  // namespace tessera

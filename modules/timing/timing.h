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

/// Every unit in the order of the paper's figures, after a unit those that replace it: of one with a timing its name, the
/// defaults of its latency, interval and buffer, and the rest of its UnitSpec (all_units.h); of wires the name and the
/// rest. Latencies: for Displace Vertex those of a normalise and a multiply-accumulate, for the Normal Test of two normalises,
/// a bump and a compare; tables' reads come on top. Height test: 0 is the test's own. Pass or Tessellate's buffer:
/// triangles that are not complete.
// clang-format off
#define TESSERA_FOR_EACH_UNIT(UNIT, WIRES) \
    UNIT(get_triangle, 1, 1, 1, "Get Triangle", "takes a triangle from the queue, else from the host; sends its new parts down both branches, and the triangle itself to Pass or Tessellate", "-") \
    UNIT(calculate_new_p, 1, 1, 1, "Calculate New P", "midpoints of position, texture coordinate and normal", "add, shift", Place::geometry) \
    UNIT(displace_vertex, 6, 1, 1, "Displace Vertex", "normalises, reads d, P' = P + (S d + bias) N", "multiply-accumulate, normalise", Place::geometry, true) \
    UNIT(transform, 20, 1, 1, "Transform", "P' to the screen, N' to view space", "existing unit", Place::geometry, false, input_capacity, {}, &DesignOptions::transform_pipelines) \
    UNIT(calculate_new_u, 1, 1, 1, "Calculate New U", "t_ij", "add, shift", Place::lane) \
    UNIT(tex_coord_test, 1, 1, 1, "Tex Coord Test", "compares integer parts; includes the Generation Test", "compare", Place::lane) \
    UNIT(height_test, 0, 1, 1, "Height test", "", "", Place::tests_unit, true) \
    UNIT(normal_test, 9, 1, 1, "Normal Test", "N_ij, T_ij, N'_ij, six differences; includes the Highlight Test", "normalise, bump, compare", Place::lane, true, input_capacity, {"highlight_test_latency", &Timing::highlight_test_latency, "cycles", 0, most_cycles, "Highlight Test, if present: added to the Normal Test's latency"}) \
    UNIT(view_test, 1, 1, 1, "View Test", "Manhattan length; for a base triangle it waits for Transform", "add, compare", Place::lane) \
    WIRES(collect_tests, "Collect Tests", "joins an edge's four results into one item", "wires", Place::tests_unit, false, "", {"results_buffer", &Timing::results_buffer, "edges", 1, most_places, "Capacity of each input buffer of Collect Tests: results of one test that wait for the other three"}) \
    WIRES(sequence_tests, "Sequence Tests", "replaces it with `test_order = \"cheap_first\"`: sends an edge to the tests that its decision needs", "logic", Place::tests_unit, false, "", {"edges_in_sequence", &Timing::edges_in_sequence, "edges", 1, most_places, "With hardware.test_order = \"cheap_first\": capacity of Sequence Tests, in edges whose cheap tests are done"}) \
    UNIT(pass_or_tessellate, 1, 1, 8, "Pass or Tessellate", "joins both branches; decides, culls, forwards", "logic", Place::machine, false, "triangles that wait for parts from either branch") \
    UNIT(tessellation, 1, 1, 1, "Tessellation", "2, 3 or 4 children; sends a finished base triangle back unsplit", "wiring") \
    UNIT(triangle_queue, 1, 1, 1, "Triangle Queue", "waiting triangles: first or last in first out, on chip, spilling off chip", "memory") \
    UNIT(lighting, 4, 1, 1, "Lighting", "per-vertex light", "existing unit")
// clang-format on

/// Clock period and the datasheet figures of every unit and memory. Defaults follow the paper where it states them
/// (one port on the Summed Height Table: four cycles per rectangle; tests one edge after another). Declared only
/// here, but for the latencies of height tests (their files in modules/datapath); configuration and reports refer to them.
struct Timing {
    unsigned cycle_picoseconds = 5000;  ///< the clock's period
#define TESSERA_TIMING(name, latency, interval, buffer, ...) UnitTiming name{latency, interval, buffer};
#define TESSERA_NO_TIMING(...)
    TESSERA_FOR_EACH_UNIT(TESSERA_TIMING, TESSERA_NO_TIMING)
#undef TESSERA_TIMING
#undef TESSERA_NO_TIMING
    unsigned highlight_test_latency = 1;  ///< N'.H: on top of the Normal Test's, in a design with a Highlight Test
    unsigned results_buffer = 4;          ///< results of a test that wait for the other tests of their edge
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

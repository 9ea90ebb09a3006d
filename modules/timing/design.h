#pragma once
#include <algorithm>

#include "modules/datapath/parameters.h"
#include "modules/timing/all_units.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/timing/design_options.h"
#include "modules/timing/height_test_timing.h"
#include "modules/timing/timing.h"

namespace tessera {

/// The parameters fixed when the machine is built, as opposed to those set before a run (datapath::Registers).
struct Design : DesignOptions {
    Transport transport = Transport::blocking;
    Timing timing;
    /// The platform's clock, at whose rising edges cycles begin. Null: every timing.cycle_picoseconds, from time 0.
    const sc_core::sc_clock* clock = nullptr;
    /// Cycles for which a memory that a UnitFactory has joined, or the device's bus, may leave a request unanswered
    /// (sockets/answer_watch.h); 0: no limit.
    unsigned answer_cycles = 1'000'000;
    /// Each item goes through its packed form, for tests: slow, but data outside its fields are lost, and a value that
    /// does not fit is an error. Not tied to NDEBUG, which a client sets for itself: nothing in an installed header is.
    bool packed_streams = false;
};

/// Register stages of a pipeline, over all servers. further_stages: cycles that an item spends outside (in a memory)
/// while others follow it.
constexpr unsigned register_stages(const UnitTiming& timing, unsigned servers = 1, unsigned further_stages = 0) {
    return servers * std::max(1u, (timing.latency + further_stages + timing.interval - 1) / timing.interval);
}

/// Latency of the height test's reads: from its table or, for codes, from the displacement map.
inline unsigned height_test_latency(const Design& design, const datapath::Formats& formats) {
    const Timing& t = design.timing;
    const MemoryTiming& its = height_table_timing(t, formats);
    // If the table overlaps the reads of `window` rectangles, there are places for their edges: those for the latency
    // alone would be four, half of the rectangles that a window of 24 overlaps.
    const unsigned table = t.read_latency(its) + its.window / 3;
    return functions_of(formats.height_test).reads_codes(formats) ? std::max(table, t.read_latency(t.displacement_map))
                                                                  : table;
}

/// Whether the displacement map is an on-chip dual-port memory, read by Displace Vertex and by the height test.
inline bool displacement_map_has_two_sides(const Design& design, const datapath::Formats& formats) {
    return functions_of(formats.height_test).second_side && design.timing.displacement_map.cache.bytes == 0;
}

/// Latency of Displace Vertex's reads: from the displacement map and, in the family design, from the normal map.
constexpr unsigned displace_vertex_latency(const Design& design) {
    const Timing& t = design.timing;
    const unsigned map = t.read_latency(t.displacement_map);
    return design.work == Work::family ? std::max(map, t.read_latency(t.normal_map)) : map;
}

/// Most triangles that have left the queue but of which no part has reached Pass or Tessellate: one in Get Triangle,
/// and one for each place in the units between. Pass or Tessellate has room for that many to wait for their parts.
constexpr unsigned triangles_ahead_of_parts(const Design& design) {
    unsigned triangles = 1 + 1;
    for (const UnitSpec& unit : all_units) {
        if (unit.place != Place::geometry)
            continue;
        const UnitTiming& its = design.timing.*unit.timing;
        const unsigned pipelines = unit.pipelines == nullptr ? 1 : design.*unit.pipelines;
        triangles +=
            its.buffer + register_stages(its, pipelines, unit.reads_tables ? displace_vertex_latency(design) : 0);
    }
    return triangles;
}

/// Width of a triangle's tag: enough to distinguish all triangles between Get Triangle and Pass or Tessellate: those
/// that wait there, one that Get Triangle still offers, and those whose parts have begun to arrive.
constexpr int tag_bits(const Design& design) {
    // In the family design one triangle is being joined in Tessellation, and one is being tested.
    const unsigned triangles = triangles_ahead_of_parts(design) + 1 + design.timing.pass_or_tessellate.buffer +
                               (design.work == Work::family ? 2 : 0);
    return datapath::bits_for(triangles);
}

/// Width of the tag in a run. In functional mode, where any number of triangles may overtake a waiting one, the tag is
/// the pass number itself.
constexpr int tag_bits_in_use(const Design& design) {
    return design.transport == Transport::blocking ? 32 : tag_bits(design);
}

/// The arguments from which a unit is built. `registers` must outlive the unit, and may change between runs; `design`
/// is read only while it is built.
struct UnitContext {
    CycleScheduler& clock;
    const datapath::Registers& registers;
    const Design& design;
    unsigned tests_unit = 0;  ///< number of the Tessellation Tests unit that the unit is in

    const Timing& timing() const { return design.timing; }
    /// The same, with another design or other registers.
    UnitContext with(const Design& other) const { return {clock, registers, other, tests_unit}; }
    UnitContext with(const datapath::Registers& other) const { return {clock, other, design, tests_unit}; }
};

}  // namespace tessera

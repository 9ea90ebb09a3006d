#pragma once
#include <algorithm>
#include <string>
#include <utility>

#include "modules/timing/all_units.h"
#include "modules/timing/design_options.h"
#include "modules/timing/timing.h"

namespace tessera {

/// The range of a parameter, both ends included.
struct DesignRange {
    unsigned least;
    unsigned most;
};

/// The name of a member of Timing or DesignOptions, and its key's.
struct DesignName {
    std::string member;  ///< as in `normal_map.cache.bytes`
    std::string key;     ///< the same with underscores, unless given

    DesignName(std::string its_member, std::string its_key) : member(std::move(its_member)), key(std::move(its_key)) {}
    DesignName(std::string its_member) : member(std::move(its_member)), key(member) {  // NOLINT: a name is a string
        std::replace(key.begin(), key.end(), '.', '_');
    }
    DesignName(const char* its_member) : DesignName(std::string(its_member)) {}  // NOLINT: likewise
};

inline constexpr unsigned most_triangles = 2147483647;

/// Declares a unit's timing parameters.
template <typename Keys>
void declare_unit_keys(const Keys& key, const UnitSpec& spec) {
    const std::string name(spec.name), title = spec.title;
    if (const auto unit = spec.timing; unit != nullptr) {
        key.add_number(
            name + ".latency", [unit](auto& t) -> auto& { return (t.*unit).latency; }, "cycles",
            {name == height_test_unit ? 0u : 1u, most_cycles},
            title + ": latency, from an item's start to its result" +
                (spec.reads_tables ? ", not including table reads" : "") +
                (name == height_test_unit ? "; 0: the test's own (modules/README.md)" : ""));
        key.add_number(
            name + ".interval", [unit](auto& t) -> auto& { return (t.*unit).interval; }, "cycles", {1, most_cycles},
            title + ": initiation interval");
        key.add_number(
            name + ".buffer", [unit](auto& t) -> auto& { return (t.*unit).buffer; }, "items", {1, most_places},
            title + ": " + spec.buffer);
    }
    if (const UnitParameter& further = spec.further; further.name != nullptr)
        key.add_number(
            further.name, [member = further.member](auto& t) -> auto& { return t.*member; }, further.unit,
            {further.least, further.most}, further.meaning);
}

template <typename Keys>
void declare_memory_keys(const Keys& key, const MemorySpec& spec) {
    const std::string leaf(spec.name), name = spec.title;
    const auto memory = spec.timing;
    key.add_number(
        leaf + ".ports", [memory](auto& t) -> auto& { return (t.*memory).ports; }, "entries per cycle", {1, 64},
        name + ": ports of each bank");
    key.add_number(
        leaf + ".banks", [memory](auto& t) -> auto& { return (t.*memory).banks; }, "-", {1, 64}, name + ": banks");
    key.add_number(
        leaf + ".latency", [memory](auto& t) -> auto& { return (t.*memory).latency; }, "cycles", {0, most_places},
        name + ": latency, from an entry's address to its data");
    key.add_number(
        leaf + ".width", [memory](auto& t) -> auto& { return (t.*memory).width; }, "bytes per cycle", {0, 64},
        name + ": width of a port; 0: a whole entry");
    key.add_number(
        leaf + ".buffer", [memory](auto& t) -> auto& { return (t.*memory).buffer; }, "requests", {1, most_places},
        name + ": capacity of its request buffer");
    key.add_number(
        leaf + ".cache.bytes", [memory](auto& t) -> auto& { return (t.*memory).cache.bytes; }, "bytes", {0, 1 << 30},
        name +
            ": size of the cache in front of it, rounded down to whole sets of lines, at least a line, at most the table; "
            "the cache has the ports, banks and latency above, and the table is in off-chip memory; 0: the table is on "
            "chip");
    key.add_number(
        {leaf + ".cache.line_bytes", leaf + "_line_bytes"},
        [memory](auto& t) -> auto& { return (t.*memory).cache.line_bytes; }, "bytes", {1, 4096},
        name + ": size of a cache line, rounded down to whole entries, at least one");
    key.add_number(
        leaf + ".cache.ways", [memory](auto& t) -> auto& { return (t.*memory).cache.ways; }, "lines", {1, 64},
        name + ": associativity of its cache");
    key.add_number(
        leaf + ".cache.fills", [memory](auto& t) -> auto& { return (t.*memory).cache.fills; }, "lines",
        {1, most_places},
        name + ": largest number of outstanding fills of its cache, and of requests that wait for them");
    if (!spec.rectangles)
        return;
    key.template add_choice<Interleave>(
        leaf + ".interleave", [memory](auto& t) -> auto& { return (t.*memory).interleave; },
        name +
            ": how entries are assigned to banks. entry: one after another; xor: by exclusive ORs of bits "
            "of column and row (the number of banks is then a power of two)");
    key.add_number(
        leaf + ".window", [memory](auto& t) -> auto& { return (t.*memory).window; }, "rectangles", {0, most_places},
        name + ": rectangles whose reads may overlap; 0: a rectangle is read when all of its banks are free");
}

/// Declares the members of Timing as keys of a job file, or as parameters of a configuration of another kind, with one
/// call for each:
///   key.add_number(name, member, unit, range, description)
///   key.add_choice<Enum>(name, member, description)
/// member(timing) is a reference to the member.
template <typename Keys>
void declare_timing_keys(const Keys& key) {
    key.add_number(
        {"cycle_picoseconds", "clock_period"}, [](auto& t) -> auto& { return t.cycle_picoseconds; }, "picoseconds",
        {1, 1000000000}, "Clock period");
    for (const UnitSpec& unit : all_units)
        declare_unit_keys(key, unit);
    for (const MemorySpec& memory : all_table_memories)
        declare_memory_keys(key, memory);
    key.add_number(
        {"off_chip_memory.latency", "off_chip_latency"}, [](auto& t) -> auto& { return t.off_chip_memory.latency; },
        "cycles", {0, most_places}, "Off-chip memory: latency, from a request's last byte to its answer");
    key.add_number(
        {"off_chip_memory.bandwidth", "off_chip_bandwidth"},
        [](auto& t) -> auto& { return t.off_chip_memory.bandwidth; }, "bytes per cycle", {1, 4096},
        "Off-chip memory: bandwidth, both directions combined");
    key.add_number(
        {"off_chip_memory.buffer", "off_chip_buffer"}, [](auto& t) -> auto& { return t.off_chip_memory.buffer; },
        "requests", {1, most_places}, "Off-chip memory: capacity of its request buffer");
    key.add_number(
        "stalls.per_mille", [](auto& t) -> auto& { return t.stalls.per_mille; }, "per mille of items", {0, 1000},
        "For tests: items that are delayed at random, on every channel");
    key.add_number(
        "stalls.longest", [](auto& t) -> auto& { return t.stalls.longest; }, "cycles", {1, 1000000},
        "For tests: longest delay");
    key.add_number(
        "stalls.seed", [](auto& t) -> auto& { return t.stalls.seed; }, "-", {0, 2147483647},
        "For tests: seed of the delays");
}

/// Likewise for DesignOptions, and
///   key.add_switch(name, member, description)
template <typename Keys>
void declare_option_keys(const Keys& key) {
    key.template add_choice<TriangleOrder>(
        "queue.order", [](auto& d) -> auto& { return d.queue.order; },
        "Triangle Queue: first in first out, or last in first out");
    key.add_number(
        "queue.watermark", [](auto& d) -> auto& { return d.queue.watermark; }, "triangles", {1, most_triangles},
        "Get Triangle accepts triangles from the host while fewer than this many wait in the queue");
    key.add_number(
        "queue.capacity", [](auto& d) -> auto& { return d.queue.capacity; }, "triangles", {0, most_triangles},
        "Timed mode: on-chip capacity of the Triangle Queue; 0: unbounded");
    key.add_number(
        {"queue.off_chip_triangles", "off_chip_triangles"}, [](auto& d) -> auto& { return d.queue.off_chip_triangles; },
        "triangles", {1, 1000000000},
        "Timed mode: capacity of off-chip memory for spilled triangles; a run that needs more ends with exit code 4");
    key.template add_choice<QueueOverflow>(
        "queue.overflow", [](auto& d) -> auto& { return d.queue.overflow; },
        "Timed mode: a full queue spills to off-chip memory, stalls the pipeline, or ends the run with exit code 4");
    key.add_number(
        "tests_units", [](auto& d) -> auto& { return d.tests_units; }, "-", {1, most_tests_units},
        "Timed mode: Tessellation Tests units, 1 or 3 (one for each edge of a triangle)");
    key.template add_choice<Work>(
        "work", [](auto& d) -> auto& { return d.work; },
        "Contents of the Triangle Queue. triangle: every child (the paper's); family: only triangles that are known to "
        "split, whose children are then tested together; the mesh is the same");
    key.template add_choice<TestOrder>(
        "test_order", [](auto& d) -> auto& { return d.test_order; },
        "parallel: all tests of an edge at once (the paper's); cheap_first: first the tests that read no table, the others "
        "only if the decision still depends on them; the mesh is the same");
    key.add_number(
        "edge_lanes", [](auto& d) -> auto& { return d.edge_lanes; }, "-", {1, 9},
        "Timed mode, with work = \"family\" and test_order = \"cheap_first\": lanes of the cheap tests, each of one edge "
        "per cycle");
    key.add_number(
        "normal_tests", [](auto& d) -> auto& { return d.normal_tests; }, "-", {1, 9},
        "Timed mode, likewise: Normal Tests, shared by the lanes");
    key.add_number(
        "transform_pipelines", [](auto& d) -> auto& { return d.transform_pipelines; }, "-", {1, 16},
        "Timed mode: Transform pipelines, used in turn");
    key.add_switch(
        "direct_memory", [](auto& d) -> auto& { return d.direct_memory; },
        "Functional mode reads the memories through DMI");
}

}  // namespace tessera

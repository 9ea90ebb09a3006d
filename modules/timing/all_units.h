#pragma once
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>

#include "modules/timing/timing.h"

// What is known of each unit and of each table's memory besides its code. Keys, the table of units in modules/README.md,
// the numbers in waveforms and the random designs are derived from these lists. Includes no
// SystemC: job files, fuzzers and the host's libraries are built without it.

namespace tessera {

/// A timing parameter of a unit besides its UnitTiming.
struct UnitParameter {
    const char* name = nullptr;  ///< of the member, and of its key; null: none
    unsigned Timing::*member = nullptr;
    const char* unit = "";
    unsigned least = 0, most = 0;
    const char* meaning = "";
};

/// How many there are of a unit: one in a machine, in each Tessellation Tests unit, or in each of its lanes.
enum class Per { machine, tests_unit, lane };

struct UnitSpec {
    const char* name;   ///< of its module; of its keys, the first part
    const char* title;  ///< as in the paper's figures
    const char* work;   ///< columns of README's table
    const char* arithmetic;
    UnitTiming Timing::*timing = nullptr;  ///< null: wires
    Per per = Per::machine;
    bool reads_tables = false;                            ///< its latency does not include the reads
    const char* buffer = "capacity of its input buffer";  ///< meaning of its key
    UnitParameter further{};
};

/// The unit that has the name of the design's height test, and its arithmetic (datapath/height_test.h).
inline constexpr const char* height_test_unit = "height_test";

/// In the order of the paper's figures; after a unit those that replace it.
inline constexpr std::array<UnitSpec, 15> all_units = {{
    {"get_triangle", "Get Triangle",
     "takes a triangle from the queue, else from the host; sends its new parts down both branches, and the triangle itself "
     "to Pass or Tessellate",
     "-", &Timing::get_triangle},
    {"calculate_new_p", "Calculate New P", "midpoints of position, texture coordinate and normal", "add, shift",
     &Timing::calculate_new_p},
    {"displace_vertex", "Displace Vertex", "normalises, reads d, P' = P + (S d + bias) N",
     "multiply-accumulate, normalise", &Timing::displace_vertex, Per::machine, true},
    {"transform", "Transform", "P' to the screen, N' to view space", "existing unit", &Timing::transform},
    {"calculate_new_u", "Calculate New U", "t_ij", "add, shift", &Timing::calculate_new_u, Per::lane},
    {"tex_coord_test", "Tex Coord Test", "compares integer parts; includes the Generation Test", "compare",
     &Timing::tex_coord_test, Per::lane},
    {height_test_unit, "Height test", "", "", &Timing::height_test, Per::tests_unit, true},
    {"normal_test",
     "Normal Test",
     "N_ij, T_ij, N'_ij, six differences; includes the Highlight Test",
     "normalise, bump, compare",
     &Timing::normal_test,
     Per::lane,
     true,
     "capacity of its input buffer",
     {"highlight_test_latency", &Timing::highlight_test_latency, "cycles", 0, most_cycles,
      "Highlight Test, if present: added to the Normal Test's latency"}},
    {"view_test", "View Test", "Manhattan length; for a base triangle it waits for Transform", "add, compare",
     &Timing::view_test, Per::lane},
    {"collect_tests",
     "Collect Tests",
     "joins an edge's four results into one item",
     "wires",
     nullptr,
     Per::tests_unit,
     false,
     "",
     {"results_buffer", &Timing::results_buffer, "edges", 1, most_places,
      "Capacity of each input buffer of Collect Tests: results of one test that wait for the other three"}},
    {"sequence_tests",
     "Sequence Tests",
     "replaces it with `test_order = \"cheap_first\"`: sends an edge to the tests that its decision needs",
     "logic",
     nullptr,
     Per::tests_unit,
     false,
     "",
     {"edges_in_sequence", &Timing::edges_in_sequence, "edges", 1, most_places,
      "With hardware.test_order = \"cheap_first\": capacity of Sequence Tests, in edges whose cheap tests are done"}},
    {"pass_or_tessellate", "Pass or Tessellate", "joins both branches; decides, culls, forwards", "logic",
     &Timing::pass_or_tessellate, Per::machine, false, "triangles that wait for parts from either branch"},
    {"tessellation", "Tessellation", "2, 3 or 4 children; sends a finished base triangle back unsplit", "wiring",
     &Timing::tessellation},
    {"triangle_queue", "Triangle Queue", "waiting triangles: first or last in first out, on chip, spilling off chip",
     "memory", &Timing::triangle_queue},
    {"lighting", "Lighting", "per-vertex light", "existing unit", &Timing::lighting},
}};

struct MemorySpec {
    const char* name;  ///< of its module; of its keys, the first part
    const char* title;
    MemoryTiming Timing::*timing;
    bool rectangles = false;  ///< a request reads the corners of a rectangle; otherwise one entry
};

/// A design has the two maps, and one of the two others: the table of its height test, which names its module.
inline constexpr std::array<MemorySpec, 4> all_table_memories = {{
    {"displacement_map", "Displacement map", &Timing::displacement_map},
    {"normal_map", "Normal map", &Timing::normal_map},
    {"summed_height_table", "Summed Height Table", &Timing::summed_height_table, true},
    {"height_table", "Table of any other height test", &Timing::height_table},
}};

/// The entry of a list with this name; in a constant expression, an error if there is none.
template <class Spec, std::size_t N>
constexpr const Spec& named(const std::array<Spec, N>& all, std::string_view name) {
    for (const Spec& spec : all)
        if (std::string_view(spec.name) == name)
            return spec;
    throw std::logic_error("no such unit or memory");
}

}  // namespace tessera

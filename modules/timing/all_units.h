#pragma once
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>

#include "modules/timing/design_options.h"
#include "modules/timing/timing.h"

// What is known of each unit (TESSERA_FOR_EACH_UNIT) and of each table's memory besides its code. Keys, the table of units in
// modules/README.md, the order of reports, the numbers in waveforms and the random designs are derived from these lists.
// Includes no SystemC: job files, fuzzers and the host's libraries are built without it.

namespace tessera {

/// A timing parameter of a unit besides its UnitTiming.
struct UnitParameter {
    const char* name = nullptr;  ///< of the member, and of its key; null: none
    unsigned Timing::*member = nullptr;
    const char* unit = "";
    unsigned least = 0, most = 0;
    const char* meaning = "";
};

/// Where a unit is: one in a machine; one of those that make a triangle's parts, between Get Triangle and the unit that
/// joins them; one in each Tessellation Tests unit, or in each of its lanes.
enum class Place { machine, geometry, tests_unit, lane };

inline constexpr const char* input_capacity = "capacity of its input buffer";

struct UnitSpec {
    const char* name;            ///< of its module; of its keys, the first part
    UnitTiming Timing::*timing;  ///< null: wires
    const char* title;           ///< as in the paper's figures
    const char* work;            ///< columns of README's table
    const char* arithmetic;
    Place place = Place::machine;
    bool reads_tables = false;            ///< its latency does not include the reads
    const char* buffer = input_capacity;  ///< meaning of its key
    UnitParameter further{};
    unsigned DesignOptions::*pipelines = nullptr;  ///< null: one

    constexpr bool in_tests() const { return place == Place::tests_unit || place == Place::lane; }
};

/// The unit that has the name of the design's height test, and its arithmetic (datapath/height_test.h).
inline constexpr const char* height_test_unit = "height_test";

#define TESSERA_UNIT(name, latency, interval, buffer, ...) UnitSpec{#name, &Timing::name, __VA_ARGS__},
#define TESSERA_WIRES(name, ...) UnitSpec{#name, nullptr, __VA_ARGS__},
inline constexpr std::array all_units{TESSERA_FOR_EACH_UNIT(TESSERA_UNIT, TESSERA_WIRES)};
#undef TESSERA_UNIT
#undef TESSERA_WIRES

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

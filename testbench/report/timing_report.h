#pragma once
#include <string>

#include "testbench/host/simulation.h"

namespace tessera {

/// Share of the run's cycles in which a unit or memory could not have taken more work: items times initiation interval,
/// or port slots taken over port slots there were. 0 to 1, 0 for a run without cycles.
double utilisation(const Unit& unit, std::uint64_t cycles);

/// "summed_height_table" of "tessera.summed_height_table": a unit's name within the machine.
std::string unit_name(const sc_core::sc_object& unit);

/// What held a timed run back.
struct Bottleneck {
    const Unit* unit = nullptr;  ///< the one with the highest utilisation
    double utilisation = 0;
    const Unit* next = nullptr;  ///< the one after it
    double next_utilisation = 0;
    /// The unit is what the run's length follows from; else no unit is, and there was too little work under way.
    bool binding = false;
};

/// A unit counts as binding from this utilisation on.
constexpr double binding_utilisation = 0.85;

Bottleneck find_bottleneck(const Simulation& simulation);

/// The same in words, one or two sentences.
std::string bottleneck_text(const Simulation& simulation);

/// Per unit and memory: cycles by state, by whom, utilisation, throughput, occupancy, as a table for people.
std::string timing_text(const Simulation& simulation);

/// The Triangle Queue's level over time: first cycle and highest level of at most 1024 stretches.
std::string queue_levels_csv(const LevelHistory& history);

}  // namespace tessera

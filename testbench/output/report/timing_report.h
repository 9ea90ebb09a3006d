#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/machine/simulation.h"

namespace tessera {

/// Fraction of its capacity that a unit or memory used in the run: items times initiation interval over cycles, or used
/// port slots over available ones. 0 to 1; 0 for a run without cycles.
double utilisation(const Unit& unit, std::uint64_t cycles);

/// A unit's name within the machine: "summed_height_table" of "tessera.summed_height_table"; in all machines but the
/// first, the whole name, "tessera_1.summed_height_table".
std::string unit_name(const sc_core::sc_object& unit);

/// Whether the unit only passes items on: the Triangle Queue, Collect Tests, Sequence Tests.
bool is_queue_or_join(const Unit& unit);

/// Units whose utilisation is within a per cent of the highest.
struct Limit {
    std::vector<const Unit*> units;  ///< in pipeline order; empty if all units were idle
    double utilisation = 0;          ///< the highest

    /// "a, b and c"; if there are many, "a and 16 others".
    std::string names() const;
};

/// What limited a timed run.
struct Bottleneck {
    Limit first;
    Limit next;  ///< of the units that are not in `first`
    /// `first` determines the run's length. If false, latency does: too few items were in flight to keep any unit busy.
    bool binding = false;

    /// Upper bound on the speed-up: without `first` or, if latency binds, without any waiting; the work of the next
    /// limit remains. 0: no bound.
    double bound() const;
};

/// A unit with at least this utilisation counts as binding.
constexpr double binding_utilisation = 0.85;

Bottleneck find_bottleneck(const Machine& machine, std::uint64_t cycles);

/// The same in words, one or two sentences.
std::string bottleneck_text(const Machine& machine, std::uint64_t cycles);

/// The Triangle Queue's level over time, in at most 1024 intervals: first cycle and highest level of each.
std::string queue_levels_csv(const LevelHistory& history);

}  // namespace tessera

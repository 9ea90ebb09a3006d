#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "testbench/machine/simulation.h"

namespace tessera {

/// Adds these fields of `counts` to those of `sum`.
template <class Counts, class... Fields>
void add_fields(Counts& sum, const Counts& counts, Fields... fields) {
    ((sum.*fields += counts.*fields), ...);
}

/// The same for a struct that consists of these fields only.
template <class Counts, class... Fields>
void add_all_fields(Counts& sum, const Counts& counts, Fields... fields) {
    static_assert(sizeof(Counts) == sizeof...(fields) * sizeof(std::uint64_t), "list every field");
    add_fields(sum, counts, fields...);
}

/// The counts of a run, totals over all machines.
struct Totals {
    DecidingUnit::Counts counts;
    Decisions::Counts decided;
    Decisions::Evaluated evaluated;
    std::uint64_t base_triangles = 0;  ///< of the job
    std::uint64_t host_triangles = 0, queue_triangles = 0;
    std::uint64_t positions = 0, normals = 0;
    std::array<std::uint64_t, 5> made_into{};
    std::uint64_t queued = 0, spilled = 0;
    std::size_t most_queued = 0, most_queued_on_chip = 0;  ///< in one machine's queue
    std::uint64_t lit = 0;
    std::uint64_t displacement_map_reads = 0, normal_map_reads = 0, height_table_reads = 0;
    datapath::Saturations saturations;

    explicit Totals(const Simulation& simulation);
    /// Vertices made for edges that were then not split.
    std::uint64_t thrown_away_vertices() const { return positions - 3 * base_triangles - counts.edges_split; }
};

/// Words beside the queue's levels: in functional mode one triangle passes the machine before the next.
inline const char* one_after_another(const MachineSetup& setup) {
    return setup.design.transport == Transport::blocking ? "; one after another: timed mode has the machine's" : "";
}

}  // namespace tessera

#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <type_traits>

#include "testbench/machine/simulation.h"

namespace tessera {

/// Adds each member of `counts` to that of `sum`. The members are all of type std::uint64_t.
template <class Counts>
void add_counts(Counts& sum, const Counts& counts) {
    std::array<std::uint64_t, sizeof(Counts) / sizeof(std::uint64_t)> sums, more;
    static_assert(sizeof sums == sizeof sum && std::has_unique_object_representations_v<Counts>);
    std::memcpy(sums.data(), &sum, sizeof sum);
    std::memcpy(more.data(), &counts, sizeof counts);
    std::transform(sums.begin(), sums.end(), more.begin(), sums.begin(), std::plus<>());
    std::memcpy(static_cast<void*>(&sum), sums.data(), sizeof sum);
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

#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/check/transport/transport_check.h"
#include "testbench/machine/simulation.h"

namespace tessera {

/// Two counters of different units that must be equal after a run that drained.
struct Conservation {
    std::string name;
    std::uint64_t left = 0;
    std::uint64_t right = 0;

    bool holds() const { return left == right; }
};

/// Each unit receives as many triangles, parts, edges and reads as its source sends. In functional mode, includes only
/// counts that exist there.
std::vector<Conservation> conservation(const Simulation& simulation);

/// Sum of `figure` over all Tessellation Tests units.
template <class Figure>
std::uint64_t sum_over_tests(const Pipeline& pipeline, Figure figure) {
    std::uint64_t sum = 0;
    for (const TessellationTests& tests : pipeline.tessellation_tests)
        sum += figure(tests);
    return sum;
}

/// Sends the check what it needs from a simulation that has not begun.
void observe(Simulation& simulation, TransportCheck& check);
/// The same without the passes.
void observe_finished(Simulation& simulation, TransportCheck& check);

/// The combined result of the transport check and these equations.
WorkResult work_result(const TransportCheck& check, const Simulation& simulation);

}  // namespace tessera

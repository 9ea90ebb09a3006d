#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/check/transport/transport_check.h"
#include "testbench/machine/simulation.h"

namespace tessera {

/// Two counters that must be equal after a run that drained.
struct Conservation {
    std::string name;
    std::uint64_t left = 0;
    std::uint64_t right = 0;

    bool holds() const { return left == right; }
};

/// Every input takes as many items as the output bound to it sends, every memory as many requests as its ports make, and
/// triangles, parts, edges and reads agree with one another. In functional mode, includes only counts that exist there.
std::vector<Conservation> conservation(const Simulation& simulation);

/// Sum of `figure` over all Tessellation Tests units.
template <class Figure>
std::uint64_t sum_over_tests(const Machine& machine, Figure figure) {
    std::uint64_t sum = 0;
    for (const TessellationTests& tests : machine.tessellation_tests)
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

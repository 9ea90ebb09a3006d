#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/check/transport/transport_check.h"
#include "testbench/machine/simulation.h"

namespace tessera {

/// Two counts kept in different places that are one number in any run that drained.
struct Conservation {
    std::string name;
    std::uint64_t left = 0;
    std::uint64_t right = 0;

    bool holds() const { return left == right; }
};

/// What goes into one unit came out of another: triangles, parts, edges, reads. In functional mode those that are
/// counted there.
std::vector<Conservation> conservation(const Simulation& simulation);

/// The work check's result, and these equations'.
WorkResult work_result(const TransportCheck& check, const Simulation& simulation);

}  // namespace tessera

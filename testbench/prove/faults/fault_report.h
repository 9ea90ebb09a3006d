#pragma once
#include <string>
#include <vector>

namespace tessera {

/// One check that detected a fault.
struct Caught {
    std::string
        by;  ///< scoreboard, invariants, work conservation, ...: testbench/prove/faults/FAULT_COVERAGE.md
    std::string evidence;  ///< what it found first
};

/// What was done to a run on purpose, and who detected.
struct FaultReport {
    std::string injected;  ///< KIND at PLACE, transaction N, bit B, cycle C
    std::vector<Caught> caught;
};

}  // namespace tessera

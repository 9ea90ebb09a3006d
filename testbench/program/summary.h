#pragma once
#include <string>

#include "testbench/report/conformance_report.h"
#include "testbench/report/statistics.h"

namespace tessera {

/// The table a run prints: what came out, what it cost, what was checked.
std::string summary(const Setup& setup, const Simulation& simulation, const Checks& checks, double seconds);

}  // namespace tessera

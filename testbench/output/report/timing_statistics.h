#pragma once
#include <vector>

#include "testbench/output/report/statistics.h"

namespace tessera {

/// The figures that only timed mode has: cycles, and what each unit and memory did in them.
std::vector<Figure> timing_figures(const Simulation& simulation);

}  // namespace tessera

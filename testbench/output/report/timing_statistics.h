#pragma once
#include <vector>

#include "testbench/machine/simulation.h"
#include "testbench/output/report/figure.h"

namespace tessera {

/// Appends the figures specific to timed mode: cycles, and the activity of each unit and memory.
void timing_figures(std::vector<Figure>& all, const Simulation& simulation);

}  // namespace tessera

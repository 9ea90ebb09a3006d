#pragma once
#include <vector>

#include "testbench/machine/simulation.h"
#include "testbench/output/report/figure.h"

namespace tessera {

/// Appends the figures that only timed mode has: cycles, and what each unit and memory did in them.
void timing_figures(std::vector<Figure>& all, const Simulation& simulation);

}  // namespace tessera

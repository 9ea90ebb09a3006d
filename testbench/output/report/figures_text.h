#pragma once
#include <string>
#include <vector>

#include "testbench/output/report/figure.h"

namespace tessera {

/// Figures for reading, group by group: name, value, unit and description in a line; those of rows in a table, with a
/// line on each of its columns below.
std::string figures_text(const std::vector<Figure>& figures);

}  // namespace tessera

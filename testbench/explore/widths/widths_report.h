#pragma once
#include <string>

#include "testbench/explore/widths/width_sweep.h"

namespace tessera {

// The output of `tessera widths`. Contains no times: the same sweep gives the same bytes.

/// A table for each quantity, followed by its knee.
std::string widths_text(const WidthRequest& request, const WidthSweep& sweep);

/// One row per width, units in the heading; for a refused width, only the reason.
std::string widths_csv(const WidthSweep& sweep);

std::string widths_json(const WidthRequest& request, const WidthSweep& sweep);

}  // namespace tessera

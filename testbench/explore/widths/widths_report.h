#pragma once
#include <string>

#include "testbench/explore/widths/width_sweep.h"

namespace tessera {

// What `tessera widths` says and leaves. No seconds: the same sweep gives the same bytes.

/// A table for each quantity, and below it the knee.
std::string widths_text(const WidthRequest& request, const WidthSweep& sweep);

/// One row for each width, units in the heading; of one that was refused only the reason.
std::string widths_csv(const WidthSweep& sweep);

std::string widths_json(const WidthRequest& request, const WidthSweep& sweep);

}  // namespace tessera

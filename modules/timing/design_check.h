#pragma once
#include <string>

#include "modules/datapath/format.h"
#include "modules/timing/design.h"

namespace tessera {

/// What is wrong with a program's design and formats, one line for each fault: the member, its value, and its range or what
/// to set. Empty: nothing.
std::string design_faults(const Design& design, const datapath::Formats& formats);

}  // namespace tessera

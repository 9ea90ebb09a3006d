#pragma once
#include <string>
#include <vector>

#include "testbench/job/job.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// One sentence for each key of timed mode whose value is not built as it is, and for each key of the edge tests, or in
/// timed mode of the hardware, that has no effect in this design though it differs from its default and no remark of the
/// setup is about it.
std::vector<std::string> design_remarks(const Job& job, const MachineSetup& setup);

}  // namespace tessera

#pragma once
#include <string>

#include "testbench/check/conformance/end_to_end.h"
#include "testbench/job/job.h"

namespace tessera {

/// For a run whose decisions or mesh differ more than is allowed from those of golden, whose positions and normals are
/// not rounded. Names what to set: formats narrower than their defaults, else what is allowed. `golden_run`: golden's own
/// mesh, if it differs too much. Empty if nothing is to be set.
std::string difference_advice(const Job& job, double flips_percent, const EndToEndResult* golden_run);

}  // namespace tessera

#pragma once
#include "testbench/job/job.h"

namespace tessera {

/// Checks every key's range and the constraints between keys. Throws one InputError with a line per fault: the
/// keys, their values, the limit and what to do.
void validate(const Job& job);

}  // namespace tessera

#pragma once
#include "testbench/prove/random_machines/case_run.h"

namespace tessera {

/// run_case in a process of its own. Whatever ends that process but its end is a failure, too: an exception, a signal,
/// more than two minutes.
CaseResult run_case_in_process(const RandomCase& random_case, Mode mode);

}  // namespace tessera

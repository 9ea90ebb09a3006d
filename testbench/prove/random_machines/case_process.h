#pragma once
#include "testbench/prove/random_machines/case_run.h"

namespace tessera {

/// Runs run_case in a child process. Any abnormal end of that process is a failure, too: an exception, a signal, more
/// than two minutes.
CaseResult run_case_in_process(const RandomCase& random_case, Mode mode);

}  // namespace tessera

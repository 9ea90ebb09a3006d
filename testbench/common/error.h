#pragma once
#include <stdexcept>
#include <string>

namespace tessera {

/// Exit codes of every tessera program.
enum class ExitCode : int {
    fine = 0,
    check_failed = 1,    ///< conformance or an invariant violated
    bad_input = 2,       ///< bad input or usage
    deadlock = 3,        ///< the simulation starved or made no progress
    resource_limit = 4,  ///< a stated resource limit was reached
};

/// Bad input or usage. The message names file, line or key, the value, the limit and what to do.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A stated resource limit was reached. The message names the limit, its key and what to do.
class ResourceError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace tessera

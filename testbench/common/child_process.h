#pragma once
#include <functional>
#include <string>

namespace tessera {

/// How a child process ended.
struct ChildEnd {
    std::string told;     ///< the return value of the work; truncated if the process ended before it was written
    std::string failure;  ///< empty: normal exit; else "ended by signal 14, Alarm clock: over 120 s", ...
};

/// Runs `work` in a child process, since SystemC elaborates once per process, and a crash or a memory limit then ends
/// only that process. The child ends with its parent, or after `most_seconds`. Throws std::system_error if no pipe or
/// process can be created; an exception of `work` ends the child with code 1.
ChildEnd run_in_child(const std::function<std::string()>& work, unsigned most_seconds = 120);

}  // namespace tessera

#pragma once
#include <functional>
#include <string>

namespace tessera {

/// How a process that did a piece of work ended.
struct ChildEnd {
    std::string told;     ///< what the work returned; not all of it if the process was ended before it was written
    std::string failure;  ///< empty: it ended by itself; "ended by signal 14, Alarm clock: over 120 s", ...
};

/// Does `work` in a process of its own: SystemC elaborates once a process, and a crash or a limit of memory ends only
/// that process. It ends with its parent, and after `most_seconds`. Throws std::system_error without a pipe or a
/// process; an exception of `work` ends the process with code 1.
ChildEnd run_in_child(const std::function<std::string()>& work, unsigned most_seconds = 120);

}  // namespace tessera

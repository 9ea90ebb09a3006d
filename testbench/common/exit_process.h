#pragma once
#include <unistd.h>

#ifdef TESSERA_COVERAGE
extern "C" int __llvm_profile_write_file();  // NOLINT(bugprone-reserved-identifier): the runtime's own name
#endif

namespace tessera {

/// Ends a forked process at once: nothing its parent also holds (test sessions, open files) is ended twice. What a
/// coverage build counted is kept.
[[noreturn]] inline void exit_process(int code) {
#ifdef TESSERA_COVERAGE
    __llvm_profile_write_file();
#endif
    ::_exit(code);
}

}  // namespace tessera

#pragma once
#include <algorithm>
#include <string>

#include "testbench/common/error.h"

namespace tessera {

/// Largest value of --jobs.
inline constexpr unsigned most_jobs = 64;

/// Parses an unsigned command-line integer of up to six digits; -1 for anything else.
inline int parse_number(const std::string& digits) {
    const bool number = !digits.empty() && digits.size() <= 6 &&
                        std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
    return number ? std::stoi(digits) : -1;
}

/// Throws InputError: wrong usage of `tessera COMMAND`.
[[noreturn]] inline void refuse_usage(const char* command, const std::string& what) {
    throw InputError(what + "; see `tessera " + command + " --help`");
}

}  // namespace tessera

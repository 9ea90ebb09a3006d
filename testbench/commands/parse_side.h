#pragma once
#include <algorithm>
#include <string>

namespace tessera {

/// A side of a picture or map as a command line gives it: up to six digits; -1 for anything else.
inline int parse_side(const std::string& digits) {
    const bool number = !digits.empty() && digits.size() <= 6 &&
                        std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
    return number ? std::stoi(digits) : -1;
}

}  // namespace tessera

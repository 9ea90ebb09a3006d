#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace tessera::testing {

inline std::string joined(const std::vector<std::string>& lines) {
    std::string all;
    for (const std::string& line : lines)
        all += line + '\n';
    return all;
}

/// With the first occurrence replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

inline std::uint64_t number_after(const std::string& text, const std::string& words) {
    const std::size_t at = text.find(words);
    REQUIRE(at != std::string::npos);
    return std::stoull(text.substr(at + words.size()));
}

}  // namespace tessera::testing

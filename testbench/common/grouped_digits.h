#pragma once
#include <cstdint>
#include <string>

namespace tessera {

/// 1234567 as 1,234,567.
inline std::string grouped_digits(std::uint64_t value) {
    std::string text = std::to_string(value);
    for (std::size_t place = text.size(); place > 3; place -= 3)
        text.insert(place - 3, ",");
    return text;
}

}  // namespace tessera

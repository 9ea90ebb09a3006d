#pragma once
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "testbench/common/error.h"

namespace tessera {

/// A threshold to be converted to a register.
struct ThresholdToRegister {
    const char* key;
    double value;
    bool used;     // by an enabled test
    double scale;  // register's value per unit of the threshold
    double limit;  // the register's highest value
    const char* format_key;
    int more_bits = 0;   // that the format may have
    bool zero = true;    // 0 is a meaningful threshold: rounding alone does not exceed it
    int fewer_bits = 0;  // of the format than by default, if golden does not round to it: its run would differ
};

/// Rounds down. Refuses a value that does not fit, and one that would become 0 although it is not: a test against 0 has
/// a different meaning, and its result depends on rounding.
inline std::int64_t to_register(const ThresholdToRegister& threshold) {
    const double fixed = std::floor(threshold.value * threshold.scale);
    if (fixed > threshold.limit)
        throw InputError(fmt::format("{} = {} does not fit its register; the largest is {}", threshold.key,
                                     threshold.value, threshold.limit / threshold.scale));
    if (threshold.used && threshold.value > 0 && fixed < 1) {
        const double bits = std::ceil(-std::log2(threshold.value * threshold.scale));
        const std::string raise = bits > threshold.more_bits
                                      ? ""
                                      : fmt::format("raise {} by {}", threshold.format_key,
                                                    std::max(bits, static_cast<double>(threshold.fewer_bits)));
        throw InputError(
            fmt::format("{} = {} is less than one step of its register, {}, and would be 0 there: {}", threshold.key,
                        threshold.value, 1 / threshold.scale,
                        threshold.fewer_bits > 0 && !raise.empty()
                            ? raise
                            : fmt::format("set it {}at least to that step{}{}", threshold.zero ? "to 0, or " : "",
                                          raise.empty() ? "" : ", or ", raise)));
    }
    return static_cast<std::int64_t>(fixed);
}

}  // namespace tessera

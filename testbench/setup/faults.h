#pragma once
#include <fmt/core.h>

#include <string>
#include <utility>
#include <vector>

#include "testbench/common/error.h"

namespace tessera {

/// Collects the faults of settings, a line each.
class Faults {
  public:
    template <typename... Args>
    void unless(bool fine, fmt::format_string<Args...> format, Args&&... args) {
        if (!fine)
            texts.push_back(fmt::format(format, std::forward<Args>(args)...));
    }
    /// Throws one InputError with all faults, if there are any.
    void raise() const {
        std::string all;
        for (const std::string& text : texts)
            all += (all.empty() ? "" : "\n") + text;
        if (!all.empty())
            throw InputError(all);
    }

    std::vector<std::string> texts;
};

}  // namespace tessera

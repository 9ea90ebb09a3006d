#pragma once
#include <fmt/core.h>

#include <string>
#include <utility>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/setup/scene_settings.h"

namespace tessera {

/// Collects the faults of settings, a line each.
class Faults {
  public:
    template <typename... Args>
    void unless(bool fine, fmt::format_string<Args...> format, Args&&... args) {
        if (!fine)
            texts.push_back(fmt::format(format, std::forward<Args>(args)...));
    }
    void range(const char* name, double value, double least, double most) {
        if (is_automatic(value))
            texts.push_back(fmt::format("`{}` is not set, or not a number: set it", name));
        else
            unless(value >= least && value <= most, "`{}` = {}: must be {} to {}", name, value, least, most);
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

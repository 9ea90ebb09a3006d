#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "golden/golden_ranks.h"
#include "modules/datapath/format.h"
#include "testbench/check/conformance/setup_check.h"

/// Internal to setup_check.cpp and setup_tables.cpp.
namespace tessera::setup_check {

/// The allowed range of hardware minus golden, in LSB.
struct Bound {
    double low, high;
    bool low_allowed = true;
};
inline constexpr Bound exact{0, 0};
inline constexpr Bound to_nearest{-0.5, 0.5};
inline constexpr Bound rounded_down{-1, 0, false};

/// Relative to the terms of a sum in double precision.
inline constexpr double double_rounding = 0x1p-48;

class Judge {
  public:
    Judge(SetupResult& result, const char* name, const char* description)
        : result_(result), part_(result.parts.size()) {
        result.parts.push_back({name, description});
    }

    /// `golden` in LSB; `leeway`: golden's own error bound. `name()` is called for the first wrong value.
    template <typename Name>
    void judge(Name name, double hardware, double golden, const Bound& bound, double leeway = 0) {
        SetupResult::Part& part = result_.parts[part_];
        ++part.compared;
        const double error = hardware - golden;
        if (const double most = std::max(-bound.low, bound.high) + leeway; most > 0)
            part.worst_ratio = std::max(part.worst_ratio, std::abs(error) / most);
        if ((bound.low_allowed ? error >= bound.low - leeway : error > bound.low - leeway) &&
            error <= bound.high + leeway)
            return;
        ++part.wrong;
        if (result_.first_wrong.empty())
            result_.first_wrong = fmt::format("{}: {} = {:.17g}, golden {:.17g}, allowed {}{:.17g} to {:.17g}",
                                              part.name, name(), hardware, golden, bound.low_allowed ? "" : "above ",
                                              golden + bound.low - leeway, golden + bound.high + leeway);
    }
    void judge(const char* name, double hardware, double golden, const Bound& bound, double leeway = 0) {
        judge([&] { return name; }, hardware, golden, bound, leeway);
    }
    /// Checks the validity of a value chosen by the host.
    template <typename Text>
    void require(bool sound, Text text) {
        SetupResult::Part& part = result_.parts[part_];
        ++part.compared;
        if (sound)
            return;
        ++part.wrong;
        if (result_.first_wrong.empty())
            result_.first_wrong = fmt::format("{}: {}", part.name, text());
    }

  private:
    SetupResult& result_;
    std::size_t part_;
};

inline double number(bool value) {
    return value ? 1 : 0;
}

template <typename Integer>
double number(Integer value) {
    return static_cast<double>(value);
}

inline double lsb_per_unit(const datapath::Format& format) {
    return std::ldexp(1.0, format.fraction);
}

/// The Rank Table that golden derives, empty if there is none or midpoints share entries. Reports an invalid order.
golden::DerivedRanks derived_ranks(const MachineSetup& setup, const GoldenJob& golden, SetupResult& result);

/// Checks every entry of the three tables.
void check_tables(const MachineSetup& setup, const GoldenJob& golden, const golden::DerivedRanks& ranks, Host& host,
                  SetupResult& result);

}  // namespace tessera::setup_check

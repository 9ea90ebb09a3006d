#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "modules/datapath/format.h"
#include "testbench/check/conformance/setup_check.h"

/// Internal to setup_check.cpp, setup_tables.cpp and height_tests/.
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

/// entry_bits: rounded up to whole bytes.
void judge_layout(Judge& judge, const char* name, const datapath::TableLayout& table, double columns, double rows,
                  int entry_bits);

/// The texture coordinates, in texels, of the base triangles that the machine receives.
std::vector<std::array<glm::dvec2, 3>> base_texels(const MachineSetup& setup, const GoldenJob& golden,
                                                   const SetupResult& result);
/// Compares a table's size in texels with what these base triangles cover.
void judge_extent(Judge& judge, const std::vector<std::array<glm::dvec2, 3>>& base, const golden::Map& map,
                  std::int64_t columns, std::int64_t rows);

/// Reads a table of this size from its memory, row by row.
void each_entry(Judge& judge, tlm_utils::simple_initiator_socket<Host>& socket, const datapath::TableLayout& layout,
                double columns, double rows,
                const std::function<void(std::uint32_t x, std::uint32_t y, std::uint64_t entry)>& check);

/// Checks every entry of the displacement map and of the normal map.
void check_maps(const MachineSetup& setup, const GoldenJob& golden, Host& host, SetupResult& result);

}  // namespace tessera::setup_check

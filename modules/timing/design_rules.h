#pragma once
#include <array>
#include <string>
#include <vector>

#include "modules/timing/design_options.h"
#include "modules/timing/timing.h"

namespace tessera {

/// A member of DesignOptions or Timing, as design_keys.h names it, and a value as in a job file.
struct DesignSetting {
    std::string member, value;
};

/// A rule that values must meet together, each of which is in its range.
struct DesignRule {
    const char* member;  ///< whose value breaks it
    const char* why;
    bool (*met)(const DesignOptions& options, const Timing& timing);
    /// One setting, or two.
    std::vector<DesignSetting> (*remedy)(const DesignOptions& options, const Timing& timing);
};

inline bool has_lanes(const DesignOptions& options) {
    return options.work == Work::family && options.test_order == TestOrder::cheap_first;
}

inline std::vector<DesignSetting> use_lanes(const DesignOptions&, const Timing&) {
    return {{"work", "\"family\""}, {"test_order", "\"cheap_first\""}};
}

/// A job file and Machine are held to the same.
inline const std::array design_rules{
    DesignRule{"tests_units", "a design has 1 Tessellation Tests unit, or 3, one for each edge",
               [](const DesignOptions& d, const Timing&) { return d.tests_units != 2; },
               [](const DesignOptions&, const Timing&) -> std::vector<DesignSetting> {
                   return {{"tests_units", "3"}};
               }},
    DesignRule{"tests_units",
               "the family design has 1 Tessellation Tests unit; edge_lanes and normal_tests replace others",
               [](const DesignOptions& d, const Timing&) { return d.tests_units != 3 || d.work == Work::triangle; },
               [](const DesignOptions&, const Timing&) -> std::vector<DesignSetting> {
                   return {{"tests_units", "1"}};
               }},
    DesignRule{"edge_lanes", "only the family design with its tests cheapest first has several",
               [](const DesignOptions& d, const Timing&) { return d.edge_lanes == 1 || has_lanes(d); }, use_lanes},
    DesignRule{"normal_tests", "only the family design with its tests cheapest first has several",
               [](const DesignOptions& d, const Timing&) { return d.normal_tests == 1 || has_lanes(d); }, use_lanes},
    DesignRule{"summed_height_table.banks", "exclusive ORs of column and row number a power of two of banks",
               [](const DesignOptions&, const Timing& t) {
                   const MemoryTiming& table = t.summed_height_table;
                   return table.interleave == Interleave::entry || (table.banks & (table.banks - 1)) == 0;
               },
               [](const DesignOptions&, const Timing& t) -> std::vector<DesignSetting> {
                   unsigned banks = 1;
                   while (2 * banks <= t.summed_height_table.banks)
                       banks *= 2;
                   return {{"summed_height_table.banks", std::to_string(banks)}};
               }},
};

/// The rules that are not met.
inline std::vector<const DesignRule*> broken_rules(const DesignOptions& options, const Timing& timing) {
    std::vector<const DesignRule*> broken;
    for (const DesignRule& rule : design_rules)
        if (!rule.met(options, timing))
            broken.push_back(&rule);
    return broken;
}

}  // namespace tessera

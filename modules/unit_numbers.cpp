#include "modules/unit_numbers.h"

#include <string>

#include "modules/datapath/height_tests.h"
#include "modules/timing/all_units.h"
#include "modules/timing/design_options.h"

namespace tessera {

namespace {

std::vector<UnitNumbers::Entry> number_units() {
    constexpr unsigned numbered_lanes = 4;
    std::vector<UnitNumbers::Entry> entries;
    unsigned number = 0;
    const auto add = [&](const std::string& name, const std::string& shown) {
        entries.push_back({++number, name, shown});
    };
    // One number, whatever the design's height test.
    const auto add_height = [&](const std::string& before, const std::string& after, const std::string& shown,
                                std::string (datapath::HeightTestFunctions::*name)() const) {
        ++number;
        for (const datapath::HeightTestFunctions* const test : datapath::height_tests()) {
            std::string whole = before;
            whole.append((test->*name)()).append(after);
            entries.push_back({number, whole, shown});
        }
    };
    const auto numbered = [](const char* name, unsigned copy) {
        return std::string(name) + (copy == 0 ? "" : '_' + std::to_string(copy));
    };
    const auto add_tests = [&](unsigned tests_unit, unsigned lane) {
        const std::string tests = "tessellation_tests_" + std::to_string(tests_unit) + '.';
        for (const UnitSpec& unit : all_units)
            if (unit.name == std::string(height_test_unit) && lane == 0)
                add_height(tests, "", numbered(unit.name, tests_unit), &datapath::HeightTestFunctions::unit);
            else if (unit.place == Place::lane || (unit.place == Place::tests_unit && lane == 0))
                add(tests + numbered(unit.name, lane), numbered(unit.name, tests_unit + lane));
    };
    for (const UnitSpec& unit : all_units)
        if (!unit.in_tests())
            add(unit.name, unit.name);
    for (unsigned k = 0; k < most_tests_units; ++k)
        add_tests(k, 0);
    for (unsigned lane = 1; lane < numbered_lanes; ++lane)
        add_tests(0, lane);
    for (const std::string suffix : {"", "_cache"}) {
        for (const char* const map : {"displacement_map", "normal_map"})
            add(map + suffix, map + suffix);
        add_height("", suffix, "height_table" + suffix, &datapath::HeightTestFunctions::table);
    }
    for (const char* const other : {"displacement_map_for_tests", "off_chip_memory", "host", "rasteriser"})
        add(other, other);
    return entries;
}

}  // namespace

const std::vector<UnitNumbers::Entry>& numbered_units() {
    static const std::vector<UnitNumbers::Entry> entries = number_units();
    return entries;
}

}  // namespace tessera

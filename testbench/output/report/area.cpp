#include "testbench/output/report/area.h"

#include <algorithm>
#include <string_view>

namespace tessera {
namespace {

/// Without the number of one of several: "view_test_1" is a view_test.
std::string_view kind_name(const Unit& unit) {
    std::string_view name = unit.basename();
    const std::size_t digits = name.find_last_not_of("0123456789") + 1;
    if (digits < name.size() && name[digits - 1] == '_')
        name = name.substr(0, digits - 1);
    return name;
}

void add(std::vector<UnitArea>& all, const std::vector<Unit*>& units) {
    for (const Unit* unit : units) {
        const Area& area = unit->area();
        if (area.multipliers.empty() && area.register_bits == 0 && area.memory_bits == 0)
            continue;
        const std::string_view name = kind_name(*unit);
        const auto found = std::find_if(all.begin(), all.end(), [&](const UnitArea& its) { return its.name == name; });
        UnitArea& its = found != all.end() ? *found : all.emplace_back(UnitArea{{}, std::string(name)});
        its += area;
    }
}

}  // namespace

std::vector<UnitArea> area_of(const std::vector<Unit*>& units) {
    std::vector<UnitArea> all;
    add(all, units);
    return all;
}

std::vector<UnitArea> area_of(const Simulation& simulation) {
    std::vector<UnitArea> all;
    for (const auto& hosted : simulation.machines)
        add(all, hosted->machine.units());
    return all;
}

UnitArea total_area(const std::vector<UnitArea>& units) {
    UnitArea total{{}, "total"};
    for (const UnitArea& unit : units)
        total += unit;
    return total;
}

}  // namespace tessera

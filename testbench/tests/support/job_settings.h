#pragma once
#include <sstream>
#include <string>

#include "modules/timing/all_units.h"
#include "testbench/job/read_job.h"

namespace tessera::testing {

/// The job with `table.key=value`, separated by spaces.
inline Job with_settings(Job job, const std::string& settings) {
    std::istringstream all(settings);
    for (std::string setting; all >> setting;)
        apply_setting(job, setting);
    return job;
}

/// Settings that set every unit's latency, interval or buffer; value(k) is the value of the k-th, from 0.
template <class Value>
std::string every_unit(const std::string& figure, Value value) {
    std::ostringstream settings;
    int k = 0;
    for (const UnitSpec& unit : all_units)
        if (unit.timing != nullptr)
            settings << "timing." << unit.name << '_' << figure << '=' << value(k++) << ' ';
    return settings.str();
}
inline std::string every_unit(const std::string& figure, int value) {
    return every_unit(figure, [=](int) { return value; });
}

/// The same for every table's latency, width or buffer.
inline std::string every_table(const std::string& figure, int value) {
    std::ostringstream settings;
    for (const MemorySpec& table : all_table_memories)
        settings << "timing." << table.name << '_' << figure << '=' << value << ' ';
    return settings.str();
}

}  // namespace tessera::testing

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

/// A row of a CaseTable: a job's settings.
struct SettingsRow {
    std::string name;
    std::string settings;
};

/// Stalls of every channel.
inline std::string random_stalls(int seed, int per_mille, int longest = 16) {
    return "timing.stalls_seed=" + std::to_string(seed) + " timing.stalls_per_mille=" + std::to_string(per_mille) +
           " timing.stalls_longest=" + std::to_string(longest) + " ";
}

inline std::string bounded_queue(const std::string& order, int capacity) {
    return "hardware.queue_order=" + order + " hardware.queue_capacity=" + std::to_string(capacity) + " ";
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

/// The same for every table.
inline std::string every_table(const std::string& figure, int value) {
    std::ostringstream settings;
    for (const MemorySpec& table : all_table_memories)
        settings << "timing." << table.name << '_' << figure << '=' << value << ' ';
    return settings.str();
}

/// Every table behind a cache of so many bytes, in lines of so many.
inline std::string all_cached(int bytes, int line_bytes = 64, int fills = 16) {
    return every_table("cache_bytes", bytes) + every_table("line_bytes", line_bytes) +
           every_table("cache_fills", fills);
}

}  // namespace tessera::testing

#pragma once
#include <sstream>
#include <string>

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
    for (const char* const unit : {"get_triangle", "calculate_new_p", "displace_vertex", "transform", "calculate_new_u",
                                   "tex_coord_test", "summed_height_test", "normal_test", "view_test",
                                   "pass_or_tessellate", "tessellation", "triangle_queue", "lighting"})
        settings << "timing." << unit << '_' << figure << '=' << value(k++) << ' ';
    return settings.str();
}
inline std::string every_unit(const std::string& figure, int value) {
    return every_unit(figure, [=](int) { return value; });
}

/// The same for the three tables' latency, width or buffer.
inline std::string every_table(const std::string& figure, int value) {
    std::ostringstream settings;
    for (const char* const table : {"displacement_map", "normal_map", "summed_height_table"})
        settings << "timing." << table << '_' << figure << '=' << value << ' ';
    return settings.str();
}

}  // namespace tessera::testing

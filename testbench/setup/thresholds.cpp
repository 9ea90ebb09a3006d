#include "testbench/setup/thresholds.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/setup/rounding.h"
#include "testbench/setup/threshold_register.h"

namespace tessera {

namespace {

/// A threshold on the difference of one component of two normals.
std::uint32_t to_normal_register(const char* key, double value, bool used, const datapath::Formats& formats) {
    return static_cast<std::uint32_t>(
        to_register({key, value, used, std::ldexp(1.0, formats.normal.fraction),
                     static_cast<double>(2 * formats.normal.highest + 1), "formats.normal_fraction",
                     datapath::FormatLimits::normal_fraction.most - formats.normal.fraction, false,
                     static_cast<int>(FormatSettings{}.normal_fraction) - formats.normal.fraction}));
}

}  // namespace

datapath::TestParameters make_tests(const TestSettings& tests, const datapath::Formats& formats,
                                    const ViewedScale& view) {
    datapath::TestParameters result;
    result.normal_test = tests.normal;
    result.summed_height_test = tests.summed_height;
    result.view_test = tests.view;
    result.tex_coord_test = tests.tex_coord;
    result.generation_test = tests.generation;
    result.normal_threshold =
        to_normal_register("tests.normal_threshold", tests.normal_threshold, tests.normal, formats);
    const bool area = tests.summed_height_unit == datapath::SummedHeightUnit::area;
    result.summed_height_unit = area ? datapath::SummedHeightUnit::area : datapath::SummedHeightUnit::sum;
    host_of(formats.height_test).set_thresholds(tests, formats, view, result);
    result.view_threshold = static_cast<std::uint32_t>(
        to_register({"tests.view_threshold", tests.view_threshold, tests.view, std::ldexp(1.0, formats.screen.fraction),
                     std::ldexp(1.0, formats.screen.bits), "formats.screen_fraction",
                     datapath::FormatLimits::screen_fraction.most - formats.screen.fraction}));
    result.generation_limit = static_cast<std::uint32_t>(tests.generation_limit);
    return result;
}

bool set_highlight_test(const TestSettings& tests, const glm::dvec3& to_light, const glm::dvec3& to_viewer,
                        const datapath::Formats& formats, datapath::TestParameters& registers,
                        std::uint64_t& saturated) {
    registers.highlight_test = true;
    const glm::dvec3 sum = to_light + to_viewer;
    // With a shorter vector, rounding errors would determine the direction.
    constexpr double shortest = 1e-9;
    const bool is_there = glm::length(sum) > shortest;
    if (is_there) {
        const datapath::Direction half = to_direction(glm::normalize(sum), formats.normal, saturated);
        registers.half_vector = {half.x, half.y, half.z};
    }
    // Rounded to nearest, so that the cosines of 0, 60 and 90 degrees are exact.
    registers.highlight_cosine =
        to_fixed(std::cos(tests.highlight_angle * glm::pi<double>() / 180), 2 * formats.normal.fraction);
    registers.highlight_normal_threshold =
        to_normal_register("tests.highlight_normal_threshold", tests.highlight_normal_threshold, true, formats);
    return is_there;
}

}  // namespace tessera

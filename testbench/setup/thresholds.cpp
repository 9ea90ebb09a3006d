#include "testbench/setup/thresholds.h"

#include <fmt/core.h>

#include <cmath>

#include "modules/datapath/curvature.h"
#include "modules/datapath/mipmap.h"
#include "testbench/common/error.h"
#include "testbench/setup/rounding.h"

namespace tessera {

namespace {

/// A threshold to be converted to a register.
struct Threshold {
    const char* key;
    double value;
    bool used;     // by an enabled test
    double scale;  // register's value per unit of the threshold
    double limit;  // the register's highest value
    const char* format_key;
};

/// Rounds down. Refuses a value that does not fit, and one that would become 0 although it is not: a test against 0 has
/// a different meaning, and its result depends on rounding.
std::uint64_t to_register(const Threshold& threshold) {
    const double fixed = std::floor(threshold.value * threshold.scale);
    if (fixed > threshold.limit)
        throw InputError(fmt::format("{} = {} does not fit its register; the largest is {}", threshold.key,
                                     threshold.value, threshold.limit / threshold.scale));
    if (threshold.used && threshold.value > 0 && fixed < 1)
        throw InputError(
            fmt::format("{} = {} is less than one step of its register, {}, and would be 0 there: set it to 0, or at "
                        "least to that step, or raise {}",
                        threshold.key, threshold.value, 1 / threshold.scale, threshold.format_key));
    return static_cast<std::uint64_t>(fixed);
}

void set_rank_thresholds(const TestSettings& tests, const datapath::Formats& formats, const ViewedScale& view,
                         datapath::TestParameters& registers) {
    const double highest_code = static_cast<double>(formats.displacement.highest);
    registers.rank_per_pixel = formats.distances && tests.rank_view == RankView::per_pixel;
    if (formats.rank_bits > 0)
        registers.rank_threshold =
            formats.distances
                ? seen_rank_threshold(tests.rank_threshold, registers.rank_per_pixel, view)
                : static_cast<std::int32_t>(rank_threshold(tests.rank_threshold * highest_code, formats.rank_bits));
    if (formats.bound_bits > 0)
        registers.bound_threshold =
            formats.distances
                ? seen_bound_threshold(tests.bound_threshold, view)
                : static_cast<std::int32_t>(bound_threshold(tests.bound_threshold * highest_code, formats.bound_bits));
}

/// A threshold on the difference of one component of two normals.
std::uint32_t to_normal_register(const char* key, double value, bool used, const datapath::Formats& formats) {
    return static_cast<std::uint32_t>(
        to_register({key, value, used, std::ldexp(1.0, formats.normal.fraction),
                     static_cast<double>(2 * formats.normal.highest + 1), "formats.normal_fraction"}));
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
    const double highest_code = static_cast<double>(formats.displacement.highest);
    result.summed_height_unit = area ? datapath::SummedHeightUnit::area : datapath::SummedHeightUnit::sum;
    // sum: compared with |2 S_ij - S_i - S_j|, four times the paper's difference
    result.summed_height_threshold = to_register(
        {"tests.summed_height_threshold", tests.summed_height_threshold, tests.summed_height,
         highest_code * (area ? 1 : 4), area ? std::ldexp(1.0, 18) : std::ldexp(1.0, 50), "formats.displacement_bits"});
    if (formats.height_test == datapath::HeightTest::rank)
        set_rank_thresholds(tests, formats, view, result);
    if (formats.height_test == datapath::HeightTest::curvature)
        result.curvature_threshold = to_register(
            {"tests.curvature_threshold", tests.curvature_threshold, tests.summed_height,
             std::ldexp(highest_code, datapath::curvature_fraction),
             std::ldexp(1.0, datapath::curvature_threshold_bits(formats)) - 1, "formats.displacement_bits"});
    // compared with |2 M_ij - M_i - M_j|, twice the height
    if (formats.height_test == datapath::HeightTest::mipmap)
        result.mipmap_threshold = static_cast<std::uint32_t>(
            to_register({"tests.mipmap_threshold", tests.mipmap_threshold, tests.summed_height, 2 * highest_code,
                         std::ldexp(1.0, datapath::mipmap_threshold_bits(formats)) - 1, "formats.displacement_bits"}));
    result.view_threshold = static_cast<std::uint32_t>(
        to_register({"tests.view_threshold", tests.view_threshold, tests.view, std::ldexp(1.0, formats.screen.fraction),
                     std::ldexp(1.0, formats.screen.bits), "formats.screen_fraction"}));
    result.generation_limit = static_cast<std::uint32_t>(tests.generation_limit);
    return result;
}

bool set_highlight_test(const TestSettings& tests, const glm::dvec3& to_light, const glm::dvec3& to_viewer,
                        const datapath::Formats& formats, datapath::TestParameters& registers,
                        std::uint64_t& saturated) {
    constexpr double pi = 3.14159265358979323846;
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
    registers.highlight_cosine = to_fixed(std::cos(tests.highlight_angle * pi / 180), 2 * formats.normal.fraction);
    registers.highlight_normal_threshold =
        to_normal_register("tests.highlight_normal_threshold", tests.highlight_normal_threshold, true, formats);
    return is_there;
}

}  // namespace tessera

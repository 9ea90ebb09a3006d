#include "testbench/setup/check_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "modules/datapath/format.h"
#include "testbench/setup/faults.h"
#include "testbench/setup/mesh/triangle_geometry.h"
#include "testbench/setup/setting_keys.h"
#include "testbench/setup/unit_vector.h"

namespace tessera {

namespace {

using Vector = std::array<double, 3>;

glm::dvec3 vector(const Vector& v) {
    return {v[0], v[1], v[2]};
}

/// 1 as "1.0".
std::string number(double value) {
    std::string text = fmt::format("{}", value);
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
}

/// The axis that is most nearly perpendicular to a direction.
glm::dvec3 across(const glm::dvec3& v) {
    const glm::dvec3 size = glm::abs(v);
    glm::dvec3 axis(0);
    axis[size.z <= size.x && size.z <= size.y ? 2 : size.y <= size.x ? 1 : 0] = 1;
    return axis;
}

/// A point across `up` from the eye, not farther from the origin than it or 1.
glm::dvec3 ahead_of(const glm::dvec3& eye, const glm::dvec3& up) {
    const glm::dvec3 axis = across(up), distance = axis * std::max(1.0, safe_length(eye));
    return glm::dot(axis, eye) > 0 ? eye - distance : eye + distance;
}

std::string text_of(const glm::dvec3& v) {
    return fmt::format("[{}, {}, {}]", number(v[0]), number(v[1]), number(v[2]));
}

void check_camera(const CameraSettings& camera, const FormatSettings& formats, Faults& faults) {
    const bool known = !is_automatic(camera.eye) && !is_automatic(camera.target);
    const glm::dvec3 eye = vector(camera.eye), target = vector(camera.target), up = vector(camera.up);
    const glm::dvec3 view = target - eye;
    const bool apart = !known || are_apart(camera.eye, camera.target);
    faults.unless(apart, "`camera.eye` = {} and `camera.target` = {} are the same point: set camera.target = {}",
                  text_of(eye), text_of(target), text_of(ahead_of(eye, up)));
    const bool upward = is_automatic(camera.up) || safe_length(up) > 0;
    faults.unless(upward, "`camera.up` = {} has no direction: set one, such as [0, 0, 1]", text_of(up));
    // Below a sine of 1e-6, rounding errors would determine the picture's roll.
    const auto sine = [](const glm::dvec3& a, const glm::dvec3& b) {
        return safe_length(glm::cross(a, b)) / (safe_length(a) * safe_length(b));
    };
    const bool parallel = known && !is_automatic(camera.up) && apart && upward &&
                          sine(brought_near_one(view), brought_near_one(up)) <= 1e-6;
    faults.unless(!parallel,
                  "`camera.up` = {} is parallel to the view direction {} (camera.target - camera.eye): set "
                  "camera.up = {}",
                  text_of(up), text_of(view), text_of(across(view)));
    const std::int64_t integer_bits = formats.screen_bits - formats.screen_fraction - 1;
    const std::int64_t most = integer_bits < 0 ? 0 : std::int64_t{1} << integer_bits;
    const std::int64_t needed =
        datapath::bits_for(static_cast<std::uint64_t>(std::max(camera.viewport_width, camera.viewport_height))) + 1;
    const std::int64_t fraction = std::min(std::max(formats.screen_fraction, FormatSettings{}.screen_fraction),
                                           std::int64_t{datapath::FormatLimits::screen_bits.most} - needed);
    faults.unless(camera.viewport_width <= most && camera.viewport_height <= most,
                  "`camera.viewport_width` = {} by `camera.viewport_height` = {}, but `formats.screen_bits` = {} with "
                  "`formats.screen_fraction` = {} reaches only {} pixels: set formats.screen_fraction = {} and "
                  "formats.screen_bits = {}, or make the viewport smaller",
                  camera.viewport_width, camera.viewport_height, formats.screen_bits, formats.screen_fraction, most,
                  fraction, fraction + needed);
}

void check_formats(const FormatSettings& formats, const TestSettings& tests, Faults& faults) {
    faults.unless(formats.rank_bits > 0 || formats.bound_bits > 0,
                  "`formats.rank_bits` = 0 and `formats.bound_bits` = 0: a Rank Table has ranks, bounds or both: set "
                  "formats.rank_bits = 8, or formats.bound_bits = 8");
    // Not the narrowest that are allowed: with those a run may differ from golden's by more than its checks allow.
    const FormatSettings usual;
    faults.unless(formats.position_fraction < formats.position_bits,
                  "`formats.position_fraction` = {} must be less than `formats.position_bits` = {}: set "
                  "formats.position_bits = {}",
                  formats.position_fraction, formats.position_bits,
                  std::max(usual.position_bits, formats.position_fraction + 1));
    faults.unless(formats.normal_bits - formats.normal_fraction >= 2,
                  "`formats.normal_fraction` = {} leaves {} of `formats.normal_bits` = {} for sign and "
                  "integer, and 1.0 takes 2: set formats.normal_fraction = {} and formats.normal_bits = {}",
                  formats.normal_fraction, formats.normal_bits - formats.normal_fraction, formats.normal_bits,
                  std::max(usual.normal_fraction, formats.normal_fraction),
                  std::max(usual.normal_bits, formats.normal_fraction + 2));
    faults.unless(formats.tex_coord_fraction <= formats.texture_fraction,
                  "`formats.tex_coord_fraction` = {1} must be at most `formats.texture_fraction` = {0}: set "
                  "formats.tex_coord_fraction = {0}, or formats.texture_fraction = {1}",
                  formats.texture_fraction, formats.tex_coord_fraction);
    const std::int64_t generations = std::int64_t{1} << formats.generation_bits;
    faults.unless(tests.generation_limit < generations,
                  "`tests.generation_limit` = {}, but `formats.generation_bits` = {} counts to {}: set "
                  "tests.generation_limit = {}, or formats.generation_bits = {}",
                  tests.generation_limit, formats.generation_bits, generations - 1, generations - 1,
                  datapath::bits_for(static_cast<std::uint64_t>(tests.generation_limit) + 1));
}

/// Checks each member of `Group`, a part of SceneSettings, against its declared range.
template <typename Group>
class RangeCheck {
  public:
    RangeCheck(const char* part, const Group& group, Faults& faults) : part_(part), group_(group), faults_(faults) {}

    template <typename Choice, typename Owner>
    void add(const char* /*name*/, Choice Owner::* /*member*/, const std::string& /*description*/) const {}
    void add(const char* name, std::int64_t Group::*member, const char* /*unit*/, const KeyRange& range,
             const char* /*description*/) const {
        check(name, static_cast<double>(group_.*member), range);
    }
    void add(const char* name, double Group::*member, const char* /*unit*/, const KeyRange& range,
             const std::string& /*description*/) const {
        check(name, group_.*member, range);
    }
    template <typename Member>
    void add_double(const char* name, Member member, const char* /*unit*/, const KeyRange& range,
                    const std::string& /*description*/) const {
        check(name, member(group_), range);
    }
    void add(const char* name, Vector Group::*member, const char* /*unit*/, const KeyRange& range,
             const char* /*description*/) const {
        const Vector& value = group_.*member;
        const auto wrong = std::find_if_not(value.begin(), value.end(), [&](double v) { return range.holds(v); });
        if (wrong != value.end())
            check(name, *wrong, range);
    }

  private:
    void check(const std::string& name, double value, const KeyRange& range) const {
        if (is_automatic(value))
            faults_.texts.push_back(fmt::format("`{}{}` is not set, or not a number: set it", part_, name));
        else
            faults_.unless(range.holds(value), "`{}{}` = {}: must be {}{} to {}", part_, name, value,
                           range.or_zero ? "0, or " : "", range.low, range.high);
    }

    const char* part_;
    const Group& group_;
    Faults& faults_;
};

void check_ranges(const SceneSettings& settings, Faults& faults) {
    declare_scene_keys(RangeCheck<SceneOptions>("", settings, faults));
    declare_displacement_keys(RangeCheck<DisplacementSettings>("displacement.", settings.displacement, faults));
    declare_camera_keys(RangeCheck<CameraSettings>("camera.", settings.camera, faults));
    declare_tests_keys(RangeCheck<TestSettings>("tests.", settings.tests, faults));
    declare_formats_keys(RangeCheck<FormatSettings>("formats.", settings.formats, faults));
    faults.unless(settings.light != Vector{}, "`light` has no direction: set one, such as [0, 0, 1]");
}

}  // namespace

bool are_apart(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    const glm::dvec3 first = vector(a), second = vector(b);
    return safe_length(second - first) > 1e-9 * std::max(safe_length(first), safe_length(second));
}

std::vector<std::string> setting_faults(const CameraSettings& camera, const FormatSettings& formats,
                                        const TestSettings& tests) {
    Faults faults;
    check_camera(camera, formats, faults);
    check_formats(formats, tests, faults);
    return faults.texts;
}

void check_settings(const SceneSettings& settings) {
    Faults faults;
    check_ranges(settings, faults);
    if (faults.texts.empty())
        faults.texts = setting_faults(settings.camera, settings.formats, settings.tests);
    faults.raise();
}

}  // namespace tessera

#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "modules/datapath/parameters.h"
#include "testbench/setup/scene_settings.h"
#include "testbench/setup/tables/rank_table.h"

namespace tessera {

/// Input: [tests]. Output: the edge tests' registers, without the Highlight Test's; thresholds are rounded down to
/// their formats. Throws InputError if a threshold is beyond its register, or below its step without being 0: it would
/// become 0, which means something else. view: for the Rank Test, if it measures errors as seen.
datapath::TestParameters make_tests(const TestSettings& tests, const datapath::Formats& formats,
                                    const ViewedScale& view = {});

/// Sets the Highlight Test's registers. Input: the directions to light and viewer, unit length, world space. Returns
/// false if they are opposite: the test then never requests a split. Throws as make_tests() does.
/// (Decision: Blinn's highlight, OpenGL's default, with light and viewer at infinity: one dot product with a constant
/// vector per normal, instead of a reflected vector and a normalised view vector. At twice the angle it is Phong's. For
/// a near viewer the true highlight is offset by up to half the angle that the surface subtends; tests.highlight_angle
/// must cover that.)
bool set_highlight_test(const TestSettings& tests, const glm::dvec3& to_light, const glm::dvec3& to_viewer,
                        const datapath::Formats& formats, datapath::TestParameters& registers,
                        std::uint64_t& saturated);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "modules/datapath/parameters.h"
#include "testbench/setup/scene_settings.h"
#include "testbench/setup/tables/rank_table.h"

namespace tessera {

/// In: [tests]. Out: the edge tests' registers, thresholds rounded down to their formats; without the Highlight Test's.
/// Throws InputError if a threshold lies beyond its register, or below its step without being 0. view: for the Rank Test,
/// if it judges errors as seen.
datapath::TestParameters make_tests(const TestSettings& tests, const datapath::Formats& formats,
                                    const ViewedScale& view = {});

/// Sets the Highlight Test's registers. In: the directions to light and viewer, unit length, world space. False: they
/// are opposite, and the test never asks for a split. Throws as make_tests() does.
bool set_highlight_test(const TestSettings& tests, const glm::dvec3& to_light, const glm::dvec3& to_viewer,
                        const datapath::Formats& formats, datapath::TestParameters& registers,
                        std::uint64_t& saturated);

}  // namespace tessera

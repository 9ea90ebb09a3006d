#pragma once
#include <array>
#include <string>
#include <vector>

#include "testbench/setup/scene_settings.h"

namespace tessera {

/// Finds faults of a camera, formats and a generation limit whose values are each within their ranges: one sentence per
/// fault, with values and remedy. Automatic values are skipped.
std::vector<std::string> setting_faults(const CameraSettings& camera, const FormatSettings& formats,
                                        const TestSettings& tests);

/// Whether two points of a camera give a direction.
bool are_apart(const std::array<double, 3>& a, const std::array<double, 3>& b);

/// Throws InputError unless every value is set, within its range, and possible.
void check_settings(const SceneSettings& settings);

}  // namespace tessera

#pragma once
#include <string>
#include <vector>

#include "testbench/setup/scene_settings.h"

namespace tessera {

/// What is impossible about a camera, formats and a generation limit, each by itself within its range: a sentence each,
/// with values and remedy. Automatic values are passed over.
std::vector<std::string> setting_faults(const CameraSettings& camera, const FormatSettings& formats,
                                        const TestSettings& tests);

/// Throws InputError unless every value is set, within its range, and possible.
void check_settings(const SceneSettings& settings);

}  // namespace tessera

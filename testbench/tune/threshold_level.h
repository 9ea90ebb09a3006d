#pragma once
#include <cstdint>

namespace tessera {

/// Thresholds are searched on an integer logarithmic scale: level 0 is 1, and each `levels_per_octave` levels are a
/// factor of two. Uses only integers, and square roots and products of doubles: the same thresholds on every machine.
constexpr int levels_per_octave = 1024;

/// 2^(level / levels_per_octave), rounded to five decimal digits as in the job file. level: -2^20 .. 2^20.
double threshold_at(int level);

/// The least level whose threshold is at least `value` > 0.
int level_of(double value);

}  // namespace tessera

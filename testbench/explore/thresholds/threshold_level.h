#pragma once
#include <cstdint>

namespace tessera {

/// Thresholds are searched on a logarithmic scale of whole numbers: level 0 is 1, every `levels_per_octave` a factor of
/// two. Whole numbers, and square roots and products of doubles only: the same thresholds on every machine.
constexpr int levels_per_octave = 1024;

/// 2^(level / levels_per_octave), rounded to five decimal digits: what a job file then says. level: -2^20 .. 2^20.
double threshold_at(int level);

/// The least level whose threshold is at least `value` > 0.
int level_of(double value);

}  // namespace tessera

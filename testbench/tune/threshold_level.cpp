#include "testbench/tune/threshold_level.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace tessera {

double threshold_at(int level) {
    const int octave = level >= 0 ? level / levels_per_octave : -((levels_per_octave - 1 - level) / levels_per_octave);
    int rest = level - octave * levels_per_octave;
    double value = 1, root = std::sqrt(2.0);
    for (int bit = levels_per_octave / 2; bit > 0; bit /= 2, root = std::sqrt(root))
        if ((rest & bit) != 0)
            value *= root;
    return std::stod(fmt::format("{:.4e}", std::ldexp(value, octave)));
}

int level_of(double value) {
    int level = std::ilogb(value) * levels_per_octave;
    for (int step = levels_per_octave; step > 0; step /= 2)
        while (threshold_at(level + step) < value)
            level += step;
    return threshold_at(level) < value ? level + 1 : level;
}

}  // namespace tessera

#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/common/random.h"
#include "testbench/setup/height_map.h"

namespace tessera {

/// A displacement map of integer samples, as in a PGM file; row 0 is the top one.
struct RandomMap {
    int width = 1;
    int height = 1;
    int highest = 65535;  ///< PGM's maximum value
    std::vector<std::uint16_t> samples;

    /// The result of reading pgm().
    HeightMap height_map() const;
    /// The map as a file: binary PGM.
    std::string pgm() const;
};

/// Up to 96 texels per side: 1 x 1, 1 x N, N x 1, odd, powers of two; noise, steps, extremes (0 and 65535 only),
/// spikes, ramps, waves, constants.
RandomMap make_random_map(Random& random);

}  // namespace tessera

#pragma once
#include <cmath>
#include <cstdint>

namespace tessera::testing {

/// Wide enough for every product of the datapath.
__extension__ using Wide = __int128;

/// value / 2^shift, rounded to nearest, ties upwards: by division, without shifts.
inline Wide nearest(Wide value, int shift) {
    const Wide unit = Wide{1} << shift;
    Wide quotient = value / unit;
    Wide rest = value % unit;
    if (rest < 0) {
        rest += unit;
        --quotient;
    }
    return 2 * rest >= unit ? quotient + 1 : quotient;
}

inline Wide clamped(Wide value, Wide lowest, Wide highest) {
    return value < lowest ? lowest : (value > highest ? highest : value);
}

}  // namespace tessera::testing

#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/intermediate.h"
#include "modules/datapath/multiplications.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

struct CullWidths : Intermediates {
    using Intermediates::Intermediates;
    Width difference{"x_b - x_a", f.screen.bits + 1};
    Width product{"(x_b - x_a) * (y_c - y_a)", 2 * difference.bits - 1, 128};
    constexpr auto all() const { return std::array{difference, product}; }
};
static_assert(fits_every_format<CullWidths>());

/// Back-face culling of a finished triangle: true if its screen-space area is not positive (y upwards,
/// counter-clockwise is front). A triangle with a vertex on or behind the near plane is kept for the clipper.
constexpr bool faces_away(const ScreenPosition& a, const ScreenPosition& b, const ScreenPosition& c) {
    if (!(a.in_front && b.in_front && c.in_front))
        return false;
    __extension__ using Product = __int128;
    const std::int64_t abx = std::int64_t{b.x} - a.x, aby = std::int64_t{b.y} - a.y;
    const std::int64_t acx = std::int64_t{c.x} - a.x, acy = std::int64_t{c.y} - a.y;
    return Product{abx} * acy <= Product{aby} * acx;
}

inline Multiplications faces_away_multiplications(const Formats& f) {
    const int difference = CullWidths{f}.difference.bits;
    return Multiplications().add(2, difference, difference);
}

}  // namespace tessera::datapath

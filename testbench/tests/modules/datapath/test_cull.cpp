#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>

#include "modules/datapath/cull.h"
#include "testbench/common/random.h"
#include "testbench/tests/modules/datapath/datapath_reference.h"

using namespace tessera::datapath;
using namespace tessera::testing;
using tessera::Random;

namespace {

/// Twice the signed area, by the sum over the corners, without differences.
Wide doubled_area(const ScreenPosition& a, const ScreenPosition& b, const ScreenPosition& c) {
    const auto cross = [](const ScreenPosition& p, const ScreenPosition& q) {
        return Wide{p.x} * q.y - Wide{p.y} * q.x;
    };
    return cross(a, b) + cross(b, c) + cross(c, a);
}

void check(const ScreenPosition& a, const ScreenPosition& b, const ScreenPosition& c) {
    const bool away = doubled_area(a, b, c) <= 0;
    if (faces_away(a, b, c) != away || faces_away(b, c, a) != away || faces_away(c, a, b) != away)
        FAIL(a.x << " " << a.y << ", " << b.x << " " << b.y << ", " << c.x << " " << c.y);
}

}  // namespace

TEST_CASE("culling: follows the sign of the exact area, screen positions of 8 to 32 bits") {
    Random random(22);
    for (int k = 0; k < 600'000; ++k) {
        const int bits = static_cast<int>(random.integer(8, 32));
        const std::int64_t limit = std::int64_t{1} << (bits - 1);
        const auto point = [&] {
            return ScreenPosition{random.integer32(-limit, limit - 1), random.integer32(-limit, limit - 1), 0, true};
        };
        const ScreenPosition a = point(), b = point();
        check(a, b, point());
        // nearly edge-on: the third vertex beside the midpoint of the first two
        ScreenPosition c{static_cast<std::int32_t>((std::int64_t{a.x} + b.x) >> 1),
                         static_cast<std::int32_t>((std::int64_t{a.y} + b.y) >> 1), 0, true};
        check(a, b, c);
    }
}

TEST_CASE("culling: corners of the widest screen") {
    constexpr std::int32_t low = std::numeric_limits<std::int32_t>::min(), high = 0x7fffffff;
    for (int corners = 0; corners < 4096; ++corners) {
        const auto coordinate = [&](int place) {
            const int digit = corners >> (2 * place) & 3;
            return digit == 0 ? low : (digit == 1 ? -1 : (digit == 2 ? 0 : high));
        };
        check({coordinate(0), coordinate(1), 0, true}, {coordinate(2), coordinate(3), 0, true},
              {coordinate(4), coordinate(5), 0, true});
    }
}

TEST_CASE(
    "culling: keeps counter-clockwise triangles, culls edge-on ones, keeps any with a vertex behind the near plane") {
    const ScreenPosition a{0, 0, 0, true}, b{10, 0, 0, true}, c{0, 10, 0, true};
    CHECK_FALSE(faces_away(a, b, c));
    CHECK(faces_away(a, c, b));
    CHECK(faces_away(a, b, {20, 0, 0, true}));
    CHECK(faces_away(a, a, a));
    for (int behind = 1; behind < 8; ++behind) {
        ScreenPosition p = a, q = c, r = b;  // would be culled
        p.in_front = (behind & 1) == 0;
        q.in_front = (behind & 2) == 0;
        r.in_front = (behind & 4) == 0;
        CHECK_FALSE(faces_away(p, q, r));
    }
}

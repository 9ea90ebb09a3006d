#include <catch2/catch.hpp>

#include "modules/datapath/widths.h"

using namespace tessera::datapath;

TEST_CASE("widths: stream widths in the default formats, added up by hand") {
    // P 3 x 32; N, T 3 x 16; t 2 x 25; P's 2 x 24, w 32, in front 1
    const Widths widths = stream_widths(Formats{});
    CHECK(widths.base_vertex == 96 + 48 + 48 + 1 + 50);
    CHECK(widths.vertex == 243 + 4 + 2 + 96 + 48 + 48 + 81);
    CHECK(widths.triangle == 3 * 522 + 6);
    CHECK(widths.emitted_vertex == 81 + 48 + 50);
    CHECK(widths.finished_vertex == 96 + 48 + 50);
}

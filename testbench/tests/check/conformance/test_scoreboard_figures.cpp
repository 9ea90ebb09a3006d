#include <catch2/catch.hpp>
#include <cmath>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/tests/check/conformance/scoreboard_cases.h"

using namespace tessera;
using namespace tessera::testing;

TEST_CASE("the figures of a quantity equal those worked out by hand") {
    Random random(14);
    Case c(random, datapath::Formats{}, Manner::tame);
    datapath::Triangle triangle = c.pass(random).triangle;
    for (datapath::Vertex& v : triangle.vertices)
        v.position = {0, 0, 0};
    triangle.vertices[1].position.x = 1;
    datapath::TrianglePass pass = c.evaluate(triangle, true);
    // On edges 0 and 1 the midpoints of 0 and 1 are rounded down to 0: an error of -1/2, which equals the bound. All
    // others are exact.
    ConformanceResult result = check(c, pass);
    CHECK(result.passes == 1);
    CHECK(result.edges == 3);
    CHECK(result.base_vertices == 3);
    {
        const ConformanceResult::Quantity& q = quantity(result, "P_ij");
        CHECK(q.count == 9);
        CHECK(q.outside == 0);
        CHECK(q.max_error == 0.5);
        CHECK(q.rms_error == Approx(std::sqrt(2 * 0.25 / 9)));
        CHECK(q.max_bound == 0.5);
        CHECK(q.worst_ratio == 1);
    }
    // Above golden no error is allowed: 3 LSB are three bounds. Below, half an LSB is: 1 LSB is two bounds.
    pass.new_vertex[2].position.x = 3;
    pass.new_vertex[2].position.y = -1;
    result = check(c, pass);
    const ConformanceResult::Quantity& q = quantity(result, "P_ij");
    CHECK(q.outside == 2);
    CHECK(q.max_error == 3);
    CHECK(q.rms_error == Approx(std::sqrt((2 * 0.25 + 9 + 1) / 9)));
    CHECK(q.worst_ratio == 3);
    CHECK(result.mismatches == 2);
}

TEST_CASE("a run that compared nothing does not pass, nor does one with too many flips") {
    ConformanceResult result;
    result.quantities.emplace_back();
    result.tests.emplace_back();
    CHECK(result.flips_percent() == 0);
    CHECK(result.empty());
    CHECK_FALSE(result.passed(100));
    result.edges = 1000;
    CHECK(result.empty());
    result.quantities[0].count = 1;
    CHECK(result.empty());
    result.tests[0].compared = 1;
    CHECK_FALSE(result.empty());
    CHECK(result.passed(0));
    result.flipped_edges = 5;
    CHECK(result.passed(0.5));
    CHECK_FALSE(result.passed(0.4));
    result.mismatches = 1;
    CHECK_FALSE(result.passed(100));
}

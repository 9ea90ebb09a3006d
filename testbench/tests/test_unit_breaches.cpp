#include <catch2/catch.hpp>
#include <string>

#include "modules/unit/pass_pool.h"
#include "modules/units/lighting.h"
#include "modules/units/pass_or_tessellate.h"
#include "testbench/tests/timed_modules.h"

// Units alone, given what no machine that is in order gives them: they say so, and go on with nothing.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using sc_core::SC_ZERO_TIME;

namespace {

/// What brings the parts of a pass from both branches, one as a whole after the other.
struct JoinBench {
    datapath::Registers registers;
    Clock clock{"clock", sc_core::sc_time(10, sc_core::SC_PS)};
    PassPool passes;
    PassOrTessellate unit{"unit", clock, registers, Timing{}, 1, passes};
    Sink<Work> tessellation{"tessellation", clock};
    Sink<datapath::Triangle> lighting{"lighting", clock};
    BareInitiator<Work> transform{"transform"};
    BareInitiator<Work> tests{"tests"};

    JoinBench() {
        transform.out.bind(unit.from_transform);
        tests.out.bind(unit.from_tessellation_tests[0]);
        unit.to_tessellation.bind(tessellation.in);
        unit.to_lighting.bind(lighting.in);
        sc_core::sc_start(SC_ZERO_TIME);
    }
    void bring(BareInitiator<Work>& branch, Pass& pass) {
        Work work{&pass,
                  static_cast<Parts>(&branch == &tests ? parts_of(pass) & edge_parts : parts_of(pass))};
        sc_core::sc_time delay = SC_ZERO_TIME;
        branch.out->b_transport(work, delay);
    }
};

}  // namespace

TEST_CASE("pass or tessellate: a pass waits for its other branch, in functional mode too") {
    JoinBench bench;
    Pass pass;
    pass.tested = true;
    CHECK(bench.unit.joined());
    bench.bring(bench.transform, pass);
    CHECK_FALSE(bench.unit.joined());
    CHECK(bench.unit.counts().passes == 0);
    bench.bring(bench.tests, pass);
    CHECK(bench.unit.joined());
    CHECK(bench.unit.counts().passes == 1);
}

TEST_CASE("pass or tessellate: branches that bring different triangles are an error") {
    JoinBench bench;
    Pass pass, other;
    pass.tested = other.tested = true;
    other.number = 1;
    bench.bring(bench.transform, pass);
    CHECK_THAT(error_of([&] { bench.bring(bench.tests, other); }), Contains("different triangles"));
    CHECK_THAT(error_of([&] { bench.bring(bench.transform, pass); }), Contains("came twice"));
    CHECK(bench.unit.counts().passes == 0);
}

TEST_CASE("pass or tessellate: in functional mode a triangle may overtake another that waits outside") {
    JoinBench bench;
    Pass first, second;
    first.tested = second.tested = true;
    first.new_vertices = second.new_vertices = 7;  // so that both go to Tessellation
    first.number = 4;
    second.number = 5;
    bench.bring(bench.transform, first);
    bench.bring(bench.transform, second);
    bench.bring(bench.tests, second);
    CHECK_FALSE(bench.unit.joined());
    bench.bring(bench.tests, first);
    CHECK(bench.unit.joined());
    REQUIRE(bench.tessellation.items.size() == 2);
    CHECK(bench.tessellation.items[0].pass == &second);
    CHECK(bench.tessellation.items[1].pass == &first);
}

TEST_CASE("lighting: a triangle without its normals in screen space is an error") {
    const datapath::Registers registers;
    Clock clock("clock", sc_core::sc_time(10, sc_core::SC_PS));
    Lighting unit("unit", clock, registers, Timing{});
    Sink<LitTriangle> rasteriser("rasteriser", clock);
    BareInitiator<datapath::Triangle> producer("producer");
    producer.out.bind(unit.from_pass_or_tessellate);
    unit.to_rasteriser.bind(rasteriser.in);
    sc_core::sc_start(SC_ZERO_TIME);
    datapath::Triangle triangle;
    sc_core::sc_time delay = SC_ZERO_TIME;
    for (std::size_t known = 0; known < 3; ++known) {
        CHECK_THAT(error_of([&] { producer.out->b_transport(triangle, delay); }),
                   Contains("without its normals"));
        triangle.vertices[known].screen_normal_known = true;
    }
    CHECK(rasteriser.items.empty());
    producer.out->b_transport(triangle, delay);
    CHECK(rasteriser.items.size() == 1);
}

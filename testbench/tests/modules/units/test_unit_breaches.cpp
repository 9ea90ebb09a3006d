#include <catch2/catch.hpp>
#include <string>

#include "modules/units/pass_or_tessellate.h"
#include "testbench/tests/support/timed_modules.h"

// Single units, given inputs that no correct machine produces: they report an error and pass nothing on.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using sc_core::SC_ZERO_TIME;

namespace {

/// Sends a triangle, and its parts from both branches, one whole branch after the other.
struct JoinBench {
    datapath::Registers registers;
    Design design;
    CycleScheduler clock{"clock", sc_core::sc_time(10, sc_core::SC_PS)};
    PassOrTessellate unit{"unit", {clock, registers, design}};
    Sink<DecidedTriangle> tessellation{"tessellation", clock};
    Sink<TriangleToLight> lighting{"lighting", clock};
    BareInitiator<TakenTriangle> get_triangle{"get_triangle"};
    BareInitiator<ScreenPoint> transform{"transform"};
    BareInitiator<TestedEdge> tests{"tests"};

    JoinBench() {
        get_triangle.out.bind(unit.from_get_triangle);
        transform.out.bind(unit.from_transform);
        tests.out.bind(unit.from_tessellation_tests[0]);
        unit.to_tessellation.bind(tessellation.in);
        unit.to_lighting.bind(lighting.in);
        sc_core::sc_start(SC_ZERO_TIME);
    }
    void bring(TakenTriangle taken) {
        sc_core::sc_time delay = SC_ZERO_TIME;
        get_triangle.out->b_transport(taken, delay);
    }
    template <class Item>
    void bring_parts(BareInitiator<Item>& branch, const TakenTriangle& taken, Parts parts) {
        for (std::uint8_t part = 0; part < 9; ++part) {
            Item item;
            item.tag = {taken.tag, part, taken.origin};
            sc_core::sc_time delay = SC_ZERO_TIME;
            if ((parts & item.tag.bit()) != 0)
                branch.out->b_transport(item, delay);
        }
    }
    void bring_geometry(const TakenTriangle& taken) { bring_parts(transform, taken, parts_of(taken.triangle)); }
    void bring_tests(const TakenTriangle& taken) { bring_parts(tests, taken, edge_parts); }
};

/// A base triangle, or one with all values known.
TakenTriangle taken(Tag tag, bool base) {
    TakenTriangle triangle;
    triangle.tag = triangle.origin.pass = tag;
    for (datapath::Vertex& vertex : triangle.triangle.vertices)
        vertex.displaced_known = vertex.screen_normal_known = !base;
    return triangle;
}

}  // namespace

TEST_CASE("pass or tessellate: a pass waits for its other branch, also in functional mode") {
    JoinBench bench;
    const TakenTriangle triangle = taken(0, false);
    CHECK(bench.unit.joined());
    bench.bring(triangle);
    bench.bring_geometry(triangle);
    CHECK_FALSE(bench.unit.joined());
    CHECK(bench.unit.counts().passes == 0);
    bench.bring_tests(triangle);
    CHECK(bench.unit.joined());
    CHECK(bench.unit.counts().passes == 1);
}

TEST_CASE("pass or tessellate: a part of an absent triangle, or one that comes twice, is an error") {
    JoinBench bench;
    const TakenTriangle triangle = taken(0, false);
    const TakenTriangle other = taken(1, false);
    bench.bring(triangle);
    bench.bring_geometry(triangle);
    CHECK_THAT(error_of([&] { bench.bring_tests(other); }), Contains("has not arrived"));
    CHECK_THAT(error_of([&] { bench.bring_geometry(other); }), Contains("has not arrived"));
    CHECK_THAT(error_of([&] { bench.bring_geometry(triangle); }), Contains("arrived twice"));
    bench.bring(other);  // its other parts are still to arrive
    const auto edge_from_transform = [&] { bench.bring_parts(bench.transform, other, 0100); };
    const auto edge_from_tests = [&] { bench.bring_parts(bench.tests, other, 0100); };
    edge_from_transform();
    edge_from_tests();
    CHECK_THAT(error_of(edge_from_transform), Contains("arrived twice"));
    CHECK_THAT(error_of(edge_from_tests), Contains("arrived twice"));
    CHECK(bench.unit.counts().passes == 0);
}

TEST_CASE("pass or tessellate: in functional mode a triangle may overtake another that waits for parts") {
    JoinBench bench;
    const TakenTriangle first = taken(4, true), second = taken(5, true);  // so that both go to Tessellation
    for (const TakenTriangle& triangle : {first, second}) {
        bench.bring(triangle);
        bench.bring_geometry(triangle);
    }
    bench.bring_tests(second);
    CHECK_FALSE(bench.unit.joined());
    bench.bring_tests(first);
    CHECK(bench.unit.joined());
    REQUIRE(bench.tessellation.items.size() == 2);
    CHECK(bench.tessellation.items[0].origin.pass == 5);
    CHECK(bench.tessellation.items[1].origin.pass == 4);
}

TEST_CASE("pass or tessellate: a finished triangle waits for its normals in screen space") {
    JoinBench bench;
    for (std::size_t unknown = 0; unknown < 3; ++unknown) {
        TakenTriangle triangle = taken(static_cast<Tag>(unknown), false);
        triangle.triangle.vertices[unknown].screen_normal_known = false;
        bench.bring(triangle);
        for (std::uint8_t part = first_edge_part; part < 9; ++part) {
            ScreenPoint edge;
            edge.tag = {triangle.tag, part, {}};
            sc_core::sc_time delay = SC_ZERO_TIME;
            bench.transform.out->b_transport(edge, delay);
        }
        bench.bring_tests(triangle);
        CHECK_FALSE(bench.unit.joined());  // its normal is still missing, and would complete it
        ScreenPoint normal;
        normal.tag = {triangle.tag, static_cast<std::uint8_t>(first_normal_part + unknown), {}};
        sc_core::sc_time delay = SC_ZERO_TIME;
        bench.transform.out->b_transport(normal, delay);
    }
    CHECK(bench.lighting.items.size() == 3);
    CHECK(bench.unit.joined());
}

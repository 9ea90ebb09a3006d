#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "modules/units/edge_tests/view.h"
#include "testbench/tests/support/timed_modules.h"

// The View Test unit alone, through its sockets.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// A threshold of 100 pixels.
struct Bench {
    datapath::Registers registers;
    Design design;
    CycleScheduler clock{"clock", sc_core::sc_time(10, sc_core::SC_PS)};
    Sink<ViewResult> sink{"sink", clock};
    ViewTest unit;
    Driver<ViewOperands> edges{"edges", clock};
    Driver<ScreenCorner> corners{"corners", clock};

    Bench() : unit("unit", {clock, with_threshold(registers), design}) {
        clock.attach(unit);
        edges.out.bind(unit.input);
        corners.out.bind(*unit.from_transform);
        unit.output.bind(sink.in);
    }

    static const datapath::Registers& with_threshold(datapath::Registers& registers) {
        registers.tests.view_test = true;
        registers.tests.view_threshold = 100u << registers.formats.screen.fraction;
        return registers;
    }

    datapath::ScreenPosition at(int x) const { return {x * (1 << registers.formats.screen.fraction), 0, 0, true}; }

    /// Edge k of a triangle whose vertices in `new_vertices` have no P's yet.
    void add_edge(unsigned k, unsigned new_vertices, int x_i, int x_j) {
        ViewOperands edge;
        edge.tag.part = static_cast<std::uint8_t>(first_edge_part + k);
        edge.new_vertices = static_cast<std::uint8_t>(new_vertices);
        edge.screen_i = at(x_i);
        edge.screen_j = at(x_j);
        edges.items.push_back(edge);
    }

    std::vector<bool> decisions() const {
        std::vector<bool> split;
        for (const ViewResult& result : sink.items)
            split.push_back(result.view);
        return split;
    }
};

}  // namespace

TEST_CASE("View Test unit: an edge longer than the threshold is split, one per cycle") {
    Bench bench;
    bench.add_edge(0, 0, 0, 100);
    bench.add_edge(1, 0, 0, 101);
    bench.add_edge(2, 0, 101, 0);
    sc_core::sc_start();
    CHECK(bench.decisions() == std::vector<bool>{false, true, true});
    CHECK(bench.sink.cycles == std::vector<std::uint64_t>{1, 2, 3});
}

// Vertex 1 is new, at x = 50, vertices 0 and 2 are at -60 and 30; where the edges carry vertex 1, it is at 0 and at 500.
TEST_CASE("View Test unit: P's of a new vertex comes from Transform, that of any other from the edge") {
    Bench bench;
    bench.add_edge(0, 2, -60, 0);
    bench.add_edge(1, 2, 500, 30);
    bench.add_edge(2, 2, 30, -60);
    ScreenCorner corner;
    corner.tag.part = 1;
    corner.screen = bench.at(50);
    bench.corners.items = {corner};
    sc_core::sc_start();
    CHECK(bench.decisions() == std::vector<bool>{true, false, false});
}

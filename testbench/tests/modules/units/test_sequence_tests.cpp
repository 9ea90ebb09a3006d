#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/edge_tests.h"
#include "modules/units/edge_tests/sequence_tests.h"
#include "testbench/tests/support/stub_test.h"
#include "testbench/tests/support/timed_modules.h"

// Sequence Tests alone, through its sockets. The two table tests are stubs that respond with given bits.

using namespace tessera;
using namespace tessera::testing;

namespace {

constexpr unsigned combinations = 64;  // of the six tests

/// Edge number k has the results `k % combinations`; from `combinations` on it belongs to a base triangle.
unsigned says(const PartTag& tag) {
    return tag.triangle % combinations;
}
bool of_base_triangle(const PartTag& tag) {
    return tag.triangle >= combinations;
}

unsigned expected_evaluations(const PartTag& tag) {
    const unsigned tests = says(tag);
    const bool may_split = (tests & datapath::gating_tests) == datapath::gating_tests;
    unsigned evaluated = datapath::gating_tests;
    if (may_split || of_base_triangle(tag))
        evaluated |= datapath::normal_bit | datapath::highlight_bit;
    if (may_split && (tests & (datapath::normal_bit | datapath::highlight_bit)) == 0)
        evaluated |= datapath::summed_height_bit;
    return evaluated;
}

NormalResult answer(const NormalOperands& edge) {
    NormalResult result{edge.tag};
    result.n = {1, 2, 3};
    result.normal = (says(edge.tag) & datapath::normal_bit) != 0;
    result.highlight = (says(edge.tag) & datapath::highlight_bit) != 0;
    return result;
}
HeightResult answer(const HeightOperands& edge) {
    return {edge.tag, (says(edge.tag) & datapath::summed_height_bit) != 0};
}

struct Bench {
    datapath::Registers registers;
    Design design;
    CycleScheduler clock{"clock", sc_core::sc_time(10, sc_core::SC_PS)};
    UnitContext context{clock, registers, design};
    Sink<TestedEdge> sink;
    SequenceTests unit;
    StubTest<NormalOperands, NormalResult> normal_test;
    StubTest<HeightOperands, HeightResult> summed_height_test;
    Driver<NormalOperands> normal_operands;
    Driver<HeightOperands> height_operands;
    Driver<TexCoordResult> tex_coord_results;
    Driver<ViewResult> view_results;

    explicit Bench(const Timing& timing = {})
        : design(with(timing)),
          sink("sink", clock, timing.stalls),
          unit("sequence_tests", context),
          normal_test("normal_test", context, {5, 1, 1}, answer),
          summed_height_test("summed_height_test", context, {7, 12, 1}, answer),
          normal_operands("normal_operands", clock, timing.stalls),
          height_operands("height_operands", clock, timing.stalls),
          tex_coord_results("tex_coord_results", clock, timing.stalls),
          view_results("view_results", clock, timing.stalls) {
        registers.tests.highlight_test = true;
        registers.formats.highlight_tag = true;
        for (CycleProcess* process : {static_cast<CycleProcess*>(&summed_height_test),
                                      static_cast<CycleProcess*>(&normal_test), static_cast<CycleProcess*>(&unit)})
            clock.attach(*process);
        normal_operands.out.bind(unit.normal_operands);
        height_operands.out.bind(unit.height_operands);
        tex_coord_results.out.bind(unit.from_tex_coord_test);
        view_results.out.bind(unit.from_view_test);
        unit.to_normal_test.bind(normal_test.input);
        unit.to_summed_height_test.bind(summed_height_test.input);
        normal_test.output.bind(unit.from_normal_test);
        summed_height_test.output.bind(unit.from_summed_height_test);
        unit.to_pass_or_tessellate.bind(sink.in);
    }

    static Design with(const Timing& timing) {
        Design design;
        design.timing = timing;
        return design;
    }

    void add_edge(unsigned number) {
        PartTag tag;
        tag.triangle = number;
        tag.part = first_edge_part;
        NormalOperands operands;
        operands.tag = tag;
        operands.new_vertices = of_base_triangle(tag) ? 7 : 0;
        const unsigned tests = says(tag);
        normal_operands.items.push_back(operands);
        height_operands.items.push_back({{}, tag});
        tex_coord_results.items.push_back(
            {tag, {number, 7}, (tests & datapath::tex_coord_bit) != 0, (tests & datapath::generation_bit) != 0});
        view_results.items.push_back({tag, (tests & datapath::view_bit) != 0});
    }
    void add_vertex() {
        NormalOperands vertex;
        vertex.tag.triangle = combinations;
        normal_operands.items.push_back(vertex);
    }

    /// Requires each edge once, in order, with the evaluated tests and nothing else.
    void expect_edges(unsigned edges) const {
        REQUIRE(sink.items.size() == edges);
        for (unsigned k = 0; k < edges; ++k) {
            const TestedEdge& edge = sink.items[k];
            CAPTURE(k);
            CHECK(edge.tag.triangle == k);
            const unsigned evaluated = expected_evaluations(edge.tag);
            CHECK(edge.found.evaluated == evaluated);
            CHECK(edge.found.tests == (says(edge.tag) & evaluated));
            CHECK(edge.found.texture == datapath::TexCoord{k, 7});
            CHECK((edge.found.normal == datapath::Direction{1, 2, 3}) == ((evaluated & datapath::normal_bit) != 0));
        }
    }
};

void run_all_combinations(const Timing& timing) {
    Bench bench(timing);
    unsigned normal = 0, summed_height = 0;
    for (unsigned k = 0; k < 2 * combinations; ++k) {
        if (k == combinations)
            bench.add_vertex();
        bench.add_edge(k);
        const PartTag tag = bench.view_results.items.back().tag;
        normal += (expected_evaluations(tag) & datapath::normal_bit) != 0;
        summed_height += (expected_evaluations(tag) & datapath::summed_height_bit) != 0;
    }
    sc_core::sc_start();
    bench.expect_edges(2 * combinations);
    CHECK(bench.normal_test.asked.size() == normal + 1);  // one more for the vertex
    CHECK(bench.summed_height_test.asked.size() == summed_height);
    CHECK(bench.unit.describe_contents().empty());
    CHECK(bench.unit.idle());
}

}  // namespace

TEST_CASE("every combination of tests: an edge goes only to tests that its decision depends on, and leaves in order") {
    run_all_combinations({});
}

TEST_CASE("every combination of tests, with buffers for one edge") {
    Timing timing;
    timing.edges_in_sequence = timing.results_buffer = 1;
    run_all_combinations(timing);
}

TEST_CASE("every combination of tests, with random stalls") {
    Timing timing;
    timing.edges_in_sequence = 3;
    timing.stalls = {5, 400, 30};
    run_all_combinations(timing);
}

TEST_CASE("a design without a Summed Height Test never requests it") {
    Bench bench;
    bench.registers.tests.summed_height_test = false;
    bench.add_edge(datapath::gating_tests);
    sc_core::sc_start();
    REQUIRE(bench.sink.items.size() == 1);
    CHECK(bench.summed_height_test.asked.empty());
    CHECK(bench.sink.items[0].found.evaluated == (datapath::all_tests & ~datapath::summed_height_bit));
}

// All operands are present in cycle 0; the unit takes an edge per cycle. The stubs take 5 and 7 cycles.
TEST_CASE("an edge takes the cycles of its tests, one after another") {
    const unsigned gates = datapath::gating_tests;
    Bench bench;
    for (const unsigned tests : {0U, datapath::normal_bit | gates, gates, 0U})
        bench.add_edge(tests);
    sc_core::sc_start();
    // Edge 0 needs neither. Edge 1 asks the Normal Test alone, edge 2 both; edge 3 leaves a cycle behind it.
    CHECK(bench.sink.cycles == std::vector<std::uint64_t>{0, 1 + 5, 2 + 5 + 7, 2 + 5 + 7 + 1});
}

TEST_CASE("blocking transport: the same decisions, and the sum of the tests' latencies") {
    Bench bench;
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    for (unsigned k = 0; k < 2 * combinations; ++k)
        bench.add_edge(k);
    const sc_core::sc_time cycle = bench.clock.period();
    for (unsigned k = 0; k < 2 * combinations; ++k) {
        sc_core::sc_time normal, height, tex_coord = 2 * cycle, view;
        bench.normal_operands.out.transport(bench.normal_operands.items[k], normal);
        bench.height_operands.out.transport(bench.height_operands.items[k], height);
        bench.tex_coord_results.out.transport(bench.tex_coord_results.items[k], tex_coord);
        bench.view_results.out.transport(bench.view_results.items[k], view);
    }
    bench.expect_edges(2 * combinations);
    for (unsigned k = 0; k < 2 * combinations; ++k) {
        const unsigned evaluated = expected_evaluations(bench.sink.items[k].tag);
        const unsigned cycles = 2 + ((evaluated & datapath::normal_bit) != 0 ? 5u : 0u) +
                                ((evaluated & datapath::summed_height_bit) != 0 ? 7u : 0u);
        CHECK(bench.sink.delays[k] == cycles * cycle);
    }
}

TEST_CASE("operands and results of different edges are an error") {
    Bench bench;
    bench.add_edge(datapath::gating_tests);
    bench.height_operands.items[0].tag.triangle = 17;
    CHECK_THROWS_WITH(sc_core::sc_start(), Catch::Contains("the tests' results belong to different edges"));
}

TEST_CASE("operands and results of different edges of one triangle are an error") {
    Bench bench;
    bench.add_edge(datapath::gating_tests);
    bench.height_operands.items[0].tag.part ^= 1;
    CHECK_THROWS_WITH(sc_core::sc_start(), Catch::Contains("the tests' results belong to different edges"));
}

TEST_CASE("an answer for another edge than the requested one is an error") {
    Bench bench;
    bench.normal_test.answers_for = 17;
    bench.add_edge(datapath::gating_tests);
    CHECK_THROWS_WITH(sc_core::sc_start(), Catch::Contains("a result for an edge that was not sent to the test"));
}

TEST_CASE("an answer without a request is an error") {
    Bench bench;
    bench.add_edge(0);
    NormalResult result;
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    bench.normal_test.output.send(result);
    CHECK_THROWS_WITH(sc_core::sc_start(), Catch::Contains("a result for an edge that was not sent to the test"));
}

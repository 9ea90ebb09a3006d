#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "modules/datapath/edge_tests.h"
#include "modules/units/family/sequence_tests.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/stub_test.h"
#include "testbench/tests/support/timed_modules.h"

// Sequence Tests of a machine of families alone, through its sockets, with three lanes and two Normal Tests. The table
// tests are stubs that respond with given bits.

using namespace tessera;
using namespace tessera::testing;

namespace {

constexpr unsigned lanes = 3, normal_tests = 2;
constexpr unsigned combinations = 64;  // of the six tests
constexpr unsigned families = 40;

unsigned says(const PartTag& tag) {
    return (tag.triangle * 9 + tag.part) % combinations;
}

unsigned expected_evaluations(const PartTag& tag) {
    const unsigned tests = says(tag);
    if ((tests & datapath::gating_tests) != datapath::gating_tests)
        return datapath::gating_tests;
    const bool splits = (tests & (datapath::normal_bit | datapath::highlight_bit)) != 0;
    return splits ? datapath::all_tests & ~datapath::summed_height_bit : unsigned{datapath::all_tests};
}

NormalResult answer(const NormalOperands& part) {
    NormalResult result{part.tag};
    result.displaced_n = {static_cast<std::int32_t>(part.tag.triangle), part.tag.part, 7};
    result.normal = (says(part.tag) & datapath::normal_bit) != 0;
    result.highlight = (says(part.tag) & datapath::highlight_bit) != 0;
    return result;
}
HeightResult answer(const HeightOperands& edge) {
    return {edge.tag, (says(edge.tag) & datapath::summed_height_bit) != 0};
}

Design with(const Timing& timing) {
    Design design;
    design.timing = timing;
    design.work = Work::family;
    design.test_order = TestOrder::cheap_first;
    design.edge_lanes = lanes;
    design.normal_tests = normal_tests;
    return design;
}

struct Lane {
    Driver<NormalOperands> normal_operands;
    Driver<HeightOperands> height_operands;
    Driver<TexCoordResult> tex_coord_results;
    Driver<ViewResult> view_results;
    Sink<TestedEdge> sink;

    Lane(unsigned k, CycleScheduler& clock, const StallParameters& stalls)
        : normal_operands(("normal_operands_" + std::to_string(k)).c_str(), clock, stalls),
          height_operands(("height_operands_" + std::to_string(k)).c_str(), clock, stalls),
          tex_coord_results(("tex_coord_results_" + std::to_string(k)).c_str(), clock, stalls),
          view_results(("view_results_" + std::to_string(k)).c_str(), clock, stalls),
          sink(("sink_" + std::to_string(k)).c_str(), clock, stalls) {}
};

struct Bench {
    datapath::Registers registers;
    Design design;
    CycleScheduler clock{"clock", sc_core::sc_time(10, sc_core::SC_PS)};
    UnitContext context{clock, registers, design};
    std::vector<std::unique_ptr<Lane>> lane;
    FamilySequenceTests unit;
    StubTest<NormalOperands, NormalResult> first_normal_test, second_normal_test;
    StubTest<HeightOperands, HeightResult> summed_height_test;

    explicit Bench(const Timing& timing)
        : registers(with_families()),
          design(with(timing)),
          unit("sequence_tests", context),
          first_normal_test("normal_test", context, {5, 2, 1}, answer),
          second_normal_test("normal_test_1", context, {5, 2, 1}, answer),
          summed_height_test("summed_height_test", context, {7, 3, 1}, answer) {
        for (CycleProcess* process :
             {static_cast<CycleProcess*>(&summed_height_test), static_cast<CycleProcess*>(&first_normal_test),
              static_cast<CycleProcess*>(&second_normal_test), static_cast<CycleProcess*>(&unit)})
            clock.attach(*process);
        for (unsigned k = 0; k < lanes; ++k) {
            lane.push_back(std::make_unique<Lane>(k, clock, timing.stalls));
            lane[k]->normal_operands.out.bind(unit.normal_operands[k]);
            lane[k]->height_operands.out.bind(unit.height_operands[k]);
            lane[k]->tex_coord_results.out.bind(unit.from_tex_coord_test[k]);
            lane[k]->view_results.out.bind(unit.from_view_test[k]);
            unit.to_pass_or_tessellate[k].bind(lane[k]->sink.in);
        }
        unit.to_normal_test[0].bind(first_normal_test.input);
        unit.to_normal_test[1].bind(second_normal_test.input);
        first_normal_test.output.bind(unit.from_normal_test[0]);
        second_normal_test.output.bind(unit.from_normal_test[1]);
        unit.to_summed_height_test.bind(summed_height_test.input);
        summed_height_test.output.bind(unit.from_summed_height_test);
        for (unsigned triangle = 0; triangle < families; ++triangle)
            add(triangle);
    }

    static datapath::Registers with_families() {
        datapath::Registers registers;
        registers.tests.highlight_test = true;
        registers.formats.highlight_tag = registers.formats.families = true;
        return registers;
    }

    /// Adds every edge to its lane; every third triangle is a base triangle with three edges.
    void add(unsigned triangle) {
        PartTag tag;
        tag.triangle = triangle;
        const unsigned last = triangle % 3 == 0 ? first_edge_part + 2 : last_edge_part;
        for (tag.part = first_edge_part; tag.part <= last; ++tag.part) {
            Lane& its = *lane[(tag.part - first_edge_part) % lanes];
            NormalOperands operands;
            operands.tag = tag;
            its.normal_operands.items.push_back(operands);
            const unsigned tests = says(tag);
            its.height_operands.items.push_back({{}, tag});
            its.tex_coord_results.items.push_back({tag,
                                                   {triangle, tag.part},
                                                   (tests & datapath::tex_coord_bit) != 0,
                                                   (tests & datapath::generation_bit) != 0});
            its.view_results.items.push_back({tag, (tests & datapath::view_bit) != 0});
        }
    }
};

struct Row {
    std::string name;
    Timing timing;
};

Timing timing_of(unsigned places, unsigned results, const StallParameters& stalls) {
    Timing timing;
    timing.edges_in_sequence = places;
    timing.results_buffer = results;
    timing.stalls = stalls;
    return timing;
}

const CaseTable rows(
    "families, Sequence Tests: each edge once, with the tests its decision depends on, ",
    {Row{"32 places", timing_of(32, 4, {})},
     {"one place", timing_of(1, 1, {})},
     {"two places, random stalls", timing_of(2, 2, {5, 400, 30})},
     {"100 places, random stalls", timing_of(100, 1, {6, 300, 9})}},
    [](const Row& row) {
        Bench bench(row.timing);
        sc_core::sc_start();
        std::map<std::pair<Tag, unsigned>, unsigned> come;
        std::size_t evaluated_normal = 0, evaluated_height = 0;
        for (const auto& lane : bench.lane) {
            for (const TestedEdge& part : lane->sink.items) {
                CAPTURE(part.tag.triangle, part.tag.part);
                CHECK(++come[std::make_pair(part.tag.triangle, part.tag.part)] == 1);
                const unsigned evaluated = expected_evaluations(part.tag);
                CHECK(part.found.evaluated == evaluated);
                CHECK(part.found.tests == (says(part.tag) & evaluated));
                CHECK(part.found.texture == datapath::TexCoord{part.tag.triangle, part.tag.part});
                const bool normal = (evaluated & datapath::normal_bit) != 0;
                const datapath::Direction n{static_cast<std::int32_t>(part.tag.triangle), part.tag.part, 7};
                CHECK(part.found.displaced_normal == (normal ? n : datapath::Direction{}));
                evaluated_normal += normal;
                evaluated_height += (evaluated & datapath::summed_height_bit) != 0;
            }
        }
        CHECK(come.size() == 14 * 3 + (families - 14) * 9);
        CHECK(bench.first_normal_test.asked.size() + bench.second_normal_test.asked.size() == evaluated_normal);
        CHECK(bench.second_normal_test.asked.size() > 10);
        CHECK(bench.summed_height_test.asked.size() == evaluated_height);
        CHECK(bench.unit.describe_contents().empty());
        CHECK(bench.unit.idle());
    });

}  // namespace

TEST_CASE("families, Sequence Tests: results of different edges are an error") {
    Bench bench(timing_of(32, 4, {}));
    bench.lane[1]->view_results.items[0].tag.part = first_edge_part;
    CHECK_THROWS_WITH(sc_core::sc_start(), Catch::Contains("the tests' results belong to different edges"));
}

TEST_CASE("families, Sequence Tests: results of different triangles are an error") {
    Bench bench(timing_of(32, 4, {}));
    bench.lane[1]->view_results.items[0].tag.triangle ^= 1;
    CHECK_THROWS_WITH(sc_core::sc_start(), Catch::Contains("the tests' results belong to different edges"));
}

TEST_CASE("families, Sequence Tests: an answer without a request is an error") {
    Bench bench(timing_of(32, 4, {}));
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    NormalResult result;
    bench.second_normal_test.output.send(result);
    CHECK_THROWS_WITH(sc_core::sc_start(), Catch::Contains("a result for an edge that was not sent to the test"));
}

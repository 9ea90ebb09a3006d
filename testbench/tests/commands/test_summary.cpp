#include "testbench/commands/summary.h"

#include <catch2/catch.hpp>
#include <functional>
#include <string>
#include <vector>

#include "testbench/output/report/conformance_report.h"
#include "testbench/tests/support/hand_made_run.h"

// The printed summary: each figure in its place, with all counts different, and a run of one triangle.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

/// The text after a row's name.
std::string value_of(const std::string& text, const std::string& name) {
    const std::string begin = "  " + name + std::string(name.size() < 26 ? 26 - name.size() : 0, ' ');
    const std::size_t at = ("\n" + text).find("\n" + begin);
    if (at == std::string::npos)
        return "no such row";
    return text.substr(at + begin.size(), text.find('\n', at) - at - begin.size());
}

/// The least comparisons with which each check of a run passes.
Checks least_checks() {
    Checks checks;
    checks.setup.emplace().parts.push_back({"registers", "", 1, 0});
    checks.conformance.emplace().edges = 1000;
    checks.conformance->quantities.emplace_back().count = 1;
    checks.conformance->tests.emplace_back().compared = 1;
    checks.end_to_end.emplace().hardware_to_golden.measured = 1;
    checks.end_to_end->golden_to_hardware.measured = 1;
    checks.invariants.emplace().triangles = 1;
    checks.invariants->edges = 1;
    checks.work.emplace().triangles = 1;
    checks.reads.emplace().entries = 1;
    return checks;
}

}  // namespace

TEST_CASE("summary: each count of the machine is in its place") {
    HandMadeRun run;
    run.setup.remarks = {"a remark"};
    const std::string text = summary(run.setup, run.simulation, {6, 4, 7}, {}, 0.5);
    INFO(text);
    CHECK(value_of(text, "triangles") == "0 base -> 9 finished, 2 culled");
    CHECK(value_of(text, "edges") == "33 tested, 17 split (51.5 %)");
    CHECK(value_of(text, "  split by") == "normal alone 10, summed height alone 4, both 1, highlight alone 2");
    CHECK(value_of(text, "  requested, stopped by") ==
          "view alone 3, tex coord alone 4, generation alone 1, several 1");
    CHECK(value_of(text, "distinct edges") == "11, each tested 3.0 times on average");
    CHECK(value_of(text, "distinct vertices") == "6; 33 computed, 16 of them discarded, and 15 normals transformed");
    // the default design's entry, and one bit for the Highlight Test
    CHECK(value_of(text, "triangle queue") ==
          "at most 24 triangles waiting, 1573 bits each; one after another: timed mode has the machine's");
    CHECK_THAT(value_of(text, "summed height table"), Contains("0 reads, 0.0 per edge"));
    CHECK(value_of(text, "functional mode") == "simulated in 0.50 s, 0.00 million edges a second");
    CHECK_THAT(text, Contains("  note: a remark\n"));
    CHECK(value_of(text, "cycles") == "no such row");
    CHECK(value_of(text, "golden model") == "no such row");

    run.setup.registers.formats.tex_coord_fraction = 1;
    run.setup.registers.tests.highlight_test = false;
    run.setup.base_triangles.resize(1);  // so that three of the computed vertices are base vertices
    const std::string other = summary(run.setup, run.simulation, {}, {}, 0.5);
    CHECK(value_of(other, "triangles") == "1 base -> 9 finished, 2 culled");
    CHECK(value_of(other, "  split by") == "normal alone 10, summed height alone 4, both 1");
    CHECK(value_of(other, "  requested, stopped by") ==
          "view alone 3, tex coord (half texels) alone 4, generation alone 1, several 1");
    CHECK(value_of(other, "distinct edges") == "0, each tested 0.0 times on average");
    CHECK(value_of(other, "distinct vertices") == "0; 33 computed, 13 of them discarded, and 15 normals transformed");
}

TEST_CASE("summary: seconds and edges per second are printed") {
    HandMadeRun run;
    Checks checks;
    checks.work.emplace();
    const std::string text = summary(run.setup, run.simulation, {}, checks, 0.000'015);
    CHECK(value_of(text, "functional mode") ==
          "simulated in 0.00 s, 2.20 million edges a second, with the checks of each edge");
}

TEST_CASE("summary: each check is listed with its result") {
    HandMadeRun run;
    Checks checks = least_checks();
    checks.setup.reset();
    ConformanceResult& conformance = *checks.conformance;
    conformance.edges = 2000;
    conformance.mismatches = 3;
    conformance.flipped_edges = 5;
    checks.allowed_flips = 1;
    EndToEndResult& end = *checks.end_to_end;
    end.hardware_triangles = 1000;
    end.golden_triangles = 1015;
    end.hardware_to_golden.max_model = 0.5;
    end.golden_to_hardware.max_model = 0.25;
    end.hardware_to_golden.rms_model = 0.0625;
    end.golden_to_hardware.rms_model = 0.125;
    end.hardware_to_golden.farther = 1;
    end.golden_to_hardware.farther = 0.5;
    end.allowed = {2, 0.25, 2};
    InvariantResult& invariants = *checks.invariants;
    invariants.cracks = 1;
    invariants.t_vertices = 2;
    invariants.collapsed = 3;
    invariants.turned_over = 4;
    invariants.missing_triangles = 2;
    invariants.extra_triangles = invariants.differing_triangles = 1500;
    WorkResult& work = *checks.work;
    work.triangles = 40;
    work.equations = 2;
    work.violations = 7;
    ReadResult& reads = *checks.reads;
    reads.entries = 60;
    reads.wrong = 8;
    reads.missed = 9;
    const std::string text = summary(run.setup, run.simulation, {}, checks, 1);
    INFO(text);
    CHECK(value_of(text, "golden model") == "FAILED: 2,000 edges compared, 3 mismatches, 5 allowed flips (0.250 %)");
    CHECK(value_of(text, "golden mesh") ==
          "1,015 triangles (+1.50 %, allowed 2 %); 1.00 % of the points farther apart than rounding explains "
          "(allowed 6 %), at most 0.5 model units, RMS 0.125 (allowed 0.45)");
    CHECK(value_of(text, "invariants") ==
          "FAILED: 1 cracks, 2 T-vertices, 3,002 triangles wrong; in texture space 3 collapsed, 4 turned over");
    CHECK(value_of(text, "texture seams") == "no such row");
    CHECK(value_of(text, "work conservation") == "FAILED: 40 triangles and 2 unit counts checked, 7 violations");
    CHECK(value_of(text, "reads") == "FAILED: 60 entries compared, 8 wrong, 9 read but not compared");

    // A part that passes prints no FAILED; a row fails for each of its reasons.
    checks.conformance->mismatches = 0;
    checks.work->violations = 0;
    checks.reads->wrong = checks.reads->missed = 0;
    checks.invariants = least_checks().invariants;
    checks.end_to_end->golden_triangles = 1021;
    checks.setup = least_checks().setup;
    const std::string right = summary(run.setup, run.simulation, {}, checks, 1);
    INFO(right);
    for (const char* const name : {"set-up", "golden model", "invariants", "work conservation", "reads"})
        CHECK_THAT(value_of(right, name), !Contains("FAILED"));
    CHECK_THAT(value_of(right, "golden mesh"), Catch::StartsWith("FAILED: 1,021 triangles (+2.10 %"));

    checks.setup->parts = {{"registers", "", 5, 1}};
    checks.allowed_flips = 0.2;
    checks.invariants->open_texture_seam_edges = 9;
    checks.invariants->open_crease_edges = 12;
    checks.invariants->open_crease_edges_of_seams = 4;
    const std::string other = summary(run.setup, run.simulation, {}, checks, 1);
    CHECK(value_of(other, "set-up") == "FAILED: 5 values of registers, base vertices and tables compared, 1 wrong");
    CHECK(value_of(other, "golden model") ==
          "FAILED: 2,000 edges compared, 0 mismatches, 5 allowed flips (0.250 %), more than the 0.2 % that "
          "check.allowed_flips allows");
    CHECK_THAT(value_of(other, "texture seams"), Catch::StartsWith("9 edges open: "));
    CHECK_THAT(value_of(other, "creases"), Catch::StartsWith("12 edges open: ") && Catch::Contains("at 4 the texture"));
}

TEST_CASE("the run's verdict: one failed part fails it") {
    const auto wrong = [](auto& part, auto figure) { (*part).*figure = 1; };
    const std::vector<std::function<void(Checks&)>> failures = {
        [](Checks& c) {
            c.setup->parts.push_back({"registers", "", 1, 1});
        },
        [&](Checks& c) { wrong(c.conformance, &ConformanceResult::mismatches); },
        [](Checks& c) {  // 0.6 % of the edges; 0.5 % are allowed
            c.conformance->flipped_edges = 6;
        },
        [&](Checks& c) { wrong(c.end_to_end, &EndToEndResult::bound_hit); },
        [&](Checks& c) { wrong(c.invariants, &InvariantResult::cracks); },
        [&](Checks& c) { wrong(c.work, &WorkResult::violations); },
        [&](Checks& c) { wrong(c.reads, &ReadResult::wrong); },
        [&](Checks& c) { wrong(c.reads, &ReadResult::missed); }};
    CHECK(Checks{}.passed());
    CHECK(least_checks().passed());
    for (std::size_t k = 0; k < failures.size(); ++k) {
        INFO("failure " << k);
        Checks checks = least_checks();
        failures[k](checks);
        CHECK_FALSE(checks.passed());
        CHECK_THAT(report_text(checks, {}), Catch::StartsWith("Checks: FAILED: "));
        CHECK_THAT(conformance_json(checks), Catch::StartsWith("{\n  \"passed\": false,"));
    }
}

TEST_CASE("the run's verdict: a check that compared nothing fails, and says so") {
    HandMadeRun run;
    using Empty = std::pair<const char*, std::function<void(Checks&)>>;
    for (const auto& [row, empty] :
         std::vector<Empty>{{"set-up", [](Checks& c) { c.setup.emplace(); }},
                            {"set-up",
                             [](Checks& c) {
                                 c.setup->parts.push_back({"normal map", "", 0, 0});
                             }},
                            {"golden model", [](Checks& c) { c.conformance.emplace(); }},
                            {"golden model", [](Checks& c) { c.conformance->edges = 0; }},
                            {"golden model", [](Checks& c) { c.conformance->quantities.clear(); }},
                            {"golden model", [](Checks& c) { c.conformance->tests[0].compared = 0; }},
                            {"golden mesh", [](Checks& c) { c.end_to_end->hardware_to_golden.measured = 0; }},
                            {"golden mesh", [](Checks& c) { c.end_to_end->golden_to_hardware.measured = 0; }},
                            {"invariants", [](Checks& c) { c.invariants.emplace(); }},
                            {"work conservation", [](Checks& c) { c.work.emplace(); }},
                            {"reads", [](Checks& c) { c.reads.emplace(); }}}) {
        Checks checks = least_checks();
        empty(checks);
        INFO(row);
        CHECK_FALSE(checks.passed());
        const std::string text = summary(run.setup, run.simulation, {}, checks, 1);
        CHECK_THAT(value_of(text, row), Catch::StartsWith("FAILED: ") && Catch::EndsWith("; nothing was compared"));
        CHECK_THAT(report_text(checks, {}), Contains("nothing was compared\n"));
    }
}

// 86 cycles (modules/test_one_triangle.cpp), of 5 ns; one pass of three edges.
TEST_CASE("summary: a timed run of one triangle is summarised") {
    Job job = timed_job();
    job.mesh.columns = job.mesh.rows = 1;
    job.map.source = MapSource::constant;
    MachineSetup setup = setup_of(job);
    setup.base_triangles.resize(1);
    TimedRun simulation(setup);
    const std::string text = summary(setup, simulation, {3, 0, 3}, {}, 1);
    INFO(text);
    CHECK(value_of(text, "triangles") == "1 base -> 1 finished");
    CHECK(value_of(text, "edges") == "3 tested, 0 split (0.0 %)");
    CHECK(value_of(text, "distinct edges") == "3, each tested 1.0 times on average");
    CHECK(value_of(text, "distinct vertices") == "3; 6 computed, 3 of them discarded, and 3 normals transformed");
    CHECK_THAT(value_of(text, "triangle queue"), Catch::StartsWith("at most 1 triangles waiting, "));
    CHECK_THAT(value_of(text, "summed height table"), Contains("; 36 reads, 12.0 per edge"));
    CHECK(value_of(text, "cycles") ==
          "86: 86.0 per finished triangle, 86.0 per pass, 28.7 per edge; 0.00043 ms at 200 MHz");
    CHECK_THAT(value_of(text, "bottleneck"), Catch::StartsWith("none: bound by latency; "));
    CHECK_THAT(value_of(text, "hardware"),
               Catch::StartsWith("103 multipliers (59,188 bits of partial products), ") &&
                   Catch::EndsWith(" bits of memory with 3 table ports; the unbounded queue is not counted"));
    CHECK(value_of(text, "timed mode") == "simulated in 1.00 s, 0.00 million edges a second");
    CHECK(value_of(text, "spilled") == "no such row");
}

// Two base triangles with four children each, and two places: at least one of the second's children is spilled.
TEST_CASE("summary: spilled triangles are reported") {
    Job job = full_split_job(1, 1);
    job.hardware.queue.capacity = 2;
    TimedRun simulation(setup_of(job));
    const TriangleQueue& queue = simulation.machine.triangle_queue;
    REQUIRE(queue.spilled() > 0);
    CHECK(value_of(summary(simulation.setup, simulation, {}, {}, 1), "spilled") ==
          std::to_string(queue.spilled()) + " triangles, at most 3 on chip, with those on their way out");
}

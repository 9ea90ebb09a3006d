#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <utility>

#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/timed_checks.h"

// One triangle through an idle machine: every cycle on its path, derived by hand.
//
// The triangle is a base triangle of a constant map: no edge splits, so it makes two passes, first with its three
// vertices and three edges, then, finished, with its three normals in screen space.
//
// First round. The host offers it in cycle 0, when Get Triangle takes it; its parts leave one per cycle, a latency G
// later: vertices in G, G + 1, G + 2, edges in G + 3, G + 4, G + 5, on both branches. Then
//
//   geometry   Calculate New P (P), a read of the displacement map (latency Md), Displace Vertex (D), Transform (T):
//              the third vertex is on the screen in V = G + 2 + P + Md + D + T, the last edge three cycles later.
//   corners    the Normal Test has the third corner's map entry (read: Mn) in A = G + 2 + C + Mn, C: Calculate New U;
//              it starts no edge of a base triangle before.
//   edge 2     View Test (L) and Normal Test (N) each hold one edge at their input and keep another waiting, in
//              Calculate New U. A Calculate New U of one cycle has room for one edge: so edges 0 and 1 go to the other
//              tests in U = G + 3 + C and U + 1, and edge 2 enters Calculate New U when both have started edge 0, and
//              leaves it in W = max(G + 5, V, A) + 1. With a latency of 2 and more it waits at its end: then
//              W = max(G + 5 + C, V, A).
//   View Test  starts edges in V, V + 1, V + 2: through in max(W, V + 2) + L.
//   Normal     starts edge 2 in max(W, A + 2), one read and its latency later it is through.
//   SAT        12 entries an edge, `slots` cycles: edges 0 and 1 keep the table from U on for 2 * slots, edge 2 from
//              S = max(U + 2 * slots, W) on; its last address goes out in S + slots - 1, the data come Ms later, the
//              test is through H later.
//
// Pass or Tessellate completes it in
//   J = max(V + 3, max(W, A + 2) + Mn + N, S + slots - 1 + Ms + H, max(W, V + 2) + L).
//
// Second round: Pass or Tessellate (O), Tessellation (E), the Triangle Queue (Q), Get Triangle (G) and the
// last of three normals 2 later, Calculate New P, Displace Vertex (which reads nothing for normals),
// Transform, Pass or Tessellate, Lighting (I): the rasteriser has it in
// J + O + E + Q + G + 2 + P + D + T + O + I. The run's cycles: one more, since the first is number 0.

using namespace tessera;
using namespace tessera::testing;

namespace {

std::uint64_t derived_cycles(const Timing& t) {
    const std::uint64_t g = t.get_triangle.latency, p = t.calculate_new_p.latency;
    const std::uint64_t d = t.displace_vertex.latency, transform = t.transform.latency;
    const std::uint64_t c = t.calculate_new_u.latency, l = t.view_test.latency;
    const std::uint64_t slots = (12 + t.summed_height_table.ports - 1) / t.summed_height_table.ports;
    const std::uint64_t v = g + 2 + p + t.displacement_map.latency + d + transform;
    const std::uint64_t u = g + 3 + c;
    const std::uint64_t a = g + 2 + c + t.normal_map.latency;
    const std::uint64_t w = c == 1 ? std::max({g + 5, v, a}) + 1 : std::max({g + 5 + c, v, a});
    const std::uint64_t s = std::max(u + 2 * slots, w);
    const std::uint64_t joined = std::max(
        {v + 3, std::max(w, a + 2) + t.normal_map.latency + t.normal_test.latency,
         s + slots - 1 + t.summed_height_table.latency + height_test_timing(t, {}).latency, std::max(w, v + 2) + l});
    const std::uint64_t o = t.pass_or_tessellate.latency;
    const std::uint64_t lit = joined + o + t.tessellation.latency + t.triangle_queue.latency + g + 2 + p + d +
                              transform + o + t.lighting.latency;
    return lit + 1;
}

struct Row {
    std::string name;
    std::string settings;
    std::uint64_t cycles;
};

/// Cases of the derivation above, worked out by hand.
const CaseTable derived(
    "one triangle, ",
    {
        // V = 1 + 2 + 1 + 1 + 6 + 20 = 31; W = 32; S = max(5 + 24, 32) = 32; J = 32 + 11 + 1 + 3 = 47;
        // then 1 + 1 + 1 + 1 + 2 + 1 + 6 + 20 + 1 + 4 = 38: cycle 85.
        Row{"the paper's design: 86 cycles", "", 86},
        // V = 12, W = 13, S = 29, J = 29 + 11 + 1 + 3 = 44, then 19: the tests take longer than Transform.
        {"Transform of 1 cycle: the tests finish last", "timing.transform_latency=1", 64},
        // V = 511, W = 512, J = 512 + 11 + 1 + 3 = 527, then 518.
        {"Transform of 500 cycles: edge 2 waits for the screen positions", "timing.transform_latency=500",
         527 + 518 + 1},
        // S = 32, last address 43, data 143, test 146; then 38.
        {"a Summed Height Table of latency 100", "timing.summed_height_table_latency=100", 146 + 38 + 1},
        {"a Summed Height Table of latency 0", "timing.summed_height_table_latency=0", 46 + 38 + 1},
        // The map's latency delays V to 130 = 1 + 2 + 1 + 100 + 6 + 20, W = 131, J = 131 + 15 = 146; normals read
        // nothing: 38.
        {"a displacement map of latency 100", "timing.displacement_map_latency=100", 146 + 38 + 1},
        // A = 1 + 2 + 1 + 200 = 204, after V = 31: W = 205, edge 2 starts in 206, J = 206 + 200 + 9 = 415.
        {"a normal map of latency 200: the Normal Test finishes last", "timing.normal_map_latency=200", 415 + 38 + 1},
        // J = 32 + 1 + 300 = 333.
        {"a Normal Test of 300 cycles", "timing.normal_test_latency=300", 333 + 38 + 1},
        // Edge 2 starts in V + 2 = 33, J = 103.
        {"a View Test of 70 cycles", "timing.view_test_latency=70", 103 + 38 + 1},
        // Two ports: 6 cycles an edge; S = 32, J = 32 + 5 + 1 + 3 = 41, before the Normal Test's 42 = 32 + 1 + 9.
        {"two ports on the Summed Height Table: the Normal Test finishes last", "timing.summed_height_table_ports=2",
         42 + 38 + 1},
        {"four ports on the Summed Height Table: no faster than two", "timing.summed_height_table_ports=4",
         42 + 38 + 1},
    },
    [](const Row& row) {
        TimedRun simulation(one_triangle(with_settings(one_quad_job(), row.settings)));
        CHECK(derived_cycles(simulation.setup.design.timing) == row.cycles);
        CHECK(simulation.cycles() == row.cycles);
        CHECK(simulation.rasteriser.triangles() == 1);
    });

/// Other designs, each with its own derivation.
const CaseTable designs(
    "one triangle, ",
    {
        // Each unit has an edge and its two vertices, sent in G, G + 1 and G + 2 on its branch; geometry as before. All
        // three edges reach the Summed Height Tests in G + 2 + C = 4 and share the one port for 36 cycles: last address
        // 39, data 40, test 43. The Normal Tests read six corners through the map's one port, in 2 to 7; the last has
        // come in 8: edges read in 8 to 10 at the latest, are through in 20. View 32, geometry 34. J = 43, then 38.
        Row{"three tests units: 82 cycles", "hardware.tests_units=3", 43 + 38 + 1},
        // Nine gathers of one cycle each: last address 4 + 8 = 12, data 13, test 16: the last edge's geometry is later,
        // in 34.
        {"three tests units and four ports: the tests are hidden behind Transform",
         "hardware.tests_units=3 timing.summed_height_table_ports=4", 34 + 38 + 1},
        // Parts 4 cycles apart from G + P + Md + D = 9 on: vertices start in 9, 13, 17, on the screen in 29, 33, 37 =
        // V; edges in 41, 45, 49. W = 38, S = 38, J = max(49, 38 + 15) = 53. Second round: normals enter Transform 4
        // apart: 2 normals later 8 instead of 2: 38 + 6.
        {"Transform every 4 cycles", "timing.transform_interval=4", 53 + 44 + 1},
        // The View Test's edges are through in 32, 33, 34; each then takes the Normal Test's 10 cycles, so that the
        // first asks the Summed Height Test in 42. Its 36 addresses go out in 42 to 77: data 78, test 81 = J.
        {"cheap tests first: 120 cycles", "hardware.test_order=cheap_first", 81 + 38 + 1},
        // A base triangle has no final edge.
        {"final edges: 86 cycles", "hardware.final_edges=true", 86},
        // The two take turns, each every 4 cycles: starts in 9, 10, 13: V = 33, W = 34, edges 34, 37, 38. J = 34 + 15.
        // Normals: the third starts 4 after the first: 38 + 2.
        {"two Transform pipelines every 4 cycles", "timing.transform_interval=4 hardware.transform_pipelines=2",
         49 + 40 + 1},
    },
    [](const Row& row) {
        TimedRun simulation(one_triangle(with_settings(one_quad_job(), row.settings)));
        CHECK(simulation.cycles() == row.cycles);
        const bool three_units = simulation.setup.design.tests_units == 3;  // they read six corners instead of three
        CHECK(simulation.machine.normal_map.transactions() == (three_units ? 6 : 3) + 3);
    });

/// A base triangle, all of whose edges split once.
constexpr const char* one_split =
    "map.source=noise tests.normal_threshold=0 tests.summed_height_threshold=0 tests.view_threshold=0 "
    "tests.tex_coord=false tests.generation_limit=1 ";

/// In a machine of families Tessellation has a base triangle's three vertices in V = 31, and sends its edges a cycle
/// later.
const CaseTable families(
    "one triangle in a machine of families, ",
    {
        // Edges in 32 to 34, in the Summed Height Test from 33 on: 36 addresses in 33 to 68, data 69, test 72. The
        // triangle leaves in 73, is lit in 77.
        Row{"no edge splits: 78 cycles", "hardware.work=family", 78},
        // Its split is known in 72, too. It is in Get Triangle in 74; midpoints leave in 75 to 77, the third is on the
        // screen in 77 + 1 + 1 + 6 + 20 = 105. Nine edges from 106 on, in the Summed Height Test from 107 on: 108
        // addresses in 107 to 214, data 215, test 218. Four children leave in 219 to 222; the last is lit in 226.
        {"three edges split once: 227 cycles", std::string(one_split) + "hardware.work=family", 227},
        // Edges in 32, one a lane, through the cheap tests in 34. The Normal Test starts them in 34 to 36, they are
        // through in 44 to 46, and split. Out in 47, in Get Triangle in 48, midpoints 49 to 51, the third on the screen
        // in 79. Nine edges in 80 to 82, three at a time, through the cheap tests in 82 to 84: their generation keeps
        // them whole. Four children leave in 85 to 88, lit in 92.
        {"three edges split once, three lanes: 93 cycles",
         std::string(one_split) + "hardware.work=family hardware.test_order=cheap_first hardware.edge_lanes=3", 93},
    },
    [](const Row& row) {
        const bool splits = row.settings.find("noise") != std::string::npos;
        TimedRun simulation(one_triangle(with_settings(one_quad_job(), row.settings)));
        CHECK(simulation.cycles() == row.cycles);
        CHECK(simulation.rasteriser.triangles() == (splits ? 4 : 1));
        CHECK(simulation.machine.edges_tested() == (splits ? 12 : 3));
    });

}  // namespace

// Each unit with a latency of its own, all different: what is forgotten or counted twice shows.
// V = 3 + 2 + 5 + 7 + 11 + 40 = 68, A = 3 + 2 + 2 + 4 = 11,
// W = 68 (edge 2 waits at the end of Calculate New U), S = 68,
// J = max(71, 68 + 4 + 13, 68 + 11 + 9 + 17, 70 + 6) = 105,
// then 8 + 10 + 12 + 3 + 2 + 5 + 11 + 40 + 8 + 14 = 113.
TEST_CASE("one triangle, a different latency in every unit") {
    TimedRun simulation(one_triangle(with_settings(
        one_quad_job(),
        "timing.get_triangle_latency=3 timing.calculate_new_p_latency=5 timing.displacement_map_latency=7 "
        "timing.displace_vertex_latency=11 timing.transform_latency=40 timing.calculate_new_u_latency=2 "
        "timing.normal_map_latency=4 timing.normal_test_latency=13 timing.summed_height_table_latency=9 "
        "timing.height_test_latency=17 timing.view_test_latency=6 timing.tex_coord_test_latency=3 "
        "timing.pass_or_tessellate_latency=8 timing.tessellation_latency=10 "
        "timing.triangle_queue_latency=12 timing.lighting_latency=14")));
    CHECK(derived_cycles(simulation.setup.design.timing) == 105 + 113 + 1);
    CHECK(simulation.cycles() == 105 + 113 + 1);

    // and each unit keeps each item for its own latency, on the critical path or beside it
    const Machine& p = simulation.machine;
    const TessellationTests& tests = p.tessellation_tests[0];
    const std::pair<const Unit*, std::uint64_t> stays[] = {
        {&p.calculate_new_p, 9 * 5}, {&p.displace_vertex, 6 * (7 + 11) + 3 * 11},
        {&p.transform, 9 * 40},      {&tests.tex_coord_test, 3 * 3},
        {&tests.view_test, 3 * 6},   {&tests.normal_test, 6 * (4 + 13)},
        {&p.tessellation, 10},       {&p.triangle_queue, 12},
        {&p.lighting, 14},           {&p.displacement_map, 6 * 7},
        {&p.normal_map, 6 * 4},
    };
    for (const auto& [unit, item_cycles] : stays) {
        INFO(unit->name());
        CHECK(unit->activity().cycles_in(State::blocked) == 0);
        CHECK(unit->activity().item_cycles() == item_cycles);
    }
}

// Normals only take part in the second round: three parts, read nothing, and skip the tests. Six parts in the first.
TEST_CASE("one triangle: numbers of parts and reads") {
    TimedRun simulation(one_triangle());
    const Machine& p = simulation.machine;
    CHECK(p.get_triangle.parts_sent() == 9);
    CHECK(p.displacement_map.transactions() == 6);
    CHECK(p.normal_map.transactions() == 6);
    CHECK(p.height_table.transactions() == 36);
    CHECK(p.pass_or_tessellate.counts().normal_passes == 1);
    // an idle machine blocks only Calculate New U, from cycle 6, when the View Test's input is full, to 31; Get
    // Triangle can still send to it: its input has room for edge 2
    for (const Unit* unit : p.units()) {
        INFO(unit->name());
        CHECK(unit->activity().cycles_in(State::blocked) ==
              (unit == &p.tessellation_tests[0].calculate_new_u ? 31 - 6 : 0));
    }
    // Little's law, exactly: nothing is held up in Transform, with nine parts of 20 cycles; in Lighting one of 4
    CHECK(p.transform.activity().item_cycles() == 9 * 20);
    CHECK(p.lighting.activity().item_cycles() == 4);
    CHECK(p.displace_vertex.activity().item_cycles() == 6 * (1 + 6) + 3 * 6);
}

// The cycles of a triangle's stages must not depend on the clock's period.
TEST_CASE("one triangle: the clock's period changes the time but not the cycles") {
    TimedRun simulation(one_triangle(with_settings(one_quad_job(), "timing.clock_period=1234")));
    CHECK(simulation.cycles() == 86);
    CHECK(sc_core::sc_time_stamp().value() == 85 * 1234);
}

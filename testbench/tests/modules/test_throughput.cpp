#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>

#include "testbench/machine/totals.h"
#include "testbench/output/report/timing_report.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/timed_checks.h"

// Long runs: the slowest unit's interval times its work, plus the cycles to fill and to drain the machine, exact to the
// cycle where that can be derived.
//
// The mesh: 18 base triangles, each split into four until generation 4: 18 * (1 + 4 + 16 + 64 + 256) = 6138 passes,
// 18 * 256 finished. A base triangle sends three vertices and three edges; its four children lack all three normals
// (the base's corners have none yet); of a later split's children three lack two normals, the middle one all three.
// So parts = 18 * (6 + 4 * 6) + 18 * (16 + 64 + 256) * 3 + 18 * (4 + 16 + 64) * (3 * 2 + 3) = 32292.

using namespace tessera;
using namespace tessera::testing;

namespace {

constexpr std::uint64_t base = 18;
constexpr std::uint64_t passes = 6138;
constexpr std::uint64_t finished = 18 * 256;
constexpr std::uint64_t parts = 32292;

// From the first cycle until the first edge's first address: Get Triangle 1, then its three vertices, Calculate New U
// 1. With a Tessellation Tests unit for each edge only two vertices precede it.
constexpr std::uint64_t fill = 5;
constexpr std::uint64_t fill_of_three = 4;
// After the last address: data 1, Summed Height Test 3, Pass or Tessellate 1, Lighting 4.
constexpr std::uint64_t drain = 9;
// From the cycle in which a base triangle is taken until its corners are on the screen (test_one_triangle.cpp): the
// longest time for which the View Test, waiting for one, can keep its edges from the other tests.
constexpr std::uint64_t until_on_screen = 31;

MachineSetup full_split(const std::string& settings = "") {
    return setup_of(with_settings(full_split_job(3, 4), settings));
}

struct FullSplitRun : TimedRun {
    explicit FullSplitRun(const std::string& settings = "") : FullSplitRun(full_split(settings)) {}
    explicit FullSplitRun(MachineSetup its_setup) : TimedRun(std::move(its_setup)) {
        REQUIRE(machine.pass_or_tessellate.counts().passes == passes);
        REQUIRE(machine.pass_or_tessellate.counts().finished == finished);
        REQUIRE(machine.get_triangle.parts_sent() == parts);
        // No rectangle wraps: four entries each.
        const datapath::HeightTestFunctions& test = functions_of(machine.registers().formats.height_test);
        const Decisions::Evaluated& evaluated = decisions.evaluated();
        REQUIRE(machine.height_table.transactions() ==
                test.requests * (test.rectangles ? 4 : 1) *
                    (evaluated.summed_height - evaluated.summed_height_by_codes));
    }
};

void require_sole_bottleneck(const Simulation& simulation, const Unit* unit) {
    CHECK(find_bottleneck(simulation.machine, simulation.cycles()).first.units == std::vector<const Unit*>{unit});
}

const Unit& unit_named(const Machine& machine, const std::string& name) {
    const auto units = machine.units();
    return **std::find_if(units.begin(), units.end(), [&](const Unit* unit) { return unit->basename() == name; });
}

constexpr std::uint64_t any = 0;

/// Limits of the run's cycles, and the number of cycles for which one unit is occupied.
struct Bound {
    std::string name;
    std::string settings;
    std::uint64_t least, most;
    std::string unit;
    std::uint64_t occupied;
    bool sole_bottleneck = false;
};

constexpr std::uint64_t splits = (passes - base) / 4;
const char* const short_edges =
    "hardware.height_test=curvature tests.curvature_threshold=0 map.width=24 map.height=24 map.address_u=repeat "
    "map.address_v=repeat tests.tex_coord=false";
constexpr std::uint64_t short_passes = passes - 18 * (1 + 4);
// With ports to spare the first part leaves Get Triangle in cycle 1; the last still takes Calculate New P 1, the map 1,
// Displace Vertex 6, Transform 20, Pass or Tessellate 1, Lighting 4.
constexpr std::uint64_t a_part_a_cycle = 1 + parts + 1 + 1 + 6 + 20 + 1 + 4;
// With Transform every 8 cycles the first part starts in cycle 9 (Get Triangle 1, Calculate New P 1, map 1, Displace
// Vertex 6); the last, 8 * (parts - 1) later, is out 20 later; the triangle is decided 1 later and lit 4 later.
constexpr std::uint64_t transform_every_8 = 9 + 8 * (parts - 1) + 20 + 1 + 4 + 1;
// Two pipelines: parts 0, 2, 4 ... start in 9, 17, 25 ...; parts 1, 3, 5 ... in 10, 18, 26 ...; the last one is odd.
constexpr std::uint64_t two_every_8 = 10 + 8 * (parts / 2 - 1) + 20 + 1 + 4 + 1;

const CaseTable rates(
    "",
    {
        // 18 cycles per pass; the first triangle's first two edges are complete in 5 to 16, its third arrives in 32.
        Bound{"two ports on the Summed Height Table: 18 cycles a pass", "timing.summed_height_table_ports=2",
              fill + 15 + 18 * passes + drain, fill + 15 + 18 * passes + drain, "summed_height_table", 18 * passes},
        // 9 cycles per pass: still more than a pass has parts (at most 6). A base triangle's 31 cycles to the screen
        // are now longer than the work on the ones before it, so each of 18 may delay the table by at most that.
        {"four ports on the Summed Height Table: 9 cycles a pass, still the bottleneck",
         "timing.summed_height_table_ports=4", fill + 9 * passes + drain,
         fill + 9 * passes + drain + base* until_on_screen, "summed_height_table", 9 * passes},
        // 64 ports: a rectangle takes one cycle, and the limit is one part per cycle, from Get Triangle and through
        // Calculate New P, Displace Vertex and Transform alike.
        {"ample ports on the Summed Height Table: limited to one part per cycle", "timing.summed_height_table_ports=64",
         a_part_a_cycle, a_part_a_cycle + base* until_on_screen, "get_triangle", parts},
        // Four cycles per edge, and for each of a base triangle's three vertices, on both maps. The Summed Height Test,
        // with 64 ports, takes one.
        {"a bilinear filter, ample ports on the Summed Height Table: 12 cycles a pass",
         "hardware.displacement_filter=bilinear timing.summed_height_table_ports=64", 4 * (3 * passes + 3 * base),
         4 * (3 * passes + 3 * base) + 100 + base* until_on_screen, "normal_map", 4 * (3 * passes + 3 * base)},
        // The Normal Test asks for every split that the Generation Test allows: the table is hardly read.
        {"cheap tests first, one port: limited to one part per cycle", "hardware.test_order=cheap_first",
         a_part_a_cycle, a_part_a_cycle + base* until_on_screen, "get_triangle", parts},
        // Edges of eight and four texels read the table. Those of the 18 * (16 + 64 + 256) passes below, of two texels
        // and less, read three codes each, through ports that Displace Vertex does not use.
        {"a Curvature Test, most edges short: 9 cycles a pass", short_edges, 9 * short_passes,
         9 * short_passes + 3 * (passes - short_passes) + 100 + base* until_on_screen, "displacement_map_for_tests",
         9 * short_passes},
        // They share the one port: the only gain is the first triangle's three cycles and one vertex.
        {"three tests units on one port: still 36 cycles a pass", "hardware.tests_units=3",
         fill_of_three + 36 * passes + drain, fill_of_three + 36 * passes + drain, "summed_height_table", 36 * passes},
        {"three tests units on four ports: 9 cycles a pass",
         "hardware.tests_units=3 timing.summed_height_table_ports=4", fill_of_three + 9 * passes + drain,
         fill_of_three + 9 * passes + drain + base* until_on_screen, "summed_height_table", 9 * passes},
        // With four ports the table needs 9 of the 24 or more cycles that three edges take here.
        {"Transform every 8 cycles is the bottleneck: 8 cycles a part",
         "timing.summed_height_table_ports=4 timing.transform_interval=8", transform_every_8, transform_every_8,
         "transform", 8 * parts},
        {"two Transform pipelines every 8 cycles: 4 cycles a part",
         "timing.summed_height_table_ports=4 timing.transform_interval=8 hardware.transform_pipelines=2", two_every_8,
         two_every_8, "transform", 4 * parts},
        // 6120 children, one every 20 cycles, also from the last of one pass to the first of the next. When the last is
        // made, the finished ones may still wait for the table, nine cycles each.
        {"Tessellation every 20 cycles is the bottleneck if the tests take less",
         "timing.summed_height_table_ports=4 timing.tessellation_interval=20", 20 * (passes - base - 1),
         20 * (passes - base) + 9 * finished + 500, "tessellation", 20 * (passes - base), true},
        // One pass at a time: a latency of 300 before its first child, and the other three in the cycles after it.
        {"Tessellation of latency 300 is the bottleneck: 303 cycles a split",
         "timing.summed_height_table_ports=4 timing.tessellation_latency=300", 303 * splits,
         303 * splits + 9 * finished + 500, "tessellation", 303 * splits, true},
        {"Get Triangle every 100 cycles is the bottleneck: 100 cycles a part", "timing.get_triangle_interval=100",
         100 * (parts - 1), 100 * parts + 1000, "get_triangle", 100 * parts, true},
        {"Get Triangle of latency 200 is the bottleneck: 200 cycles a pass", "timing.get_triangle_latency=200",
         200 * passes, 250 * passes, "get_triangle", any, true},
        // The corners' banks are arbitrary: four banks are no better than four ports and, with one port each, no worse
        // than one. Without conflicts eight would read a pass's 36 entries in 4.5 cycles.
        {"four banks of the Summed Height Table are faster than one port and slower than four",
         "timing.summed_height_table_banks=4", fill + 9 * passes + drain, fill + 3 + 36 * passes + drain,
         "summed_height_table", any},
        {"eight banks interleaved by entry: more than eight cycles a pass", "timing.summed_height_table_banks=8",
         8 * passes, 9 * passes, "summed_height_table", any},
        {"eight exclusive-or banks, a window of four edges: less than seven cycles a pass",
         "timing.summed_height_table_banks=8 timing.summed_height_table_interleave=xor "
         "timing.summed_height_table_window=12",
         9 * passes / 2, 7 * passes, "summed_height_table", any},
    },
    [](const Bound& row) {
        FullSplitRun simulation(row.settings);
        CHECK(simulation.cycles() >= row.least);
        CHECK(simulation.cycles() <= row.most);
        const Machine& p = simulation.machine;
        CHECK(p.tessellation.children() == passes - base);
        const Unit& unit = unit_named(p, row.unit);
        if (row.occupied != any)
            CHECK(unit.occupied_cycles() == row.occupied);
        if (&unit == &p.height_table && row.occupied != any)
            CHECK(unit.activity().cycles_in(State::busy) == row.occupied);
        if (&unit == &p.transform)  // ceil(20 / 8) register stages in each
            CHECK(unit.activity().high_water_mark() == 3 * simulation.setup.design.transform_pipelines);
        if (row.sole_bottleneck)
            require_sole_bottleneck(simulation, &unit);
    });

}  // namespace

// The family design of three lanes. Each base triangle is a family, and each triangle that splits: 18 * (1 + 4 + 16 + 64)
// of them with three midpoints, nine new edges and four children; base triangles have three edges and vertices of their
// own. Edges of triangles of generation 4 fail the Generation Test, so that only the others go to the Normal Test.
namespace {

constexpr std::uint64_t own = 3 * base, vertices = own + 3 * splits, new_edges = own + 9 * splits;
constexpr std::uint64_t requesting = own + 9 * 18 * (1 + 4 + 16);

struct Interval {
    std::string name;     ///< of the unit's key, and how many there are
    std::uint64_t items;  ///< of each copy of the unit
    std::string settings = "";
    std::uint64_t idle = 1000;  ///< most cycles that it cannot work: to fill and drain, unless stated
};

const CaseTable intervals(
    "the modern design, one item every 40 cycles: ",
    {
        Interval{"get_triangle", vertices},
        {"calculate_new_p", vertices},
        {"displace_vertex", vertices},
        {"transform", vertices},
        {"calculate_new_u", new_edges / 3},
        {"tex_coord_test", new_edges / 3},
        {"view_test", new_edges / 3},
        {"normal_test", requesting},
        {"normal_test, two of them", requesting / 2, "hardware.normal_tests=2"},
        {"height_test", requesting, "tests.normal=false"},
        // A family's children are lit or queued: one output is idle while only the other has any left.
        {"pass_or_tessellate", finished, "", 40 * finished / 10},
        {"tessellation", new_edges / 3},
        // Nothing is queued while families are tested whose children do not split.
        {"triangle_queue", splits, "", 40 * splits / 3},
        {"lighting", finished},
    },
    [](const Interval& row) {
        constexpr std::uint64_t interval = 40;
        const std::string unit_name = row.name.substr(0, row.name.find(','));
        TimedRun simulation(full_split("hardware.design=modern timing." + unit_name + "_interval=40 " + row.settings));
        CHECK(simulation.machine.pass_or_tessellate.counts().finished == finished);
        CHECK(simulation.cycles() >= interval * (row.items - 1));
        CHECK(simulation.cycles() <= interval * row.items + row.idle);
        std::uint64_t most = 0;
        for (const Unit* unit : simulation.machine.units())
            if (std::string(unit->basename()).rfind(unit_name, 0) == 0 ||
                (unit_name == height_test_unit && unit == &simulation.machine.tessellation_tests[0].height_test))
                most = std::max(most, unit->occupied_cycles());
        CHECK(most == interval * row.items);
    });

}  // namespace

// One port takes 3 edges x 3 rectangles x 4 entries = 36 cycles per pass, with a single pause: the first triangle's
// third edge arrives in cycle 32 (test_one_triangle.cpp), 3 after the first two's 24 entries have been read in 5 to 28.
// From then on the next triangle's edges wait when one is complete.
TEST_CASE("the paper's design is bound by the Summed Height Table: 36 cycles a pass") {
    FullSplitRun simulation;
    const Machine& p = simulation.machine;
    CHECK(simulation.cycles() == fill + 3 + 36 * passes + drain);
    CHECK(p.height_table.activity().cycles_in(State::busy) == 36 * passes);
    CHECK(p.height_table.occupied_cycles() == 36 * passes);
    // and only the unit that reads it works 3 cycles on each edge and waits for it the rest of that time; behind the
    // first triangle's second edge, and behind the last, there is nothing to wait for
    const Activity& test = p.tessellation_tests[0].height_test.activity();
    CHECK(test.cycles_in(State::busy) == 3 * 3 * passes);
    CHECK(test.cycles_in(State::waiting_for_memory) == 36 * passes - 3 * (3 * passes - 2));
    CHECK(test.cycles_in(State::blocked) == 0);
}

TEST_CASE("two machines of the paper's design: each does half the passes, in half the cycles") {
    TimedRun simulation(full_split("hardware.machines=2"));
    REQUIRE(simulation.machines.size() == 2);
    for (const auto& hosted : simulation.machines) {
        CHECK(hosted->host.sent() == base / 2);
        CHECK(hosted->machine.pass_or_tessellate.counts().passes == passes / 2);
        CHECK(hosted->machine.clock.last_cycle() + 1 == fill + 3 + 36 * passes / 2 + drain);
    }
    CHECK(simulation.cycles() == fill + 3 + 36 * passes / 2 + drain);
    CHECK(simulation.sent() == base);
    const Totals totals(simulation);
    CHECK(totals.counts.passes == passes);
    CHECK(totals.counts.finished == finished);
    CHECK(totals.lit == finished);
    CHECK(totals.host_triangles == base);
    CHECK(totals.queued == totals.queue_triangles);
    CHECK(totals.height_table_reads == 36 * passes);
    CHECK(simulation.monitor.mesh.triangles.size() == finished);
}

// Eight triangles may be in flight at the join, so at most one per 400 / 8 cycles, where the tests take nine.
TEST_CASE("the join waits for a Transform of latency 400") {
    FullSplitRun simulation("timing.summed_height_table_ports=4 timing.transform_latency=400");
    const Machine& p = simulation.machine;
    std::uint64_t for_transform = 0;
    for (const Activity::Share& share : p.pass_or_tessellate.activity().shares())
        for_transform += share.by == &p.transform && share.state == State::starved ? share.cycles : 0;
    CHECK(2 * for_transform > simulation.cycles());
}

// With a number of banks that divides a row's entries, the corners of a rectangle in one column are in one bank: it takes two
// cycles, and the next one waits if it needs either bank, while nearly all banks idle.
TEST_CASE("bank conflicts are a bottleneck even if most ports are idle") {
    MachineSetup setup = full_split();
    setup.design.timing.summed_height_table.banks = setup.registers.height_table.columns / 5;
    REQUIRE(setup.registers.height_table.columns == 5 * 53);
    FullSplitRun simulation(setup);
    const TableMemory& table = simulation.machine.height_table;
    CHECK(table.slots_taken() < table.slots_per_cycle() * simulation.cycles() / 5);
    CHECK(simulation.cycles() > 10 * passes);
    CHECK(table.occupied_cycles() == table.cycles_held_up());
    require_sole_bottleneck(simulation, &table);
}

TEST_CASE("a unit that waits for its long interval counts as the bottleneck") {
    FullSplitRun simulation(
        "timing.displace_vertex_latency=1 timing.displace_vertex_interval=100 "
        "timing.pass_or_tessellate_interval=50");
    const Machine& p = simulation.machine;
    CHECK(p.displace_vertex.activity().cycles_in(State::busy) +
              p.displace_vertex.activity().cycles_in(State::waiting_for_memory) >
          simulation.cycles() * 9 / 10);
    require_sole_bottleneck(simulation, &p.displace_vertex);
}

// Little's law, exactly: if nothing is held up, a unit's contents, summed over all cycles, are items times latency:
// mean occupancy = throughput * latency.
TEST_CASE("mean occupancy is throughput times latency in units that are never blocked") {
    FullSplitRun simulation;
    const Machine& p = simulation.machine;
    const auto expect = [](const Unit& unit, std::uint64_t item_cycles) {
        INFO(unit.name());
        REQUIRE(unit.activity().cycles_in(State::blocked) == 0);
        CHECK(unit.activity().item_cycles() == item_cycles);
    };
    const std::uint64_t edges = 3 * passes, base_vertices = 3 * base, normals = parts - edges - base_vertices;
    expect(p.transform, 20 * parts);
    expect(p.calculate_new_p, parts);
    expect(p.lighting, 4 * finished);
    expect(p.displace_vertex, (1 + 6) * (edges + base_vertices) + 6 * normals);  // normals read nothing
    expect(p.tessellation_tests[0].normal_test, (1 + 9) * (edges + base_vertices));
    expect(p.tessellation_tests[0].view_test, edges);
    expect(p.tessellation_tests[0].tex_coord_test, edges);
    expect(p.displacement_map, edges + base_vertices);
    expect(p.normal_map, edges + base_vertices);
}

TEST_CASE("a second frame takes the same number of cycles") {
    FullSplitRun simulation;
    const std::uint64_t first = simulation.cycles();
    simulation.host.send_again();
    REQUIRE(simulation.run().empty());
    // the second frame's first cycle is the one in which the first one ended
    CHECK(simulation.cycles() - first + 1 == first);
}

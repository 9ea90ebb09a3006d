#include <catch2/catch.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "modules/units/pass_or_tessellate.h"
#include "testbench/check/transport/conservation.h"
#include "testbench/tests/support/edited_mesh.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/timed_checks.h"

// Each equation of conservation.cpp: the values of its sides in a run that can be counted by hand, and that each side
// counts only what it names, tested by one extra action in one unit.

using namespace tessera;
using namespace tessera::testing;

namespace {

using Sides = std::pair<std::int64_t, std::int64_t>;
using Equations = std::map<std::string, Sides>;

Equations sides_of(const Simulation& simulation) {
    Equations sides;
    for (const Conservation& equation : conservation(simulation))
        sides[equation.name] = {static_cast<std::int64_t>(equation.left), static_cast<std::int64_t>(equation.right)};
    return sides;
}

/// Performs an action on a machine that has run, and requires that the sides of the named equations change by the given
/// amounts and all other equations not at all.
template <class Act>
void expect_change(const std::string& what, const Simulation& simulation, Act&& act, const Equations& expected) {
    const Equations before = sides_of(simulation);
    act();
    for (const auto& [name, sides] : sides_of(simulation)) {
        INFO(what << ": " << name);
        const auto found = expected.find(name);
        const Sides change = found == expected.end() ? Sides{0, 0} : found->second;
        CHECK(sides.first - before.at(name).first == change.first);
        CHECK(sides.second - before.at(name).second == change.second);
    }
    for (const auto& [name, change] : expected) {
        INFO(what << ": " << name);
        CHECK(before.count(name) == 1);
    }
}

/// Two base triangles, each split into four: 2 * 3 vertices, 10 passes of 3 edges. The children lack all three normals:
/// parts = 6 + 30 + 8 * 3. No rectangle wraps: four entries each.
MachineSetup two_triangles_split_once() {
    MachineSetup setup = setup_of(full_split_job(1, 1));
    setup.design.packed_streams = false;  // the tests below send items with tags that exceed tag_bits
    return setup;
}

const Equations two_triangles_functional{
    {"triangles taken by get_triangle = decided", {2 + 8, 10}},
    {"triangles taken by get_triangle from the host = base triangles", {2, 2}},
    {"children of tessellation = taken by triangle_queue", {8, 8}},
    {"taken by triangle_queue = by get_triangle from it", {8, 8}},
    {"triangles cut by tessellation + finished = decided", {2 + 8, 10}},
    {"triangles recirculated for normals = decided for normals", {0, 0}},
    {"finished = base triangles + edges split", {8, 2 + 6}},
    {"finished = emitted", {8, 8}},
    {"taken by the rasteriser = finished - culled", {8, 8}},
    {"edges tested = 3 per pass", {30, 30}},
    {"reads of displacement_map by displace_vertex = vertices and midpoints", {36, 6 + 30}},
    {"reads of displacement_map = vertices, midpoints and texels", {36, 6 + 30}},
    {"reads of normal_map = vertices and edges of normal_test", {36, 6 + 30}},
    {"positions of transform = vertices and midpoints", {36, 6 + 30}},
};

/// The name of a stream's equation.
std::string stream(const std::string& input, const std::string& output) {
    return "items taken by " + input + " = sent by " + output;
}

struct StreamItems {
    const char *input, *output;
    std::int64_t items;
};
const StreamItems two_triangles_streams[] = {
    {"get_triangle.from_host", "host.to_get_triangle", 2},
    {"get_triangle.from_triangle_queue", "triangle_queue.to_get_triangle", 8},
    {"get_triangle.queue_level", "triangle_queue.level", 6},  // sent whenever it rises from 0 or falls to it
    {"calculate_new_p.from_get_triangle", "get_triangle.to_calculate_new_p", 60},
    {"displace_vertex.from_calculate_new_p", "calculate_new_p.to_displace_vertex", 60},
    {"transform.from_displace_vertex", "displace_vertex.to_transform", 60},
    {"tessellation_tests_0.calculate_new_u.input", "get_triangle.to_tessellation_tests_0", 36},
    {"tessellation_tests_0.tex_coord_test.input", "tessellation_tests_0.calculate_new_u.to_tex_coord_test", 30},
    {"tessellation_tests_0.summed_height_test.input", "tessellation_tests_0.calculate_new_u.to_summed_height_test", 30},
    {"tessellation_tests_0.normal_test.input", "tessellation_tests_0.calculate_new_u.to_normal_test", 36},
    {"tessellation_tests_0.view_test.input", "tessellation_tests_0.calculate_new_u.to_view_test", 30},
    {"tessellation_tests_0.view_test.from_transform", "transform.to_view_test_0", 6},
    {"tessellation_tests_0.collect_tests.from_tex_coord_test", "tessellation_tests_0.tex_coord_test.output", 30},
    {"tessellation_tests_0.collect_tests.from_summed_height_test", "tessellation_tests_0.summed_height_test.output",
     30},
    {"tessellation_tests_0.collect_tests.from_normal_test", "tessellation_tests_0.normal_test.output", 30},
    {"tessellation_tests_0.collect_tests.from_view_test", "tessellation_tests_0.view_test.output", 30},
    {"pass_or_tessellate.from_get_triangle", "get_triangle.to_pass_or_tessellate", 10},
    {"pass_or_tessellate.from_transform", "transform.to_pass_or_tessellate", 60},
    {"pass_or_tessellate.from_tessellation_tests_0", "tessellation_tests_0.collect_tests.to_pass_or_tessellate", 30},
    {"tessellation.from_pass_or_tessellate", "pass_or_tessellate.to_tessellation", 2},
    {"triangle_queue.from_tessellation", "tessellation.to_triangle_queue", 8},
    {"lighting.from_pass_or_tessellate", "pass_or_tessellate.to_lighting", 8},
    {"rasteriser.from_lighting", "lighting.to_rasteriser", 8},
};

Equations two_triangles_timed() {
    Equations all = two_triangles_functional;
    for (const StreamItems& its : two_triangles_streams)
        all[stream(its.input, its.output)] = {its.items, its.items};
    all.insert({
        {"items in calculate_new_p = taken by its input", {60, 60}},
        {"items in displace_vertex = taken by its input", {60, 60}},
        {"items in transform = taken by its input", {60, 60}},
        {"items in tessellation_tests_0.calculate_new_u = taken by its input", {36, 36}},
        {"items in tessellation_tests_0.tex_coord_test = taken by its input", {30, 30}},
        {"items in tessellation_tests_0.summed_height_test = taken by its input", {30, 30}},
        {"items in tessellation_tests_0.normal_test = taken by its input", {36, 36}},
        {"items in tessellation = taken by its input", {2, 2}},
        {"items in triangle_queue = taken by its input", {8, 8}},
        {"items in lighting = taken by its input", {8, 8}},
        {"requests received by displacement_map = made by its ports", {36, 36}},
        {"requests received by normal_map = made by its ports", {36, 36}},
        {"requests received by summed_height_table = made by its ports", {90, 90}},
        {"requests received by off_chip_memory = made by its ports", {0, 0}},
        {"entries of displacement_map = read by its ports", {36, 36}},
        {"entries of normal_map = read by its ports", {36, 36}},
        {"entries of summed_height_table = read by its ports", {30 * 12, 30 * 12}},
        {"triangles in get_triangle = taken by it", {10, 10}},
        {"triangles in pass_or_tessellate = taken by get_triangle", {10, 10}},
        {"positions and normals of transform = parts", {36 + 24, 60}},
        {"edges taken by summed_height_test = its edges", {30, 30}},
        {"edges in view_test = edges", {30, 30}},
        {"vertices taken by view_test = vertices, once per unit", {6, 6}},
        {"edges collected = edges", {30, 30}},
        {"requests to displacement_map = vertices, midpoints and texels", {36, 6 + 30}},
        {"requests to normal_map = vertices and edges of normal_test", {36, 6 + 30}},
        {"requests to summed_height_table = those of each edge tested by table", {90, 90}},
        {"requests to off_chip_memory = spills and refills", {0, 0}},
        {"triangles spilled = refilled", {0, 0}},
        {"bytes read from off_chip_memory = written", {0, 0}},
    });
    return all;
}

/// A triangle with all vertices known: only its edges remain to be sent.
TakenTriangle known_triangle() {
    TakenTriangle taken;
    for (datapath::Vertex& vertex : taken.triangle.vertices)
        vertex.displaced_known = vertex.screen_normal_known = true;
    return taken;
}

/// Part `part` of a triangle with a tag that no other has.
template <class Item>
Item part_of_it(unsigned part) {
    Item item;
    item.tag = {1000, static_cast<std::uint8_t>(part), {}};
    return item;
}

template <class Payload, class Output>
void offer(Output& output, Payload& payload) {
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    sc_core::sc_time delay;
    output->nb_transport_fw(payload, phase, delay);
}

template <class Payload, class Output>
void give(Output& output, Payload& payload) {
    sc_core::sc_time delay;
    output->b_transport(payload, delay);
}

/// Reads one entry, bypassing the unit that reads the table.
void read_directly(MemoryPort& port, std::uint64_t address) {
    std::array<unsigned char, 8> data{};
    MemoryRequest request{tlm::TLM_READ_COMMAND, 1, port.entry_bytes(), {address}, data.data()};
    sc_core::sc_time delay;
    port.socket->b_transport(request, delay);
    REQUIRE(request.response == tlm::TLM_OK_RESPONSE);
}

}  // namespace

TEST_CASE("conservation: the sides of every equation are those worked out by hand, functional mode") {
    Job job = full_split_job(1, 1);
    job.mode = Mode::functional;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1000);
    REQUIRE(simulation.run().empty());
    CHECK(sides_of(simulation) == two_triangles_functional);
}

TEST_CASE("conservation: the sides of every equation are those worked out by hand, timed mode") {
    TimedRun simulation(two_triangles_split_once());
    const Equations expected = two_triangles_timed(), found = sides_of(simulation);
    CHECK(found.size() == expected.size());
    for (const auto& [name, sides] : found) {
        INFO(name << ": " << sides.first << " = " << sides.second);
        CHECK((expected.count(name) == 1 && expected.at(name) == sides));
    }
}

// A constant map: one triangle without split edges makes a second pass for its normals. Culling drops it at the end.
TEST_CASE("conservation: triangles sent round for normals and culled triangles balance") {
    Job job = timed_job();
    job.mesh.columns = job.mesh.rows = 1;
    job.map.source = MapSource::constant;
    job.hardware.culling = Culling::back;
    MachineSetup setup = setup_of(job);
    setup.base_triangles.resize(1);
    std::swap(setup.base_triangles[0].vertices[1], setup.base_triangles[0].vertices[2]);  // turned away
    TimedRun simulation(setup);
    const Equations sides = sides_of(simulation);
    CHECK(sides.at("triangles taken by get_triangle = decided") == Sides{2, 2});
    CHECK(sides.at("triangles recirculated for normals = decided for normals") == Sides{1, 1});
    CHECK(sides.at("triangles cut by tessellation + finished = decided") == Sides{2, 2});
    CHECK(sides.at("taken by the rasteriser = finished - culled") == Sides{0, 0});
    CHECK(sides.at("items in lighting = taken by its input") == Sides{0, 0});
}

TEST_CASE("conservation: an extra item in a unit breaks its equation and no other") {
    TimedRun simulation(two_triangles_split_once());
    Machine& p = simulation.machine;
    TessellationTests& tests = p.tessellation_tests[0];
    const std::map<const Unit*, std::string> of_units_with_several_inputs{
        {&p.get_triangle, "triangles in get_triangle = taken by it"},
        {&p.pass_or_tessellate, "triangles in pass_or_tessellate = taken by get_triangle"},
        {&tests.view_test, "edges in view_test = edges"},
        {&tests.collector, "edges collected = edges"},
    };
    for (Unit* unit : p.units()) {
        const std::string name = std::string(unit->name()).substr(std::string("tessera.").size());
        const auto found = of_units_with_several_inputs.find(unit);
        const std::string equation = found != of_units_with_several_inputs.end() ? found->second
                                     : dynamic_cast<MemoryServer*>(unit) != nullptr
                                         ? "requests received by " + name + " = made by its ports"
                                         : "items in " + name + " = taken by its input";
        expect_change(name, simulation, [&] { unit->activity().item_in(simulation.cycles()); }, {{equation, {1, 0}}});
    }
}

TEST_CASE("conservation: an extra item on a stream breaks its equations") {
    TimedRun simulation(two_triangles_split_once());
    Machine& p = simulation.machine;
    auto point = part_of_it<ScreenPoint>(first_edge_part);
    auto corner = part_of_it<ScreenCorner>(0);
    auto edge = part_of_it<TestedEdge>(first_edge_part);
    TakenTriangle taken = known_triangle();
    expect_change("transform to pass_or_tessellate", simulation, [&] { offer(p.transform.to_join, point); },
                  {{stream("pass_or_tessellate.from_transform", "transform.to_pass_or_tessellate"), {1, 0}}});
    expect_change("transform to view_test", simulation, [&] { offer(p.transform.to_view_test[0], corner); },
                  {{stream("tessellation_tests_0.view_test.from_transform", "transform.to_view_test_0"), {1, 0}},
                   {"vertices taken by view_test = vertices, once per unit", {1, 0}}});
    expect_change("collect_tests to pass_or_tessellate", simulation,
                  [&] { offer(p.tessellation_tests[0].collector.tested_edges(), edge); },
                  {{stream("pass_or_tessellate.from_tessellation_tests_0",
                           "tessellation_tests_0.collect_tests.to_pass_or_tessellate"),
                    {1, 0}}});
    LitTriangle lit;
    expect_change("lighting to the rasteriser", simulation, [&] { give(p.lighting.to_rasteriser, lit); },
                  {{"taken by the rasteriser = finished - culled", {1, 0}}});
    expect_change("a triangle that is emitted twice", simulation,
                  [&] { simulation.monitor.mesh.triangles.push_back({}); }, {{"finished = emitted", {0, 1}}});
    expect_change("tessellation to triangle_queue", simulation,
                  [&] { give(p.netlist().the<Tessellation>().to_triangle_queue, taken.triangle); },
                  {{"children of tessellation = taken by triangle_queue", {0, 1}},
                   {"taken by triangle_queue = by get_triangle from it", {1, 0}}});
}

TEST_CASE("conservation: an extra read breaks its equations") {
    TimedRun simulation(two_triangles_split_once());
    Machine& p = simulation.machine;
    const datapath::Registers& r = simulation.setup.registers;
    sc_core::sc_time delay;
    expect_change("displacement map", simulation,
                  [&] { p.displace_vertex.displacement_map.read(r.displacement_map.base, delay); },
                  {{"reads of displacement_map by displace_vertex = vertices and midpoints", {1, 0}},
                   {"reads of displacement_map = vertices, midpoints and texels", {1, 0}},
                   {"entries of displacement_map = read by its ports", {1, 1}}});
    expect_change("normal map", simulation,
                  [&] { p.tessellation_tests[0].normal_test.normal_map.read(r.normal_map.base, delay); },
                  {{"reads of normal_map = vertices and edges of normal_test", {1, 0}},
                   {"entries of normal_map = read by its ports", {1, 1}}});
    expect_change("Summed Height Table", simulation,
                  [&] { p.tessellation_tests[0].height_test.table.read(r.height_table.base, delay); },
                  {{"entries of summed_height_table = read by its ports", {1, 1}}});
    // the same, bypassing the units
    expect_change("displacement map, past its unit", simulation,
                  [&] { read_directly(p.displace_vertex.displacement_map, r.displacement_map.base); },
                  {{"entries of displacement_map = read by its ports", {1, 0}}});
    expect_change("normal map, past its unit", simulation,
                  [&] { read_directly(p.tessellation_tests[0].normal_test.normal_map, r.normal_map.base); },
                  {{"entries of normal_map = read by its ports", {1, 0}}});
    expect_change("Summed Height Table, past its unit", simulation,
                  [&] { read_directly(p.tessellation_tests[0].height_test.table, r.height_table.base); },
                  {{"entries of summed_height_table = read by its ports", {1, 0}}});
}

TEST_CASE("conservation: each side of the displacement map has its own requests and entries") {
    MachineSetup setup = setup_of(with_settings(full_split_job(1, 1),
                                                "hardware.height_test=curvature map.width=2 map.height=2 "
                                                "tests.tex_coord=false"));  // edges of two texels at most
    TimedRun simulation(setup);
    Machine& p = simulation.machine;
    const Equations sides = sides_of(simulation);
    CHECK(sides.at("reads of displacement_map = vertices, midpoints and texels") == Sides{36 + 90, 36 + 90});
    CHECK(sides.at("entries of displacement_map = read by its ports") == Sides{36, 36});
    CHECK(sides.at("entries of displacement_map_for_tests = read by its ports") == Sides{90, 90});
    CHECK(sides.at("requests received by displacement_map = made by its ports") == Sides{36, 36});
    CHECK(sides.at("requests received by displacement_map_for_tests = made by its ports") == Sides{30, 30});
    CHECK(sides.at("requests to displacement_map = vertices, midpoints and texels") == Sides{66, 6 + 30 + 30});
    const std::uint64_t address = setup.registers.displacement_map.base;
    MemoryPort& of_test = *p.tessellation_tests[0].height_test.displacement_map;
    sc_core::sc_time delay;
    expect_change("a request too many to the first side", simulation,
                  [&] { p.displacement_map.activity().item_in(simulation.cycles()); },
                  {{"requests received by displacement_map = made by its ports", {1, 0}}});
    expect_change("a request too many to the second side", simulation,
                  [&] { p.displacement_map_for_tests->activity().item_in(simulation.cycles()); },
                  {{"requests received by displacement_map_for_tests = made by its ports", {1, 0}}});
    expect_change("a read too many of the first side", simulation,
                  [&] { p.displace_vertex.displacement_map.read(address, delay); },
                  {{"reads of displacement_map by displace_vertex = vertices and midpoints", {1, 0}},
                   {"reads of displacement_map = vertices, midpoints and texels", {1, 0}},
                   {"entries of displacement_map = read by its ports", {1, 1}}});
    expect_change("a read too many of the second side", simulation, [&] { of_test.read(address, delay); },
                  {{"reads of displacement_map = vertices, midpoints and texels", {1, 0}},
                   {"entries of displacement_map_for_tests = read by its ports", {1, 1}}});
    expect_change("the second side, past its unit", simulation, [&] { read_directly(of_test, address); },
                  {{"entries of displacement_map_for_tests = read by its ports", {1, 0}}});
}

// By blocking transport, which does all the work at once.
TEST_CASE("conservation: an extra transformed vertex and extra decided triangles break their equations") {
    TimedRun simulation(two_triangles_split_once());
    Machine& p = simulation.machine;

    TakenTriangle taken = known_triangle();
    taken.triangle.finished = true;
    taken.triangle.vertices[0].screen_normal_known = false;
    expect_change("the host sends a triangle that lacks a normal", simulation,
                  [&] { give(simulation.host.to_get_triangle, taken.triangle); },
                  {{"triangles taken by get_triangle = decided", {1, 1}},
                   {"triangles taken by get_triangle from the host = base triangles", {1, 0}},
                   {"triangles cut by tessellation + finished = decided", {1, 1}},
                   {"triangles recirculated for normals = decided for normals", {0, 1}},
                   {"finished = base triangles + edges split", {1, 1}},
                   {"finished = emitted", {1, 1}},
                   {"taken by the rasteriser = finished - culled", {1, 1}},
                   {"reads of displacement_map by displace_vertex = vertices and midpoints", {0, 3}},
                   {"reads of displacement_map = vertices, midpoints and texels", {0, 3}},
                   {"reads of normal_map = vertices and edges of normal_test", {0, 3}},
                   {"positions of transform = vertices and midpoints", {0, 3}},
                   {"positions and normals of transform = parts", {1, 0}},
                   {"triangles in get_triangle = taken by it", {0, 1}},
                   {"triangles in pass_or_tessellate = taken by get_triangle", {0, 1}},
                   {"vertices taken by view_test = vertices, once per unit", {0, 3}},
                   {"requests to displacement_map = vertices, midpoints and texels", {0, 3}},
                   {"requests to normal_map = vertices and edges of normal_test", {0, 3}}});

    // one of its branches only: Pass or Tessellate waits for the other
    taken = known_triangle();
    taken.tag = 1000;
    taken.triangle.vertices[0].displaced_known = false;
    taken.triangle.vertices[1].screen_normal_known = false;
    expect_change("transform works on a vertex, a normal and three edges", simulation,
                  [&] {
                      give(p.get_triangle.to_join, taken);
                      for (const unsigned part : {0u, 4u, 6u, 7u, 8u}) {
                          auto point = part_of_it<DisplacedPoint>(part);
                          give(p.displace_vertex.to_transform, point);
                      }
                  },
                  {{"positions of transform = vertices and midpoints", {4, 0}},
                   {"positions and normals of transform = parts", {5, 0}}});
    expect_change("its other branch: one edge splits", simulation,
                  [&] {
                      for (const unsigned part : {6u, 7u, 8u}) {
                          auto edge = part_of_it<TestedEdge>(part);
                          edge.found.evaluated = datapath::all_tests;
                          if (part == 6)
                              edge.found.tests = datapath::normal_bit | datapath::gating_tests;
                          give(p.tessellation_tests[0].collector.tested_edges(), edge);
                      }
                  },
                  {{"triangles taken by get_triangle = decided", {0, 1}},
                   {"children of tessellation = taken by triangle_queue", {2, 2}},
                   {"taken by triangle_queue = by get_triangle from it", {2, 0}},
                   {"triangles cut by tessellation + finished = decided", {1, 1}},
                   {"finished = base triangles + edges split", {0, 1}},
                   {"edges tested = 3 per pass", {3, 3}},
                   {"reads of displacement_map by displace_vertex = vertices and midpoints", {0, 3}},
                   {"reads of displacement_map = vertices, midpoints and texels", {0, 3}},
                   {"reads of normal_map = vertices and edges of normal_test", {0, 3}},
                   {"positions of transform = vertices and midpoints", {0, 3}},
                   {"edges taken by summed_height_test = its edges", {0, 3}},
                   {"edges in view_test = edges", {0, 3}},
                   {"edges collected = edges", {0, 3}},
                   {"requests to displacement_map = vertices, midpoints and texels", {0, 3}},
                   {"requests to normal_map = vertices and edges of normal_test", {0, 3}},
                   {"requests to summed_height_table = those of each edge tested by table", {0, 9}}});

    DecidedTriangle untested;
    untested.pass.triangle.finished = true;
    expect_change("a finished triangle that goes round for normals", simulation,
                  [&] { give(p.netlist().the<PassOrTessellate>().to_tessellation, untested); },
                  {{"children of tessellation = taken by triangle_queue", {1, 1}},
                   {"taken by triangle_queue = by get_triangle from it", {1, 0}},
                   {"triangles cut by tessellation + finished = decided", {1, 0}},
                   {"triangles recirculated for normals = decided for normals", {1, 0}}});
}

// Two places on chip: some of the spilled triangles are still off chip when the machine is stopped.
TEST_CASE("conservation: spilled triangles still off chip do not count as read back") {
    Job job = full_split_job(1, 3);
    job.hardware.queue.capacity = 2;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 10'000);
    TriangleQueue& queue = simulation.machine.triangle_queue;
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    while (queue.spilled() < 6 || queue.spilled() == queue.refilled())
        sc_core::sc_start(simulation.machine.clock.period());
    const Equations halfway = sides_of(simulation);
    const Sides spilled = halfway.at("triangles spilled = refilled");
    CHECK(spilled == Sides{static_cast<std::int64_t>(queue.spilled()), static_cast<std::int64_t>(queue.refilled())});
    CHECK(spilled.first > spilled.second);
    const Sides requests = halfway.at("requests to off_chip_memory = spills and refills");
    CHECK(requests.second == 2 * spilled.first);
    CHECK(requests.first < requests.second);
    const Sides bytes = halfway.at("bytes read from off_chip_memory = written");
    CHECK(bytes.first < bytes.second);
    sc_core::sc_report_handler::set_actions(sc_core::SC_ID_NO_SC_START_ACTIVITY_, sc_core::SC_DO_NOTHING);
    run_timed(simulation);
    const Equations end = sides_of(simulation);
    for (const char* const name : {"triangles spilled = refilled", "requests to off_chip_memory = spills and refills",
                                   "bytes read from off_chip_memory = written"}) {
        INFO(name);
        CHECK(end.at(name).first == end.at(name).second);
        CHECK(end.at(name).first > 0);
    }
}

TEST_CASE("work check: an equation that does not hold is a violation, named with both its sides") {
    const MachineSetup setup = two_triangles_split_once();
    Simulation simulation(setup, 1000);
    TransportCheck work(setup.registers, setup.base_triangles);
    observe(simulation, work);
    run_timed(simulation);
    const WorkResult sound = work_result(work, simulation);
    CHECK(sound.passed());
    CHECK(sound.equations == two_triangles_timed().size());
    simulation.machine.lighting.activity().item_in(simulation.cycles());
    simulation.monitor.mesh = first_of(simulation.monitor.mesh, 7);
    const WorkResult broken = work_result(work, simulation);
    CHECK(broken.violations == 2);
    CHECK(broken.first_violation == "finished = emitted: 8 and 7");
}

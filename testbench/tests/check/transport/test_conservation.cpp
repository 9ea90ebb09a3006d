#include <catch2/catch.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

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

Equations two_triangles_timed() {
    Equations all = two_triangles_functional;
    all.insert({
        {"triangles in get_triangle = decided", {10, 10}},
        {"triangles in pass_or_tessellate = decided", {10, 10}},
        {"triangles in triangle_queue = taken by it", {8, 8}},
        {"triangles in lighting = finished - culled", {8, 8}},
        {"parts in calculate_new_p = sent by get_triangle", {60, 60}},
        {"parts in displace_vertex = sent by get_triangle", {60, 60}},
        {"parts in transform = sent by get_triangle", {60, 60}},
        {"parts taken from transform = sent by get_triangle", {60, 60}},
        {"positions and normals of transform = parts", {36 + 24, 60}},
        {"parts in calculate_new_u = vertices and edges", {36, 6 + 30}},
        {"parts in normal_test = vertices and its edges", {36, 6 + 30}},
        {"edges in tex_coord_test = edges", {30, 30}},
        {"edges in summed_height_test = its edges", {30, 30}},
        {"edges in view_test = edges", {30, 30}},
        {"vertices taken by view_test = vertices, once per unit", {6, 6}},
        {"edges taken from tessellation_tests = edges", {30, 30}},
        {"edges collected = edges", {30, 30}},
        {"entries of displacement_map = read", {36, 36}},
        {"entries of normal_map = read", {36, 36}},
        {"entries of summed_height_table = read by its test", {30 * 12, 30 * 12}},
        {"requests to displacement_map = vertices, midpoints and texels", {36, 6 + 30}},
        {"requests to normal_map = vertices and edges of normal_test", {36, 6 + 30}},
        {"requests to summed_height_table = those of each edge tested by table", {90, 90}},
        {"triangles spilled = refilled", {0, 0}},
        {"requests to off_chip_memory = spills and refills", {0, 0}},
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
    CHECK(sides_of(simulation) == two_triangles_timed());
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
    CHECK(sides.at("triangles in lighting = finished - culled") == Sides{0, 0});
}

TEST_CASE("conservation: an extra item in a unit breaks its equation and no other") {
    TimedRun simulation(two_triangles_split_once());
    Pipeline& p = simulation.pipeline;
    TessellationTests& tests = p.tessellation_tests[0];
    const std::pair<Unit*, const char*> units[] = {
        {&p.get_triangle, "triangles in get_triangle = decided"},
        {&p.pass_or_tessellate, "triangles in pass_or_tessellate = decided"},
        {&p.triangle_queue, "triangles in triangle_queue = taken by it"},
        {&p.lighting, "triangles in lighting = finished - culled"},
        {&p.calculate_new_p, "parts in calculate_new_p = sent by get_triangle"},
        {&p.displace_vertex, "parts in displace_vertex = sent by get_triangle"},
        {&p.transform, "parts in transform = sent by get_triangle"},
        {&tests.calculate_new_u, "parts in calculate_new_u = vertices and edges"},
        {&tests.normal_test, "parts in normal_test = vertices and its edges"},
        {&tests.tex_coord_test, "edges in tex_coord_test = edges"},
        {&tests.height_test, "edges in summed_height_test = its edges"},
        {&tests.view_test, "edges in view_test = edges"},
        {tests.collect_tests, "edges collected = edges"},
        {&p.displacement_map, "requests to displacement_map = vertices, midpoints and texels"},
        {&p.normal_map, "requests to normal_map = vertices and edges of normal_test"},
        {&p.height_table, "requests to summed_height_table = those of each edge tested by table"},
        {&p.off_chip_memory, "requests to off_chip_memory = spills and refills"},
    };
    for (const auto& [unit, equation] : units)
        expect_change(unit->name(), simulation, [&, it = unit] { it->activity().item_in(simulation.cycles()); },
                      {{equation, {1, 0}}});
}

TEST_CASE("conservation: an extra item on a stream breaks its equations") {
    TimedRun simulation(two_triangles_split_once());
    Pipeline& p = simulation.pipeline;
    auto point = part_of_it<ScreenPoint>(first_edge_part);
    auto corner = part_of_it<ScreenCorner>(0);
    auto edge = part_of_it<TestedEdge>(first_edge_part);
    TakenTriangle taken = known_triangle();
    expect_change("transform to pass_or_tessellate", simulation, [&] { offer(p.transform.to_join, point); },
                  {{"parts taken from transform = sent by get_triangle", {1, 0}}});
    expect_change("transform to view_test", simulation, [&] { offer(p.transform.to_view_test[0], corner); },
                  {{"vertices taken by view_test = vertices, once per unit", {1, 0}}});
    expect_change("collect_tests to pass_or_tessellate", simulation,
                  [&] { offer(p.tessellation_tests[0].collect_tests->to_pass_or_tessellate, edge); },
                  {{"edges taken from tessellation_tests = edges", {1, 0}}});
    LitTriangle lit;
    expect_change("lighting to the rasteriser", simulation, [&] { give(p.lighting.to_rasteriser, lit); },
                  {{"taken by the rasteriser = finished - culled", {1, 0}}});
    expect_change("a triangle that is emitted twice", simulation,
                  [&] { simulation.monitor.mesh.triangles.push_back({}); }, {{"finished = emitted", {0, 1}}});
    expect_change("tessellation to triangle_queue", simulation,
                  [&] { give(p.triangle_tessellation->to_triangle_queue, taken.triangle); },
                  {{"children of tessellation = taken by triangle_queue", {0, 1}},
                   {"taken by triangle_queue = by get_triangle from it", {1, 0}},
                   {"triangles in triangle_queue = taken by it", {0, 1}}});
}

TEST_CASE("conservation: an extra read breaks its equations") {
    TimedRun simulation(two_triangles_split_once());
    Pipeline& p = simulation.pipeline;
    const datapath::Registers& r = simulation.setup.registers;
    sc_core::sc_time delay;
    expect_change("displacement map", simulation,
                  [&] { p.displace_vertex.displacement_map.read(r.displacement_map.base, delay); },
                  {{"reads of displacement_map by displace_vertex = vertices and midpoints", {1, 0}},
                   {"reads of displacement_map = vertices, midpoints and texels", {1, 0}},
                   {"entries of displacement_map = read", {1, 1}}});
    expect_change("normal map", simulation,
                  [&] { p.tessellation_tests[0].normal_test.normal_map.read(r.normal_map.base, delay); },
                  {{"reads of normal_map = vertices and edges of normal_test", {1, 0}},
                   {"entries of normal_map = read", {1, 1}}});
    expect_change("Summed Height Table", simulation,
                  [&] { p.tessellation_tests[0].height_test.table.read(r.height_table.base, delay); },
                  {{"entries of summed_height_table = read by its test", {1, 1}}});
    // the same, bypassing the units
    expect_change("displacement map, past its unit", simulation,
                  [&] { read_directly(p.displace_vertex.displacement_map, r.displacement_map.base); },
                  {{"entries of displacement_map = read", {1, 0}}});
    expect_change("normal map, past its unit", simulation,
                  [&] { read_directly(p.tessellation_tests[0].normal_test.normal_map, r.normal_map.base); },
                  {{"entries of normal_map = read", {1, 0}}});
    expect_change("Summed Height Table, past its unit", simulation,
                  [&] { read_directly(p.tessellation_tests[0].height_test.table, r.height_table.base); },
                  {{"entries of summed_height_table = read by its test", {1, 0}}});
}

TEST_CASE("conservation: each side of the displacement map has its own requests and entries") {
    MachineSetup setup = setup_of(with_settings(full_split_job(1, 1),
                                                "hardware.height_test=curvature map.width=2 map.height=2 "
                                                "tests.tex_coord=false"));  // edges of two texels at most
    TimedRun simulation(setup);
    Pipeline& p = simulation.pipeline;
    const Equations sides = sides_of(simulation);
    CHECK(sides.at("reads of displacement_map = vertices, midpoints and texels") == Sides{36 + 90, 36 + 90});
    CHECK(sides.at("entries of displacement_map = read by displace_vertex") == Sides{36, 36});
    CHECK(sides.at("entries of displacement_map_for_tests = read by its test") == Sides{90, 90});
    CHECK(sides.at("requests to displacement_map = vertices and midpoints") == Sides{36, 6 + 30});
    CHECK(sides.at("requests to displacement_map_for_tests = edges tested by codes") == Sides{30, 30});
    const std::uint64_t address = setup.registers.displacement_map.base;
    MemoryPort& of_test = *p.tessellation_tests[0].height_test.displacement_map;
    sc_core::sc_time delay;
    expect_change("a request too many to the first side", simulation,
                  [&] { p.displacement_map.activity().item_in(simulation.cycles()); },
                  {{"requests to displacement_map = vertices and midpoints", {1, 0}}});
    expect_change("a request too many to the second side", simulation,
                  [&] { p.displacement_map_for_tests->activity().item_in(simulation.cycles()); },
                  {{"requests to displacement_map_for_tests = edges tested by codes", {1, 0}}});
    expect_change("a read too many of the first side", simulation,
                  [&] { p.displace_vertex.displacement_map.read(address, delay); },
                  {{"reads of displacement_map by displace_vertex = vertices and midpoints", {1, 0}},
                   {"reads of displacement_map = vertices, midpoints and texels", {1, 0}},
                   {"entries of displacement_map = read by displace_vertex", {1, 1}}});
    expect_change("a read too many of the second side", simulation, [&] { of_test.read(address, delay); },
                  {{"reads of displacement_map = vertices, midpoints and texels", {1, 0}},
                   {"entries of displacement_map_for_tests = read by its test", {1, 1}}});
    expect_change("the second side, past its unit", simulation, [&] { read_directly(of_test, address); },
                  {{"entries of displacement_map_for_tests = read by its test", {1, 0}}});
}

// By blocking transport, which does all the work at once.
TEST_CASE("conservation: an extra transformed vertex and extra decided triangles break their equations") {
    TimedRun simulation(two_triangles_split_once());
    Pipeline& p = simulation.pipeline;

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
                   {"triangles in get_triangle = decided", {0, 1}},
                   {"triangles in pass_or_tessellate = decided", {0, 1}},
                   {"triangles in lighting = finished - culled", {0, 1}},
                   {"parts in calculate_new_u = vertices and edges", {0, 3}},
                   {"parts in normal_test = vertices and its edges", {0, 3}},
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
                          give(p.tessellation_tests[0].collect_tests->to_pass_or_tessellate, edge);
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
                   {"triangles in get_triangle = decided", {0, 1}},
                   {"triangles in pass_or_tessellate = decided", {0, 1}},
                   {"triangles in triangle_queue = taken by it", {0, 2}},
                   {"parts in calculate_new_u = vertices and edges", {0, 3}},
                   {"parts in normal_test = vertices and its edges", {0, 3}},
                   {"edges in tex_coord_test = edges", {0, 3}},
                   {"edges in summed_height_test = its edges", {0, 3}},
                   {"edges in view_test = edges", {0, 3}},
                   {"edges taken from tessellation_tests = edges", {0, 3}},
                   {"edges collected = edges", {0, 3}},
                   {"requests to displacement_map = vertices, midpoints and texels", {0, 3}},
                   {"requests to normal_map = vertices and edges of normal_test", {0, 3}},
                   {"requests to summed_height_table = those of each edge tested by table", {0, 9}}});

    DecidedTriangle untested;
    untested.pass.triangle.finished = true;
    expect_change("a finished triangle that goes round for normals", simulation,
                  [&] { give(p.triangle_pass_or_tessellate->to_tessellation, untested); },
                  {{"children of tessellation = taken by triangle_queue", {1, 1}},
                   {"taken by triangle_queue = by get_triangle from it", {1, 0}},
                   {"triangles cut by tessellation + finished = decided", {1, 0}},
                   {"triangles recirculated for normals = decided for normals", {1, 0}},
                   {"triangles in triangle_queue = taken by it", {0, 1}}});
}

// Two places on chip: some of the spilled triangles are still off chip when the machine is stopped.
TEST_CASE("conservation: spilled triangles still off chip do not count as read back") {
    Job job = full_split_job(1, 3);
    job.hardware.queue.capacity = 2;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 10'000);
    TriangleQueue& queue = simulation.pipeline.triangle_queue;
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    while (queue.spilled() < 6 || queue.spilled() == queue.refilled())
        sc_core::sc_start(simulation.pipeline.clock.period());
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
    simulation.pipeline.lighting.activity().item_in(simulation.cycles());
    simulation.monitor.mesh = first_of(simulation.monitor.mesh, 7);
    const WorkResult broken = work_result(work, simulation);
    CHECK(broken.violations == 2);
    CHECK(broken.first_violation == "finished = emitted: 8 and 7");
}

#include "testbench/output/report/statistics.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "modules/datapath/pack_triangle.h"
#include "testbench/output/report/figures_text.h"
#include "testbench/tests/support/hand_made_run.h"

// statistics.json and .csv: every figure of small runs derived by hand, and each counter of the machine in its figure.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

/// Maps "group.name" to its value, with numbers as doubles.
struct Figures {
    std::map<std::string, double> numbers;
    std::map<std::string, std::string> words;

    explicit Figures(const std::vector<Figure>& figures) {
        for (const Figure& figure : figures) {
            const std::string name = figure.group + "." + (figure.row.empty() ? "" : figure.row + ".") + figure.name;
            INFO(name);
            CHECK(numbers.count(name) + words.count(name) == 0);
            CHECK_FALSE(figure.description.empty());
            std::visit(
                [&](const auto& value) {
                    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>)
                        numbers[name] = static_cast<double>(value);
                    else
                        words[name] = value;
                },
                figure.value);
        }
    }

    void require(const std::string& group, const std::map<std::string, double>& wanted) const {
        for (const auto& [name, value] : wanted) {
            INFO(group << '.' << name);
            REQUIRE(numbers.count(group + "." + name) == 1);
            CHECK(numbers.at(group + "." + name) == Approx(value));
        }
    }
    /// The same, and requires that the group has no other figure.
    void require_all(const std::string& group, const std::map<std::string, double>& wanted) const {
        require(group, wanted);
        for (const auto& [name, value] : numbers) {
            INFO(name);
            if (name.substr(0, name.rfind('.')) == group)
                CHECK(wanted.count(name.substr(group.size() + 1)) == 1);
        }
    }
};

Figures figures_of(const Simulation& simulation) {
    return Figures(collect_statistics(simulation.setup, simulation, count_mesh(simulation.monitor.mesh)));
}

EmittedTriangle::Corner corner(std::uint32_t u, std::uint32_t v, std::int32_t z, std::uint8_t generation) {
    EmittedTriangle::Corner c;
    c.texture = {u, v};
    c.displaced = {static_cast<std::int32_t>(u), static_cast<std::int32_t>(v), z};
    c.generation = generation;
    return c;
}

}  // namespace

// Two base triangles of a plane, each split into four: a mesh of 3 x 3 vertices. 10 passes of three edges; all six
// edges of the two base triangles split, those of the eight children do not. The children lack all three normals.
TEST_CASE("statistics: two triangles split once have the figures worked out by hand") {
    Job job = full_split_job(1, 1);
    job.map.width = job.map.height = 8;
    TimedRun simulation(setup_of(job));
    const Figures f = figures_of(simulation);
    CHECK(f.words.at("run.mode") == "timed");
    f.require_all(
        "run", {{"edges_tested", 30}, {"edges_split", 6}, {"triangles_finished", 8}, {"edges_per_triangle", 30.0 / 8}});
    // 16 edges of the mesh and 5 of the base mesh, which all split
    f.require_all("useful_work", {{"vertices", 9},
                                  {"vertices_made", 6 + 30},
                                  {"vertices_thrown_away", 30 - 6},
                                  {"made_per_vertex", 4},
                                  {"normals_transformed", 24},
                                  {"normals_per_vertex", 24.0 / 9},
                                  {"edges", 16 + 5},
                                  {"edge_tests", 30},
                                  {"normal_tests", 30},
                                  {"summed_height_tests", 30},
                                  {"summed_height_tests_by_codes", 0},
                                  {"tests_per_edge", 30.0 / 21}});
    f.require_all("get_triangle", {{"host_triangles", 2}, {"queue_triangles", 8}});
    f.require_all("transform", {{"positions", 36}, {"normals", 24}});
    f.require("pass_or_tessellate", {{"passes", 10}, {"normal_passes", 0}, {"culled", 0}});
    f.require_all("tessellation",
                  {{"made_into_2", 0}, {"made_into_3", 0}, {"made_into_4", 2}, {"passed_unchanged", 0}});
    f.require("triangle_queue", {{"taken", 8}});
    f.require_all("lighting", {{"triangles", 8}});
    // one or two bytes per code; three components of 16 bits; 9 x 9 sums
    const std::uint64_t sum = simulation.setup.registers.height_table.entry_bytes;
    // one port per table; 16 + 24 + 51 + 12
    f.require("area", {{"transform_multipliers", 24},
                       {"transform_register_bits", 300 + 20 * 381},
                       {"total_multipliers", 103},
                       {"total_ports", 3}});
    f.require_all(
        "displacement_map",
        {{"size", 8 * 8 * 2}, {"entry", 2}, {"reads", 36}, {"bytes_read", 36 * 2}, {"reads_per_edge", 36.0 / 30}});
    f.require_all(
        "normal_map",
        {{"size", 8 * 8 * 6}, {"entry", 6}, {"reads", 36}, {"bytes_read", 36 * 6}, {"reads_per_edge", 36.0 / 30}});
    f.require_all("summed_height_table", {{"size", 9.0 * 9 * static_cast<double>(sum)},
                                          {"entry", static_cast<double>(sum)},
                                          {"reads", 360},
                                          {"bytes_read", 360.0 * static_cast<double>(sum)},
                                          {"reads_per_edge", 12}});
    f.require_all("mesh", {{"triangles", 8}, {"generation_0", 0}, {"generation_1", 8}});

    // P 3 x 32; N, T 3 x 16; handedness 1; t 2 x 25; P's 2 x 24, w 32, in front 1
    constexpr std::uint64_t base_vertex = 96 + 48 + 48 + 1 + 50, finished_vertex = 96 + 48 + 50;
    constexpr std::uint64_t queue_entry = 3 * (base_vertex + 4 + 2 + 96 + 48 + 48 + 81) + 6,
                            vertex_to_light = 81 + 48 + 50;
    const auto bytes = [](std::uint64_t bits) { return static_cast<double>((bits + 7) / 8); };
    const double tables = 8 * 8 * 2 + 8 * 8 * 6 + 81.0 * static_cast<double>(sum);
    const double base = bytes(6 * base_vertex), whole = bytes(9 * finished_vertex) + 8 * 3 * 4;
    REQUIRE(whole > base);
    f.require_all("host", {{"base_triangles", 2},
                           {"base_triangles_dropped", 0},
                           {"mesh_bytes", base},
                           {"table_bytes", tables},
                           {"register_bytes", 4 * 48},
                           {"tessellated_vertices", 9},
                           {"tessellated_mesh_bytes", whole},
                           {"tessellated_mesh_bytes_unindexed", bytes(24 * finished_vertex)},
                           {"bandwidth_saving", whole / base},
                           {"frames_to_pay_for_tables", tables / (whole - base)}});
    f.require("formats", {{"queue_entry", queue_entry}, {"lighting_vertex", vertex_to_light}});
    const datapath::Formats& formats = simulation.setup.registers.formats;
    f.require("streams",
              {{"tag", 6},
               {"triangle", queue_entry},
               {"triangle_to_light", 3 * vertex_to_light},
               {"view_result", 6 + 4 + 1},
               {"base_point", 6 + 4 + 3 * formats.position.bits + 3 * formats.normal.bits + 2 * formats.texture.bits}});
}

TEST_CASE("statistics: each counter of the machine is in its own figure") {
    HandMadeRun run;
    const Figures f = figures_of(run.simulation);
    CHECK(f.words.at("run.mode") == "functional");
    f.require_all(
        "run",
        {{"edges_tested", 33}, {"edges_split", 17}, {"triangles_finished", 9}, {"edges_per_triangle", 33.0 / 9}});
    f.require("useful_work", {{"vertices_made", 33}, {"vertices_thrown_away", 16}, {"normals_transformed", 15}});
    f.require("pass_or_tessellate", {{"passes", 11},
                                     {"normal_passes", 5},
                                     {"split_by_normal", 10},
                                     {"split_by_summed_height", 4},
                                     {"split_by_both", 1},
                                     {"split_by_highlight", 2},
                                     {"split_in_highlight", 3},
                                     {"stopped_by_view", 3},
                                     {"stopped_by_tex_coord", 5},
                                     {"stopped_by_generation", 2},
                                     {"stopped_by_view_alone", 3},
                                     {"stopped_by_tex_coord_alone", 4},
                                     {"stopped_by_generation_alone", 1},
                                     {"stopped_by_several", 1},
                                     {"culled", 2}});
    f.require_all("tessellation",
                  {{"made_into_2", 1}, {"made_into_3", 2}, {"made_into_4", 4}, {"passed_unchanged", 0}});
    const double entry = datapath::packed_triangle_bits(run.setup.registers.formats);
    f.require_all("triangle_queue",
                  {{"taken", 24}, {"high_water_mark", 24}, {"high_water_bytes", std::ceil(24 * entry / 8)}});
    f.require_all("lighting", {{"triangles", 7}});
    f.require_all("mesh", {{"triangles", 9}, {"generation_0", 9}});
    for (const auto& [name, value] : f.numbers)
        CHECK(name.rfind("timing", 0) == std::string::npos);  // no cycles are claimed
}

// 4 passes in which three edges request a split, and 2 in which two do: 4 * 2 + 2 edges are tested again.
TEST_CASE("statistics: edges tested again, since an edge of greater rank was split") {
    HandMadeRun run(datapath::Triangulation::greatest_rank);
    const Figures f = figures_of(run.simulation);
    f.require("run", {{"edges_tested", 33}, {"edges_split", 7}});
    f.require("pass_or_tessellate", {{"passes", 11}, {"edges_uncut", 10}});
    f.require_all("tessellation",
                  {{"made_into_2", 7}, {"made_into_3", 0}, {"made_into_4", 0}, {"passed_unchanged", 0}});
}

TEST_CASE("statistics: emitted triangles record the tests that stopped them") {
    HandMadeRun run;
    std::map<unsigned, int> stopped;
    for (const EmittedTriangle& triangle : run.simulation.monitor.mesh.triangles)
        ++stopped[triangle.stopped_by];
    CHECK(stopped == std::map<unsigned, int>{{0, 5},  // those that went round for normals
                                             {datapath::view_bit, 1},
                                             {datapath::tex_coord_bit, 1},
                                             {datapath::tex_coord_bit | datapath::generation_bit, 1},
                                             {datapath::generation_bit, 1}});
}

// The schedule of modules/test_one_triangle.cpp. First round: parts leave Get Triangle in cycles 1 to 6; vertices enter
// Displace Vertex in 2, 3, 4 (+ 1 for the map) and Transform in 9, 10, 11, edges in 12, 13, 14; joined in 47. Second
// round: taken in 50; three normals, which read nothing, are in Displace Vertex from 52 and in Transform from 58;
// joined in 80, lit in 81, out in 85.
TEST_CASE("statistics: one triangle's cycles in each unit are those worked out by hand") {
    TimedRun simulation(one_triangle());
    const Figures f = figures_of(simulation);
    f.require_all("timing", {{"cycles", 86},
                             {"clock_period", 5000},
                             {"time", 86 * 5e-9},
                             {"cycles_per_triangle", 86},
                             {"cycles_per_pass", 86},
                             {"cycles_per_edge", 86.0 / 3},
                             {"base_triangle_share", 0.5},
                             {"most_triangles_ahead_of_parts", 1},
                             {"bottleneck_bound", 86.0 / 36}});
    CHECK(f.words.at("timing.bottleneck") == "none");
    CHECK_THAT(f.words.at("timing.bottleneck_in_words"), Contains("bound by latency"));
    struct Books {
        const char* unit;
        double items, busy, waiting, blocked, occupied, item_cycles, most;
    };
    for (const Books& b : {
             // parts in 1 to 6 and in 51 to 53; a triangle stays until its last part is taken
             Books{"get_triangle", 2, 6 + 3, 0, 0, 9, 6 + 3, 1},
             // one cycle per part: six and three in sequence
             Books{"calculate_new_p", 9, 6 + 3, 0, 0, 9, 9, 1},
             // six parts of 1 + 6, the first one cycle alone with its read: 2 to 13; three of 6: 52 to 59
             Books{"displace_vertex", 9, 11 + 8, 1, 0, 9, 6 * 7 + 3 * 6, 6},
             Books{"transform", 9, 25 + 22, 0, 0, 9, 9 * 20, 6},
             // edges 0 and 1 follow the third vertex directly; edge 2 is held back from 6 to 31
             Books{"tessellation_tests_0.tex_coord_test", 3, 3, 0, 0, 3, 3, 1},
             Books{"tessellation_tests_0.view_test", 3, 3, 0, 0, 3, 3, 1},
             Books{"pass_or_tessellate", 2, 1 + 1, 0, 0, 2, 47 - 29 + 1 + 80 - 78 + 1, 1},
             Books{"tessellation", 1, 1, 0, 0, 1, 1, 1},
             Books{"lighting", 1, 4, 0, 0, 1, 4, 1},
             Books{"displacement_map", 6, 6, 0, 0, 6, 6, 1},
             // 24 cycles for edges 0 and 1 from 5, 12 for edge 2 from 32
             Books{"summed_height_table", 9, 36, 0, 0, 36, 0, 0},
             Books{"off_chip_memory", 0, 0, 0, 0, 0, 0, 0},
         }) {
        INFO(b.unit);
        f.require("timing." + std::string(b.unit), {{"items", b.items},
                                                    {"items_out", b.items},
                                                    {"busy", b.busy},
                                                    {"waiting_for_memory", b.waiting},
                                                    {"blocked", b.blocked},
                                                    {"starved", 86 - b.busy - b.waiting - b.blocked},
                                                    {"utilisation", b.occupied / 86},
                                                    {"throughput", b.items / 86}});
        if (b.item_cycles > 0)
            f.require(
                "timing." + std::string(b.unit),
                {{"occupancy", b.item_cycles / 86}, {"latency", b.item_cycles / b.items}, {"high_water_mark", b.most}});
    }
    f.require("timing.tessellation_tests_0.calculate_new_u",
              {{"blocked", 31 - 6}, {"blocked_by_tessellation_tests_0.view_test", 31 - 6}});
    f.require("timing.displace_vertex", {{"waiting_for_displacement_map", 1}});
    // queues and joins have a rate and a level: one triangle for one cycle, and three edges, two of which wait for the
    // third
    f.require("timing.tessellation_tests_0.collect_tests", {{"items", 3}, {"items_out", 3}, {"throughput", 3.0 / 86}});
    for (const char* const name : {"triangle_queue", "tessellation_tests_0.collect_tests"})
        for (const char* const figure : {"busy", "starved", "waiting_for_memory", "blocked", "utilisation"})
            CHECK(f.numbers.count(std::string("timing.") + name + "." + figure) == 0);
    // it leaves in the cycle in which it arrives
    f.require("timing.triangle_queue", {{"items", 1},
                                        {"items_out", 1},
                                        {"throughput", 1.0 / 86},
                                        {"occupancy", 1.0 / 86},
                                        {"latency", 1},
                                        {"high_water_mark", 1},
                                        {"capacity", 0},
                                        {"on_chip_high_water_mark", 1},
                                        {"spilled", 0},
                                        {"refilled", 0},
                                        {"spill_bytes", 0}});
}

TEST_CASE("statistics: spilled records are read back whole") {
    Job job = full_split_job(1, 2);
    job.hardware.queue.capacity = 2;
    TimedRun simulation(setup_of(job));
    const double spilled = static_cast<double>(simulation.machine.triangle_queue.spilled());
    REQUIRE(spilled > 0);
    // 1572 bits per triangle
    figures_of(simulation)
        .require("timing.triangle_queue", {{"capacity", 2},
                                           {"on_chip_high_water_mark", 2 + 1},
                                           {"spilled", spilled},
                                           {"refilled", spilled},
                                           {"spill_bytes", 2 * spilled * 197}});
}

TEST_CASE("statistics as text: JSON is by group, CSV has one row per figure") {
    std::vector<Figure> figures;
    FigureGroup run(figures, "run"), other(figures, "a.b");
    run.add("mode", "timed", "", "to the cycle, or not");
    run.add("edges", UINT64_MAX, "edge", "tested");
    other.add("change", -3, "", "a \"signed\" one");
    other.add("share", 0.25, "edge/triangle", "real");
    CHECK(statistics_csv(figures) ==
          "name,value,unit,description\n"
          "run.mode,timed,,\"to the cycle, or not\"\n"
          "run.edges,18446744073709551615,edge,tested\n"
          "a.b.change,-3,,\"a \"\"signed\"\" one\"\n"
          "a.b.share,0.25,edge/triangle,real\n");
    const auto json = nlohmann::json::parse(statistics_json(figures));
    CHECK(json["run"]["edges"]["value"] == 18446744073709551615u);
    CHECK(json["a.b"]["change"] == nlohmann::json{{"value", -3}, {"unit", ""}, {"description", "a \"signed\" one"}});
    CHECK(json["a.b"]["share"]["value"] == 0.25);
}

TEST_CASE("statistics as text: a line for each figure, a table of the rows of a group") {
    std::vector<Figure> figures;
    FigureGroup run(figures, "run");
    run.add("mode", "timed", "", "to the cycle, or not");
    run.add("edges", std::uint64_t{59100}, "edge", "tested");
    run.add("first_wrong", "", "", "nothing to show");
    run.add("remedy", "a sentence of more than thirty-two characters", "", "what to do");
    FigureGroup(figures, "timing").add("passed", false, "", "");
    for (const char* const unit : {"transform", "normal_test"}) {
        FigureGroup row(figures, "timing", unit);
        row.add("busy", std::uint64_t{250}, "cycle", "at work", 1000);
        row.add("share", 1.0 / 3, "1", "of the most");
        row.add("note", "short", "", "");
    }
    FigureGroup queue(figures, "timing", "queue");
    queue.add("share", 0.5, "1", "of the most");
    queue.add("spilled", std::uint64_t{7}, "triangle", "written out");
    CHECK(figures_text(figures) ==
          "run\n"
          "  mode    timed       to the cycle, or not\n"
          "  edges   59100 edge  tested\n"
          "  remedy  what to do\n"
          "    a sentence of more than thirty-two characters\n"
          "\n"
          "timing\n"
          "  passed  no\n"
          "                busy     share  note\n"
          "  transform    25.00  0.333333  short\n"
          "  normal_test  25.00  0.333333  short\n"
          "  queue                    0.5         spilled 7\n"
          "    busy     % of 1000 cycle: at work\n"
          "    share    1: of the most\n"
          "    spilled  triangle: written out\n");
    CHECK(nlohmann::json::parse(statistics_json(figures))["timing.queue"]["spilled"]["value"] == 7);
}

TEST_CASE("mesh counts: vertices and edges that triangles share count once") {
    const auto a = corner(0, 0, 0, 0), b = corner(8, 0, 0, 0), c = corner(0, 8, 0, 0), d = corner(8, 8, 0, 2);
    CHECK(count_mesh({}).tested_edges() == 0);
    EmittedTriangle first, second;
    first.corners = {a, b, c};
    second.corners = {c, b, d};
    second.culled = true;
    const auto require = [&](std::uint64_t vertices, std::uint64_t inserted, std::uint64_t edges) {
        const MeshCounts counts = count_mesh({std::vector{first, second}});
        CHECK(counts.vertices == vertices);
        CHECK(counts.inserted_vertices == inserted);
        CHECK(counts.edges == edges);
        CHECK(counts.tested_edges() == edges + inserted);
    };
    require(4, 1, 5);
    SECTION("a seam of t") {
        second.corners[0].texture.u = 16;
        require(5, 1, 6);
    }
    SECTION("a crease, where N' differ") {
        second.corners[0].displaced_normal.z = 1;
        require(5, 1, 6);
    }
    SECTION("a crack, where P' differ") {
        second.corners[0].displaced.z = 1;
        require(5, 1, 6);
    }
    SECTION("the other way round is the same edge") {
        std::swap(second.corners[0], second.corners[1]);
        require(4, 1, 5);
    }
}

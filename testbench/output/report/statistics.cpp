#include "testbench/output/report/statistics.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "modules/datapath/pack_triangle.h"
#include "modules/datapath/reciprocal.h"
#include "modules/sockets/items.h"
#include "testbench/machine/host_traffic.h"
#include "testbench/machine/totals.h"
#include "testbench/output/report/area.h"
#include "testbench/output/report/ratio.h"
#include "testbench/output/report/saturation_figures.h"
#include "testbench/output/report/timing_statistics.h"

namespace tessera {

namespace {

void format_figures(std::vector<Figure>& all, const MachineSetup& setup) {
    const datapath::Formats& formats = setup.registers.formats;
    FigureGroup c(all, "formats");
    c.add("position_bits", formats.position.bits, "bit", "P, P', one component");
    c.add("position_fraction", formats.position.fraction, "bit", "of these, fraction bits");
    c.add("model_scale", setup.model_scale.scale, "world/model", "world unit of the machine per unit of the model");
    c.add("normal_bits", formats.normal.bits, "bit", "N, T, N', N's, normal map, one component");
    c.add("texture_bits", formats.texture.bits, "bit", "u or v, the border bit included");
    c.add("tex_coord_fraction", formats.tex_coord_fraction, "bit", "of u or v, as compared by the Tex Coord Test");
    c.add("displacement_bits", formats.displacement.bits, "bit", "d");
    c.add("summed_height_bits", formats.summed_height.bits, "bit",
          setup.summed_height_bits_chosen ? "SAT entry, chosen for this mesh" : "SAT entry, as configured");
    c.add("largest_rectangle_sum", setup.largest_rectangle_sum, "code",
          "bound on any rectangle's sum over this mesh, which the SAT entry must hold");
    c.add("summed_height_bits_needed",
          setup.largest_rectangle_sum == 0 ? 1 : 64 - datapath::leading_zeros(setup.largest_rectangle_sum), "bit",
          "narrowest SAT entry that holds that sum");
    if (formats.height_test == datapath::HeightTest::rank) {
        c.add("rank_bits", formats.rank_bits, "bit", "of a rank in the Rank Table");
        c.add("bound_bits", formats.bound_bits, "bit", "of a bound in the Rank Table");
    }
    c.add("view_distance_fraction", formats.view_distance.fraction, "bit", "of w, as wide as a position");
    c.add("screen_bits", formats.screen.bits, "bit", "P's, x or y");
    c.add("queue_entry", datapath::packed_triangle_bits(formats), "bit", "one triangle in the Triangle Queue");
    c.add("lighting_vertex", item_bits<TriangleToLight>(formats, 0) / 3, "bit", "one vertex to Lighting");
}

/// Width of each stream: one item with its tag, without annotations.
void stream_figures(std::vector<Figure>& all, const MachineSetup& setup) {
    const int tag = tag_bits(setup.design);
    FigureGroup c(all, "streams");
    c.add("tag", tag, "bit", "identifies a triangle between Get Triangle and Pass or Tessellate");
    StreamItems::for_each([&](auto type) {
        using Item = typename decltype(type)::Item;
        if (std::is_same_v<Item, Family> && setup.design.work == Work::triangle)
            return;
        std::string name = DescriptionOf<Item>::Type::name;
        std::replace(name.begin(), name.end(), ' ', '_');
        c.add(name, item_bits<Item>(setup.registers.formats, tag), "bit",
              "one item of that stream: modules/sockets/README.md");
    });
}

void memory_figures(std::vector<Figure>& all, const std::string& name, const datapath::TableLayout& table,
                    std::uint64_t reads, std::uint64_t edges) {
    FigureGroup c(all, name);
    c.add("size", table.bytes(), "byte", "the whole table");
    c.add("entry", table.entry_bytes, "byte", "one entry");
    c.add("reads", reads, "entry", "entries read");
    c.add("bytes_read", reads * table.entry_bytes, "byte", "bytes read");
    c.add("reads_per_edge", ratio(reads, edges), "entry/edge", "entries read per edge tested");
}

void cache_figures(std::vector<Figure>& all, const std::string& name, const Simulation& simulation,
                   const std::unique_ptr<TableCache> Machine::*cache, std::uint64_t finished) {
    std::uint64_t hits = 0, fills = 0, entries = 0, bytes = 0;
    for (const auto& hosted : simulation.machines) {
        const TableCache& its = *(hosted->machine.*cache);
        hits += its.hits();
        fills += its.fills();
        entries += its.entries_read();
        bytes += its.bytes_fetched();
    }
    FigureGroup c(all, name);
    c.add("cache_hits", hits, "entry", "entries whose line was present or being fetched");
    c.add("cache_fills", fills, "line", "lines fetched from off-chip memory");
    c.add("cache_hit_rate", 100 * ratio(hits, entries), "percent", "of entries read");
    c.add("bytes_fetched", bytes, "byte", "of these lines");
    c.add("bytes_fetched_per_triangle", ratio(bytes, finished), "byte/triangle", "per finished triangle");
}

void texel_figures(std::vector<Figure>& all, const TexelSpread& spread) {
    FigureGroup c(all, "texels");
    const auto sizes = [&](const std::string& axis, std::size_t k) {
        c.add("mean_" + axis, spread.mean[k], "model/map",
              "length of a whole map along " + axis +
                  ", mean over the base mesh: the one size that normals are made for");
        c.add("smallest_" + axis, spread.smallest[k], "model/map", "likewise, on the triangle where it is smallest");
        c.add("largest_" + axis, spread.largest[k], "model/map", "likewise, largest");
    };
    sizes("u", 0);
    sizes("v", 1);
    c.add("largest_shear", spread.shear, "degree", "by which the map's axes on a triangle are not perpendicular");
    c.add("median_normal_error", spread.median_error, "degree", "of N', from the one size, over the surface");
    c.add("largest_normal_error", spread.largest_error, "degree", "likewise, largest");
    c.add("wrong_normals", spread.wrong_percent, "percent",
          fmt::format("of the surface, where that error is above {} degrees", TexelSpread::noticeable));
}

void host_figures(std::vector<Figure>& all, const MachineSetup& setup, std::uint64_t finished, std::uint64_t vertices) {
    const datapath::Formats& formats = setup.registers.formats;
    const auto bytes = [](std::uint64_t bits) { return (bits + 7) / 8; };
    const HostTraffic traffic = host_traffic(setup);
    const std::uint64_t base = traffic.base_mesh;
    const std::uint64_t tables = traffic.displacement_map + traffic.normal_map + traffic.summed_height_table;
    // P', N', t
    const auto vertex =
        static_cast<unsigned>(3 * formats.position.bits + 3 * formats.normal.bits + 2 * formats.texture.bits);
    const std::uint64_t whole = bytes(finished * 3 * vertex);
    const std::uint64_t indexed = bytes(vertices * vertex) + finished * 3 * 4;
    FigureGroup c(all, "host");
    c.add("base_triangles", setup.base_triangles.size(), "triangle", "sent to Get Triangle");
    c.add("base_triangles_dropped", setup.base_dropped, "triangle", "collapsed when rounded to the formats");
    c.add("mesh_bytes", base, "byte", "base mesh: three vertices of P, N, T, t per triangle; every frame");
    c.add("table_bytes", tables, "byte",
          "displacement map, normal map, the height test's table; once, the normal map again when the scale "
          "changes");
    c.add("register_bytes", traffic.registers, "byte", "registers, as 32 bit words; once, later those that change");
    c.add("tessellated_vertices", vertices, "vertex", "distinct vertices of the finished mesh, by t, P' and N'");
    c.add("tessellated_mesh_bytes", indexed, "byte",
          "the same mesh sent whole and indexed: distinct vertices of P', N', t, three 32 bit indices per "
          "triangle; every frame");
    c.add("tessellated_mesh_bytes_unindexed", whole, "byte",
          "likewise, three vertices per triangle as the base mesh is sent");
    c.add("bandwidth_saving", ratio(indexed, base), "times",
          "tessellated mesh, indexed, over base mesh, per frame, without tables");
    c.add("frames_to_pay_for_tables", indexed > base ? ratio(tables, indexed - base) : 0.0, "frame",
          "number of frames after which the tables' bytes are saved; 0: never");
}

void area_figures(std::vector<Figure>& all, const Simulation& simulation) {
    const std::vector<UnitArea> units = area_of(simulation);
    FigureGroup c(all, "area");
    const auto add = [&](const UnitArea& unit) {
        const auto part = [&](const char* what, std::uint64_t value, const char* figure_unit, const char* description) {
            if (value > 0)
                c.add(unit.name + what, value, figure_unit, description);
        };
        part("_multipliers", unit.multiplier_count(), "multiplier", "that give a result every initiation interval");
        if (!unit.multipliers.empty()) {
            std::string widths;
            for (auto k = unit.multipliers.rbegin(); k != unit.multipliers.rend(); ++k)
                widths += fmt::format("{}{} of {} x {}", widths.empty() ? "" : ", ", k->second, k->first.first,
                                      k->first.second);
            c.add(unit.name + "_multiplier_widths", widths, "", "these by the bits of their operands");
        }
        part("_partial_products", unit.partial_product_bits(), "bit",
             "of these multipliers: one for each bit of one operand and bit of the other");
        part("_register_bits", unit.register_bits, "bit", "input buffers, pipeline registers, state");
        if (unit.name == "triangle_queue")
            c.add(unit.name + "_memory_bits", unit.memory_bits, "bit",
                  "the queue's capacity; 0 if it is unbounded: triangle_queue.high_water_bytes is what the run needed");
        else
            part("_memory_bits", unit.memory_bits, "bit",
                 "a table, or its cache, once for each port of a bank; the queue's capacity, unless it is unbounded");
        part("_ports", unit.ports, "port", "entries per cycle, all banks together");
    };
    for (const UnitArea& unit : units)
        add(unit);
    add(total_area(units));
}

/// Repeated work of the machine, compared with the minimum for the mesh.
void useful_work_figures(std::vector<Figure>& all, const Totals& totals, const Decisions::Evaluated& evaluated,
                         const MeshCounts& mesh) {
    const std::uint64_t made = totals.positions, normals = totals.normals, tested = totals.counts.edges_tested;
    FigureGroup c(all, "useful_work");
    c.add("vertices", mesh.vertices, "vertex",
          "distinct vertices of the finished mesh, by t, P' and N', culled triangles included");
    c.add("vertices_made", made, "vertex",
          "displaced and transformed: three per base triangle, and the midpoint of each edge tested (with families: of "
          "each edge split)");
    c.add("vertices_thrown_away", totals.thrown_away_vertices(), "vertex",
          "of these: midpoints of edges that were not split");
    c.add("made_per_vertex", ratio(made, mesh.vertices), "times", "vertices made per distinct vertex");
    c.add("normals_transformed", normals, "normal", "N's, again for each triangle whose parent did not have it");
    c.add("normals_per_vertex", ratio(normals, mesh.vertices), "times", "normals transformed per distinct vertex");
    c.add("edges", mesh.tested_edges(), "edge",
          "distinct edges that were tested, by their two vertices: those of the finished mesh, and those that "
          "were split");
    c.add("edge_tests", tested, "edge", "edges tested, counted per triangle and pass; final edges are not tested");
    c.add("normal_tests", evaluated.normal, "edge", "of these, edges whose Normal Test was evaluated");
    c.add("summed_height_tests", evaluated.summed_height, "edge",
          "likewise the Summed Height Test or its replacement, unless it is off");
    c.add("summed_height_tests_by_codes", evaluated.summed_height_by_codes, "edge",
          "of these, edges whose rectangles are single texels, with hardware.one_texel_from_map");
    c.add("tests_per_edge", ratio(tested, mesh.tested_edges()), "times", "edge tests per distinct edge");
}

void mesh_figures(std::vector<Figure>& all, const EmittedMesh& mesh) {
    std::array<std::uint64_t, 256> by_generation{};
    std::size_t last = 0;
    for (const EmittedTriangle& triangle : mesh.triangles) {
        const auto& v = triangle.corners;
        const std::size_t generation = std::max({v[0].generation, v[1].generation, v[2].generation});
        ++by_generation[generation];
        last = std::max(last, generation);
    }
    FigureGroup c(all, "mesh");
    c.add("triangles", mesh.triangles.size(), "triangle", "finished, culled ones included");
    for (std::size_t generation = 0; generation <= last; ++generation)
        c.add(fmt::format("generation_{}", generation), by_generation[generation], "triangle",
              "finished triangles whose youngest vertex is of this generation");
}

}  // namespace

std::vector<Figure> collect_statistics(const MachineSetup& setup, const Simulation& simulation,
                                       const MeshCounts& mesh) {
    const Totals totals(simulation);
    const DecidingUnit::Counts& counts = totals.counts;
    const Decisions::Counts& decided = totals.decided;
    const std::uint64_t edges = counts.edges_tested;
    std::vector<Figure> all;
    FigureGroup run(all, "run");
    const bool timed = setup.design.transport == Transport::non_blocking;
    run.add("mode", timed ? "timed" : "functional", "",
            timed ? "timed: non-blocking transport, cycle-accurate"
                  : "functional: blocking transport, untimed; no cycle counts");
    run.add("edges_tested", edges, "edge", "edges that went through Tessellation Tests");
    run.add("edges_split", counts.edges_split, "edge", "of these, split");
    run.add("triangles_finished", counts.finished, "triangle", "left the machine, culled ones included");
    run.add("edges_per_triangle", ratio(edges, counts.finished), "edge/triangle", "edges tested per finished triangle");
    format_figures(all, setup);
    stream_figures(all, setup);
    Decisions::Evaluated evaluated = totals.evaluated;
    if (!setup.registers.tests.summed_height_test)
        evaluated.summed_height = 0;
    useful_work_figures(all, totals, evaluated, mesh);
    host_figures(all, setup, counts.finished, mesh.vertices);
    texel_figures(all, setup.texel_spread);

    FigureGroup get(all, "get_triangle");
    get.add("host_triangles", totals.host_triangles, "triangle", "taken from the host");
    get.add("queue_triangles", totals.queue_triangles, "triangle", "taken from the Triangle Queue");

    FigureGroup transform(all, "transform");
    transform.add("positions", totals.positions, "vertex", "positions transformed");
    transform.add("normals", totals.normals, "normal", "normals transformed");

    FigureGroup decide(all, "pass_or_tessellate");
    decide.add("passes", counts.passes, "triangle", "triangles that went through the tests");
    decide.add("normal_passes", counts.normal_passes, "triangle", "recirculated once more for screen normals");
    const std::string height_test = functions_of(setup.registers.formats.height_test).title();
    decide.add("split_by_normal", decided.split_by_normal, "edge",
               fmt::format("split by the Normal Test, while the {} was false", height_test));
    decide.add("split_by_summed_height", decided.split_by_summed_height, "edge",
               fmt::format("split by the {}, while the Normal Test was false", height_test));
    decide.add("split_by_both", decided.split_by_both, "edge", "split by both");
    if (setup.registers.tests.highlight_test) {
        decide.add("split_by_highlight", decided.split_by_highlight, "edge",
                   "split by neither, but by the Highlight Test alone");
        decide.add("split_in_highlight", decided.split_in_highlight, "edge",
                   "split while the Highlight Test was true, whatever the other results");
    }
    if (setup.registers.triangulation == datapath::Triangulation::greatest_rank)
        decide.add("edges_uncut", counts.edges_uncut, "edge",
                   "requested a split while another edge of the triangle was split, and were tested again");
    decide.add("stopped_by_view", decided.stopped_by_view, "edge", "stopped by the View Test (possibly among others)");
    decide.add("stopped_by_tex_coord", decided.stopped_by_tex_coord, "edge", "likewise the Tex Coord Test");
    decide.add("stopped_by_generation", decided.stopped_by_generation, "edge", "likewise the Generation Test");
    const char* const alone = "stopped by this test alone: otherwise the edge would have been split";
    decide.add("stopped_by_view_alone", decided.stopped_by_view_alone, "edge", alone);
    decide.add("stopped_by_tex_coord_alone", decided.stopped_by_tex_coord_alone, "edge", alone);
    decide.add("stopped_by_generation_alone", decided.stopped_by_generation_alone, "edge", alone);
    decide.add("stopped_by_several", decided.stopped_by_several, "edge", "stopped by two or three of these tests");
    decide.add("culled", counts.culled, "triangle", "finished triangles that face away");

    FigureGroup tessellation(all, "tessellation");
    const auto& made = totals.made_into;
    tessellation.add("made_into_2", made[2], "triangle", "one edge split");
    tessellation.add("made_into_3", made[3], "triangle", "two edges split");
    tessellation.add("made_into_4", made[4], "triangle", "three edges split");
    tessellation.add("passed_unchanged", made[1], "triangle", "finished base triangles recirculated for normals");

    FigureGroup queue(all, "triangle_queue");
    queue.add("taken", totals.queued, "triangle", "triangles put in");
    queue.add("high_water_mark", totals.most_queued, "triangle",
              std::string("most triangles waiting at a time, in one machine") + one_after_another(setup));
    queue.add("high_water_bytes",
              (totals.most_queued * datapath::packed_triangle_bits(setup.registers.formats) + 7) / 8, "byte",
              std::string("memory that this takes") + one_after_another(setup));

    FigureGroup lighting(all, "lighting");
    lighting.add("triangles", totals.lit, "triangle", "lit and sent to the rasteriser");

    const auto table = [&](const std::string& name, const datapath::TableLayout& layout, std::uint64_t reads,
                           const std::unique_ptr<TableCache> Machine::*cache) {
        memory_figures(all, name, layout, reads, edges);
        if (simulation.machine.*cache != nullptr && timed)
            cache_figures(all, name, simulation, cache, counts.finished);
    };
    table("displacement_map", setup.registers.displacement_map, totals.displacement_map_reads,
          &Machine::displacement_map_cache);
    table("normal_map", setup.registers.normal_map, totals.normal_map_reads, &Machine::normal_map_cache);
    table(functions_of(setup.registers.formats.height_test).table(), setup.registers.height_table,
          totals.height_table_reads, &Machine::height_table_cache);

    FigureGroup saturated(all, "saturations");
    for (const SaturationFigure& figure : saturation_figures(setup, totals.saturations))
        saturated.add(figure.name, figure.count, figure.unit, figure.description);

    area_figures(all, simulation);
    mesh_figures(all, simulation.monitor.mesh);
    if (timed)
        timing_figures(all, simulation);
    return all;
}

namespace {

std::string group_and_row(const Figure& figure) {
    return figure.row.empty() ? figure.group : figure.group + "." + figure.row;
}

/// RFC 4180: fields with a comma or a quotation mark are quoted.
std::string csv_cell(const std::string& value) {
    if (value.find_first_of(",\"\n") == std::string::npos)
        return value;
    std::string cell = "\"";
    for (const char c : value)
        cell += c == '"' ? std::string("\"\"") : std::string(1, c);
    return cell + "\"";
}

}  // namespace

std::string statistics_json(const std::vector<Figure>& figures) {
    nlohmann::ordered_json json;
    for (const Figure& figure : figures) {
        nlohmann::ordered_json entry;
        std::visit([&](const auto& value) { entry["value"] = value; }, figure.value);
        entry["unit"] = figure.unit;
        entry["description"] = figure.description;
        json[group_and_row(figure)][figure.name] = std::move(entry);
    }
    return json.dump(2) + "\n";
}

std::string statistics_csv(const std::vector<Figure>& figures) {
    std::string text = "name,value,unit,description\n";
    for (const Figure& figure : figures) {
        const std::string value = std::visit([](const auto& held) { return fmt::format("{}", held); }, figure.value);
        text += fmt::format("{}.{},{},{},{}\n", group_and_row(figure), figure.name, csv_cell(value),
                            csv_cell(figure.unit), csv_cell(figure.description));
    }
    return text;
}

}  // namespace tessera

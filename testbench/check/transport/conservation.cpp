#include "testbench/check/transport/conservation.h"

#include <string>
#include <utility>

#include "modules/datapath/bilinear.h"
#include "testbench/machine/totals.h"

namespace tessera {

namespace {

class Equations {
  public:
    /// Sets the machine that the following equations belong to.
    void of(const std::string& machine) { machine_ = machine + ": "; }
    void add(const std::string& name, std::uint64_t left, std::uint64_t right) {
        list_.push_back({machine_ + name, left, right});
    }
    std::vector<Conservation> take() { return std::move(list_); }

  private:
    std::string machine_;
    std::vector<Conservation> list_;
};

std::uint64_t items(const Unit& unit) {
    return unit.activity().items_in();
}

void add_triangles(Equations& list, const MachineSetup& setup, const HostedMachine& machine) {
    const Pipeline& p = machine.pipeline;
    const auto& counts = p.pass_or_tessellate.counts();
    const auto& made = p.tessellation.made_into();
    const std::uint64_t cut = made[1] + made[2] + made[3] + made[4];
    if (setup.design.work == Work::triangle) {
        const std::uint64_t rounds = counts.passes + counts.normal_passes;
        list.add("triangles taken by get_triangle = decided",
                 p.get_triangle.host_triangles() + p.get_triangle.queue_triangles(), rounds);
        list.add("children of tessellation = taken by triangle_queue", p.tessellation.children(),
                 p.triangle_queue.taken());
        list.add("triangles cut by tessellation + finished = decided", cut + counts.finished, rounds);
    } else {
        const std::uint64_t base = p.get_triangle.host_triangles();
        list.add("base triangles and children of tessellation = decided", base + p.tessellation.children(),
                 counts.passes);
        list.add("decided = finished + taken by triangle_queue", counts.passes,
                 counts.finished + p.triangle_queue.taken());
        list.add("triangles cut by tessellation = taken by get_triangle from triangle_queue", cut,
                 p.get_triangle.queue_triangles());
    }
    list.add("triangles taken by get_triangle from the host = base triangles", p.get_triangle.host_triangles(),
             machine.host.sent());
    list.add("taken by triangle_queue = by get_triangle from it", p.triangle_queue.taken(),
             p.get_triangle.queue_triangles());
    list.add("triangles recirculated for normals = decided for normals", made[1], counts.normal_passes);
    list.add("finished = base triangles + edges split", counts.finished,
             p.get_triangle.host_triangles() + counts.edges_split);
    list.add("taken by the rasteriser = finished - culled", machine.rasteriser.triangles(),
             counts.finished - counts.culled);
}

/// Vertices sent to Tessellation Tests, none with families. With three units, each receives the two ends of its edge.
std::uint64_t bumps(const Pipeline& p, std::uint64_t vertices) {
    if (p.family_tessellation != nullptr)
        return 0;
    return p.tessellation_tests.size() == 1 ? vertices : 2 * vertices;
}

/// Requests to the normal map: with families, Displace Vertex bumps the vertices, otherwise the tests do.
std::uint64_t normal_map_requests(const Pipeline& p, std::uint64_t vertices, std::uint64_t normal) {
    return (p.family_tessellation != nullptr ? vertices : bumps(p, vertices)) + normal;
}

/// `midpoints` of edges are displaced, `normal` and `summed_height` of `edges` edges are evaluated; of the latter,
/// `by_codes` read the displacement map instead of the test's table, `off_lattice` read nothing.
struct Tested {
    std::uint64_t vertices;
    std::uint64_t edges;
    std::uint64_t midpoints;
    std::uint64_t normal;
    std::uint64_t summed_height;
    std::uint64_t by_codes;
    std::uint64_t off_lattice;
};

/// `each`: entries per map read of a vertex or an edge. `codes_an_edge`: the same, for an edge whose height test
/// decides by codes.
void add_reads(Equations& list, const Pipeline& p, const Tested& tested, std::uint64_t each,
               std::uint64_t codes_an_edge) {
    const auto& [vertices, edges, midpoints, normal, summed_height, by_codes, off_lattice] = tested;
    const std::string times = each == 1 ? "" : std::to_string(each) + " times ";
    list.add("reads of displacement_map by displace_vertex = " + times + "vertices and midpoints",
             p.displace_vertex.displacement_map.reads(), each * (vertices + midpoints));
    list.add("reads of displacement_map = " + times +
                 (each == 1 ? "vertices, midpoints and texels" : "vertices and midpoints, and texels"),
             p.displacement_map_reads(), each * (vertices + midpoints) + codes_an_edge * by_codes);
    list.add("reads of normal_map = " + times + "vertices and edges of normal_test", p.normal_map_reads(),
             each * normal_map_requests(p, vertices, normal));
    list.add("positions of transform = vertices and midpoints", p.transform.positions(), vertices + midpoints);
}

/// A table, or the cache through which the units read it.
struct Read {
    const TableMemory& table;
    const TableCache* cache;

    Read(const TableMemory& its_table, const std::unique_ptr<TableCache>& its_cache)
        : table(its_table), cache(its_cache.get()) {}
    std::uint64_t requests() const { return cache != nullptr ? items(*cache) : items(table); }
    std::uint64_t entries() const { return cache != nullptr ? cache->entries_read() : table.transactions(); }
    void add_fills(Equations& list) const {
        if (cache != nullptr)
            list.add("lines read of " + std::string(table.basename()) + " = fills of its cache", items(table),
                     cache->fills());
    }
};

void add_timed(Equations& list, const MachineSetup& setup, const HostedMachine& machine, const Tested& tested) {
    const auto& [vertices, edges, midpoints, normal, summed_height, by_codes, off_lattice] = tested;
    const Pipeline& p = machine.pipeline;
    const auto& counts = p.pass_or_tessellate.counts();
    const bool families = setup.design.work == Work::family;
    const std::uint64_t rounds = families ? p.get_triangle.host_triangles() + p.get_triangle.queue_triangles()
                                          : counts.passes + counts.normal_passes;
    list.add(families ? "triangles in get_triangle = taken" : "triangles in get_triangle = decided",
             items(p.get_triangle), rounds);
    list.add(
        families ? "families in pass_or_tessellate = triangles taken" : "triangles in pass_or_tessellate = decided",
        items(p.pass_or_tessellate), rounds);
    list.add("triangles in triangle_queue = taken by it", items(p.triangle_queue), p.triangle_queue.taken());
    list.add("triangles in lighting = finished - culled", items(p.lighting), counts.finished - counts.culled);

    // geometry branch: a base triangle's vertices, midpoints, and each new vertex's normal, which families include
    const std::uint64_t parts = p.get_triangle.parts_sent();
    list.add("parts in calculate_new_p = sent by get_triangle", items(p.calculate_new_p), parts);
    list.add("parts in displace_vertex = sent by get_triangle", items(p.displace_vertex), parts);
    list.add("parts in transform = sent by get_triangle", items(p.transform), parts);
    list.add("parts taken from transform = sent by get_triangle",
             families ? p.family_tessellation->from_transform.taken()
                      : p.triangle_pass_or_tessellate->from_transform.taken(),
             parts);
    list.add("positions and normals of transform = parts", p.transform.positions() + p.transform.normals(),
             families ? 2 * parts : parts);

    // tests: vertices end in the Normal Test
    const auto tests = [&](auto figure) { return sum_over_tests(p, figure); };
    const auto lanes = [&](auto figure) {
        return tests([&](const auto& t) {
            std::uint64_t sum = 0;
            for (const TessellationTests::Lane& lane : t.lanes())
                sum += figure(lane);
            return sum;
        });
    };
    list.add("parts in calculate_new_u = vertices and edges",
             lanes([](const auto& lane) { return items(lane.calculate_new_u); }), bumps(p, vertices) + edges);
    list.add("parts in normal_test = vertices and its edges", tests([](const auto& t) {
                 std::uint64_t sum = 0;
                 for (const NormalTest* test : t.normal_tests())
                     sum += items(*test);
                 return sum;
             }),
             bumps(p, vertices) + normal);
    list.add("edges in tex_coord_test = edges", lanes([](const auto& lane) { return items(lane.tex_coord_test); }),
             edges);
    const datapath::HeightTestFunctions& height_test = functions_of(setup.registers.formats.height_test);
    list.add("edges in " + height_test.unit() + " = its edges",
             tests([](const auto& t) { return items(t.height_test); }), summed_height);
    list.add("edges in view_test = edges", lanes([](const auto& lane) { return items(lane.view_test); }), edges);
    if (!families)
        list.add("vertices taken by view_test = vertices, once per unit",
                 tests([](const auto& t) { return t.view_test.from_transform->taken(); }),
                 vertices * p.tessellation_tests.size());
    std::uint64_t joined = 0;
    for (const StreamInput<TestedEdge>& input : families ? p.family_pass_or_tessellate->from_tessellation_tests
                                                         : p.triangle_pass_or_tessellate->from_tessellation_tests)
        joined += input.taken();
    list.add("edges taken from tessellation_tests = edges", joined, edges);
    list.add("edges collected = edges", tests([](const auto& t) { return items(t.collector); }), edges);

    const Read displacement_map(p.displacement_map, p.displacement_map_cache);
    const Read normal_map(p.normal_map, p.normal_map_cache);
    const Read height_table(p.height_table, p.height_table_cache);
    const TableMemory* const second_side = p.displacement_map_for_tests.get();
    const std::uint64_t by_displace_vertex = p.displace_vertex.displacement_map.reads();
    if (second_side == nullptr) {
        list.add("entries of displacement_map = read", displacement_map.entries(), p.displacement_map_reads());
        list.add("requests to displacement_map = vertices, midpoints and texels", displacement_map.requests(),
                 vertices + midpoints + by_codes);
    } else {
        list.add("entries of displacement_map = read by displace_vertex", displacement_map.entries(),
                 by_displace_vertex);
        list.add("entries of displacement_map_for_tests = read by its test", second_side->transactions(),
                 p.displacement_map_reads() - by_displace_vertex);
        list.add("requests to displacement_map = vertices and midpoints", displacement_map.requests(),
                 vertices + midpoints);
        list.add("requests to displacement_map_for_tests = edges tested by codes", items(*second_side), by_codes);
    }
    list.add("entries of normal_map = read", normal_map.entries(), p.normal_map_reads());
    list.add("entries of " + height_test.table() + " = read by its test", height_table.entries(),
             p.height_table_reads());
    for (const Read& read : {displacement_map, normal_map, height_table})
        read.add_fills(list);
    list.add("requests to normal_map = vertices and edges of normal_test", normal_map.requests(),
             normal_map_requests(p, vertices, normal));
    const std::uint64_t asked = height_test.requests * (summed_height - by_codes - off_lattice);
    list.add("requests to " + height_test.table() + " = those of each edge tested by table", height_table.requests(),
             setup.registers.tests.summed_height_test ? asked : 0);

    list.add("triangles spilled = refilled", p.triangle_queue.spilled(), p.triangle_queue.refilled());
    list.add("requests to off_chip_memory = spills and refills", items(p.off_chip_memory),
             2 * p.triangle_queue.spilled());
    list.add("bytes read from off_chip_memory = written", p.off_chip_memory.bytes_read(),
             p.off_chip_memory.bytes_written());
}

void add_machine(Equations& list, const MachineSetup& setup, const HostedMachine& machine) {
    const Pipeline& p = machine.pipeline;
    const DecidingUnit::Counts& counts = p.pass_or_tessellate.counts();
    const std::uint64_t base = p.get_triangle.host_triangles();
    // A triangle with k split edges has k + 1 children with 4 k new edges, the only ones that are not final; with
    // families, the k interior edges are tested once.
    const bool final_edges = setup.registers.formats.final_edges;
    const bool families = setup.design.work == Work::family;
    // An edge that requests a split while another is cut is tested again.
    const std::uint64_t edges = families      ? 3 * counts.finished + counts.edges_uncut
                                : final_edges ? 3 * base + 4 * counts.edges_split + counts.edges_uncut
                                              : 3 * counts.passes;
    const Decisions::Evaluated& evaluated = machine.decisions.evaluated();
    const Tested tested{3 * base,
                        edges,
                        families ? counts.edges_split : edges,
                        evaluated.normal,
                        evaluated.summed_height,
                        evaluated.summed_height_by_codes,
                        evaluated.off_lattice};
    add_triangles(list, setup, machine);
    list.add(families      ? "edges tested = 3 per finished triangle, and those tested again"
             : final_edges ? "edges tested = 3 per base triangle, 4 per split, and those tested again"
                           : "edges tested = 3 per pass",
             counts.edges_tested, edges);
    add_reads(list, p, tested, datapath::map_entry_count(setup.registers.formats),
              functions_of(setup.registers.formats.height_test).codes);
    if (setup.design.transport == Transport::non_blocking)
        add_timed(list, setup, machine, tested);
}

}  // namespace

std::vector<Conservation> conservation(const Simulation& simulation) {
    Equations list;
    list.add("finished = emitted", Totals(simulation).counts.finished, simulation.monitor.mesh.triangles.size());
    for (const auto& machine : simulation.machines) {
        if (simulation.machines.size() > 1)
            list.of(machine->pipeline.name());
        add_machine(list, simulation.setup, *machine);
    }
    return list.take();
}

void observe(Simulation& simulation, TransportCheck& check) {
    simulation.observe_decisions(check);
    observe_finished(simulation, check);
}

void observe_finished(Simulation& simulation, TransportCheck& check) {
    for (const auto& machine : simulation.machines) {
        machine->pipeline.pass_or_tessellate.finished.bind(check);
        machine->rasteriser.taken.bind(check);
    }
}

WorkResult work_result(const TransportCheck& check, const Simulation& simulation) {
    WorkResult result = check.result();
    for (const Conservation& equation : conservation(simulation)) {
        ++result.equations;
        if (!equation.holds() && result.violations++ == 0)
            result.first_violation =
                equation.name + ": " + std::to_string(equation.left) + " and " + std::to_string(equation.right);
    }
    return result;
}

}  // namespace tessera

#include "testbench/check/transport/conservation.h"

#include <map>
#include <string>
#include <systemc>
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

void add_triangles(Equations& list, const MachineSetup& setup, const HostedMachine& hosted) {
    const Machine& p = hosted.machine;
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
             hosted.host.sent());
    list.add("taken by triangle_queue = by get_triangle from it", p.triangle_queue.taken(),
             p.get_triangle.queue_triangles());
    list.add("triangles recirculated for normals = decided for normals", made[1], counts.normal_passes);
    list.add("finished = base triangles + edges split", counts.finished,
             p.get_triangle.host_triangles() + counts.edges_split);
    list.add("taken by the rasteriser = finished - culled", hosted.rasteriser.triangles(),
             counts.finished - counts.culled);
}

/// Requests to the normal map, by the unit that bumps the vertices and by the Normal Tests. Three Tessellation Tests units
/// each receive the two ends of their edge.
std::uint64_t normal_map_requests(const Machine& p, std::uint64_t vertices, std::uint64_t normal) {
    return (p.tessellation_tests.size() == 1 ? vertices : 2 * vertices) + normal;
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
void add_reads(Equations& list, const Machine& p, const Tested& tested, std::uint64_t each,
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

/// Calls `each` with every object inside, at any depth.
template <class Each>
void for_each_inside(const sc_core::sc_object& object, Each&& each) {
    for (const sc_core::sc_object* child : object.get_child_objects()) {
        each(*child);
        for_each_inside(*child, each);
    }
}

/// What memory ports have asked for.
struct Asked {
    std::uint64_t requests = 0, entries = 0;
};

/// The sum over the ports of the machine for which `which` is true.
template <class Which>
Asked asked(const Machine& p, Which&& which) {
    Asked sum;
    for_each_inside(p, [&](const sc_core::sc_object& object) {
        const auto* const socket = dynamic_cast<const MemoryPort::Socket*>(&object);
        if (socket == nullptr || !which(socket->port))
            return;
        sum.requests += socket->port.requests();
        sum.entries += socket->port.reads();
    });
    return sum;
}

/// For the streams and memories that the machine has: an item that is sent is taken, and counted by a unit that has no
/// other input; a memory receives the requests of its ports.
void add_connections(Equations& list, const HostedMachine& hosted) {
    const Machine& p = hosted.machine;
    const auto name_of = [&](const sc_core::sc_object& object) {
        const std::string name = object.name(), prefix = std::string(p.name()) + ".";
        return name.compare(0, prefix.size(), prefix) == 0 ? name.substr(prefix.size()) : name;
    };
    std::map<const sc_core::sc_object*, std::vector<std::uint64_t>> taken;  // by the unit's inputs
    const auto add_stream = [&](const auto& output) {
        const auto* const input = output.input();
        if (input == nullptr)
            return;
        list.add("items taken by " + name_of(*input) + " = sent by " + name_of(output), input->taken(), output.sent());
        taken[input->get_parent_object()].push_back(input->taken());
    };
    for_each_output(hosted.host, add_stream);
    for_each_inside(p, [&](const sc_core::sc_object& object) {
        if (const auto* module = dynamic_cast<const sc_core::sc_module*>(&object))
            for_each_output(*module, add_stream);
    });
    for (const Unit* unit : p.units()) {
        const std::string name = name_of(*unit);
        if (taken[unit].size() == 1)
            list.add("items in " + name + " = taken by its input", items(*unit), taken[unit].front());
        const Asked its = asked(p, [&](const MemoryPort& port) { return port.memory() == unit; });
        if (dynamic_cast<const MemoryServer*>(unit) != nullptr)
            list.add("requests received by " + name + " = made by its ports", items(*unit), its.requests);
        if (const auto* table = dynamic_cast<const TableMemory*>(unit))
            list.add("entries of " + name + " = read by its ports", table->transactions(), its.entries);
        if (const auto* cache = dynamic_cast<const TableCache*>(unit))
            list.add("entries of " + name + " = read by its ports", cache->entries_read(), its.entries);
    }
}

/// What no stream tells: how many items each unit sends.
void add_timed(Equations& list, const MachineSetup& setup, const HostedMachine& hosted, const Tested& tested) {
    const auto& [vertices, edges, midpoints, normal, summed_height, by_codes, off_lattice] = tested;
    const Machine& p = hosted.machine;
    const bool families = setup.design.work == Work::family;
    const std::uint64_t triangles = p.get_triangle.host_triangles() + p.get_triangle.queue_triangles();
    list.add("triangles in get_triangle = taken by it", items(p.get_triangle), triangles);
    list.add("triangles in pass_or_tessellate = taken by get_triangle", items(p.pass_or_tessellate), triangles);

    // a base triangle's vertices, midpoints, and each new vertex's normal, which families include
    const std::uint64_t parts = p.get_triangle.parts_sent();
    list.add("positions and normals of transform = parts", p.transform.positions() + p.transform.normals(),
             families ? 2 * parts : parts);

    const datapath::HeightTestFunctions& height_test = functions_of(setup.registers.formats.height_test);
    list.add("edges taken by " + height_test.unit() + " = its edges",
             sum_over_tests(p, [](const auto& t) { return t.height_test.input.taken(); }), summed_height);
    if (!families) {
        list.add("edges in view_test = edges", sum_over_tests(p, [](const auto& t) { return items(t.view_test); }),
                 edges);
        list.add("vertices taken by view_test = vertices, once per unit",
                 sum_over_tests(p, [](const auto& t) { return t.view_test.from_transform->taken(); }),
                 vertices * p.tessellation_tests.size());
    }
    list.add("edges collected = edges", sum_over_tests(p, [](const auto& t) { return items(t.collector); }), edges);

    const auto add_requests = [&](const std::string& table, const std::string& of, std::uint64_t expected) {
        const Asked its = asked(p, [&](const MemoryPort& port) { return port.socket.basename() == table; });
        list.add("requests to " + table + " = " + of, its.requests, expected);
    };
    add_requests("displacement_map", "vertices, midpoints and texels", vertices + midpoints + by_codes);
    add_requests("normal_map", "vertices and edges of normal_test", normal_map_requests(p, vertices, normal));
    const std::uint64_t by_table = height_test.requests * (summed_height - by_codes - off_lattice);
    add_requests(height_test.table(), "those of each edge tested by table",
                 setup.registers.tests.summed_height_test ? by_table : 0);
    add_requests("off_chip_memory", "spills and refills", 2 * p.triangle_queue.spilled());

    list.add("triangles spilled = refilled", p.triangle_queue.spilled(), p.triangle_queue.refilled());
    list.add("bytes read from off_chip_memory = written", p.off_chip_memory.bytes_read(),
             p.off_chip_memory.bytes_written());
}

void add_machine(Equations& list, const MachineSetup& setup, const HostedMachine& hosted) {
    const Machine& p = hosted.machine;
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
    const Decisions::Evaluated& evaluated = hosted.decisions.evaluated();
    const Tested tested{3 * base,
                        edges,
                        families ? counts.edges_split : edges,
                        evaluated.normal,
                        evaluated.summed_height,
                        evaluated.summed_height_by_codes,
                        evaluated.off_lattice};
    add_triangles(list, setup, hosted);
    list.add(families      ? "edges tested = 3 per finished triangle, and those tested again"
             : final_edges ? "edges tested = 3 per base triangle, 4 per split, and those tested again"
                           : "edges tested = 3 per pass",
             counts.edges_tested, edges);
    add_reads(list, p, tested, datapath::map_entry_count(setup.registers.formats),
              functions_of(setup.registers.formats.height_test).codes);
    if (setup.design.transport == Transport::non_blocking) {
        add_connections(list, hosted);
        add_timed(list, setup, hosted, tested);
    }
}

}  // namespace

std::vector<Conservation> conservation(const Simulation& simulation) {
    Equations list;
    list.add("finished = emitted", Totals(simulation).counts.finished, simulation.monitor.mesh.triangles.size());
    for (const auto& hosted : simulation.machines) {
        if (simulation.machines.size() > 1)
            list.of(hosted->machine.name());
        add_machine(list, simulation.setup, *hosted);
    }
    return list.take();
}

void observe(Simulation& simulation, TransportCheck& check) {
    simulation.observe_decisions(check);
    observe_finished(simulation, check);
}

void observe_finished(Simulation& simulation, TransportCheck& check) {
    for (const auto& hosted : simulation.machines) {
        hosted->machine.pass_or_tessellate.finished.bind(check);
        hosted->rasteriser.taken.bind(check);
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

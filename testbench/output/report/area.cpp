#include "testbench/output/report/area.h"

#include <algorithm>
#include <utility>

#include "modules/datapath/bilinear.h"
#include "modules/datapath/widths.h"
#include "modules/sockets/items.h"
#include "testbench/machine/totals.h"

namespace tessera {
namespace {

/// A unit's read for an item: its duration, and the bits of the item kept meanwhile.
struct Read {
    unsigned latency = 0;
    int bits = 0;
};

class AreaCounter {
  public:
    AreaCounter(const Design& design, const datapath::Registers& registers) : design_(design), registers_(registers) {}

    std::vector<UnitArea> count(std::size_t queue_places) {
        const Timing& t = design_.timing;
        const datapath::Formats& f = registers_.formats;
        using M = Multiplications;
        unit("get_triangle", 0,
             std::uint64_t{2} * t.get_triangle.buffer * bits<datapath::Triangle>() + bits<TakenTriangle>());
        stage<GeometryOperands, BasePoint>("calculate_new_p", t.calculate_new_p);
        stage<BasePoint, DisplacedPoint>(
            "displace_vertex", t.displace_vertex,
            (f.families ? M::bump + 3 * interpolate() : M::normalise) + M::displace + interpolate(), 1,
            {displace_vertex_latency(design_),
             entries() * (f.displacement.bits + (f.families ? 3 * f.normal.bits : 0))});
        stage<DisplacedPoint, ScreenPoint>("transform", t.transform, M::transform + M::transform_normal,
                                           design_.transform_pipelines);
        edge_tests();
        if (design_.work == Work::triangle)
            joining_triangles();
        else
            joining_families();
        unit("triangle_queue", 0, t.triangle_queue.buffer * bits<datapath::Triangle>());
        areas_.back().memory_bits = queue_places * bits<datapath::Triangle>();
        stage<TriangleToLight, LitTriangle>("lighting", t.lighting, 3 * M::light);
        const auto addresses = static_cast<std::uint64_t>(entries());
        const HeightTestKind& height = kind_of(f.height_test);
        table("displacement_map", registers_.displacement_map, f.displacement.bits, t.displacement_map, addresses);
        if (displacement_map_has_two_sides(design_, f))
            table("displacement_map_for_tests", registers_.displacement_map, 0, t.displacement_map, height.codes);
        table("normal_map", registers_.normal_map, 3 * f.normal.bits, t.normal_map, addresses);
        table(height.table, registers_.height_table, datapath::height_entry_bits(f), t.*height.table_timing,
              height.rectangles ? corners_of_a_rectangle() : 1);
        return std::move(areas_);
    }

  private:
    template <class Item>
    std::uint64_t bits() const {
        return item_bits<Item>(registers_.formats, static_cast<int>(tag_));
    }

    void unit(const char* name, std::uint64_t multipliers, std::uint64_t register_bits, unsigned copies = 1) {
        areas_.push_back({name, copies * multipliers, copies * register_bits, 0, 0});
    }

    /// An input buffer, and pipeline registers of the wider of the items in and out. A unit with an initiation interval
    /// above one reuses its multipliers for an item.
    template <class In, class Out>
    void stage(const char* name, const UnitTiming& timing, unsigned multiplications = 0, unsigned servers = 1,
               Read read = {}, unsigned copies = 1) {
        const std::uint64_t in = bits<In>(), out = bits<Out>();
        const unsigned multipliers = servers * ((multiplications + timing.interval - 1) / timing.interval);
        unit(name, multipliers,
             timing.buffer * in + register_stages(timing, servers, read.latency) *
                                      (std::max(in, out) + static_cast<std::uint64_t>(read.bits)),
             copies);
    }

    /// Entries of a map read for a vertex or edge.
    int entries() const { return static_cast<int>(datapath::map_entry_count(registers_.formats)); }
    /// Multiplications for one interpolated value.
    unsigned interpolate() const { return entries() == 1 ? 0 : Multiplications::interpolate; }

    unsigned culling() const { return registers_.back_face_culling ? Multiplications::faces_away : 0; }

    void joining_triangles() {
        const UnitTiming& join = design_.timing.pass_or_tessellate;
        unit("pass_or_tessellate", culling(),
             triangles_ahead_of_parts(design_) * bits<TakenTriangle>() + bits<ScreenPoint>() +
                 std::uint64_t{3} * join.buffer * bits<TestedEdge>() +
                 (join.buffer + register_stages(join)) * (tag_ + bits<DecidedTriangle>()));
        unit("tessellation", 0, (design_.timing.tessellation.buffer + 1) * bits<DecidedTriangle>());
    }

    /// Tessellation joins one triangle and sends another; each place of Pass or Tessellate holds nine edges.
    void joining_families() {
        const UnitTiming& collect = design_.timing.pass_or_tessellate;
        constexpr std::uint64_t midpoints = 3, most_edges = 9;
        unit("pass_or_tessellate", culling(),
             bits<Family>() + design_.edge_lanes * bits<TestedEdge>() +
                 collect.buffer * (bits<Family>() + most_edges * bits<TestedEdge>()) +
                 register_stages(collect) * (bits<TriangleToLight>() + bits<datapath::Triangle>()));
        unit("tessellation", 0,
             (triangles_ahead_of_parts(design_) + 1) * bits<TakenTriangle>() +
                 (design_.timing.tessellation.buffer + midpoints) * bits<ScreenPoint>() + bits<Family>() +
                 design_.edge_lanes * bits<TestOperands>());
    }

    unsigned height_test_multiplications() const {
        const bool area = registers_.tests.summed_height_unit == datapath::SummedHeightUnit::area;
        switch (registers_.formats.height_test) {
            case datapath::HeightTest::summed_height: return area ? Multiplications::summed_height_limit : 0;
            case datapath::HeightTest::curvature: return Multiplications::curvature_measure;
            case datapath::HeightTest::rank:
            case datapath::HeightTest::mipmap: break;
        }
        return 0;
    }

    void edge_tests() {
        const Timing& t = design_.timing;
        const datapath::Formats& f = registers_.formats;
        const datapath::TestParameters& tests = registers_.tests;
        using M = Multiplications;
        const unsigned copies = design_.tests_units;
        const unsigned lanes = copies * design_.edge_lanes, normal_tests = copies * design_.normal_tests;
        const std::uint64_t corners = 3 * (1 + 3 * static_cast<std::uint64_t>(f.normal.bits)) + tag_;
        const int screen = 2 * f.screen.bits + (f.distances ? 2 : 1) * f.view_distance.bits + 1;
        const std::uint64_t screens = 3 + 3 * static_cast<std::uint64_t>(screen) + tag_;
        UnitTiming normal = t.normal_test;
        normal.latency += tests.highlight_test ? t.highlight_test_latency : 0;

        stage<TestOperands, TestOperands>("calculate_new_u", t.calculate_new_u, 0, 1, {0, 2 * f.texture.bits}, lanes);
        stage<TexCoordOperands, TexCoordResult>("tex_coord_test", t.tex_coord_test, 0, 1, {}, lanes);
        const HeightTestKind& height = kind_of(f.height_test);
        stage<HeightOperands, HeightResult>(
            height.unit, t.*height.unit_timing, height_test_multiplications(), 1,
            {height_test_latency(design_, f), static_cast<int>(height.requests) * datapath::height_entry_bits(f)},
            copies);
        stage<NormalOperands, NormalResult>(
            "normal_test", normal,
            2 * M::normalise + M::bump + 3 * interpolate() + (tests.highlight_test ? M::highlight_test : 0), 1,
            {t.read_latency(t.normal_map), entries() * 3 * f.normal.bits}, normal_tests);
        if (!f.families)
            areas_.back().register_bits += copies * corners;
        stage<ViewOperands, ViewResult>("view_test", t.view_test, 0, 1, {}, lanes);
        if (!f.families)
            areas_.back().register_bits +=
                copies * (bits<ScreenCorner>() + (t.pass_or_tessellate.buffer + 2) * screens);
        const std::uint64_t results =
            t.results_buffer * (bits<HeightResult>() + design_.normal_tests * bits<NormalResult>() +
                                design_.edge_lanes * (bits<TexCoordResult>() + bits<ViewResult>()));
        const std::uint64_t operands = bits<NormalOperands>() + bits<HeightOperands>();
        if (design_.test_order == TestOrder::parallel)
            unit("collect_tests", 0, results, copies);
        else
            unit("sequence_tests", 0,
                 results + std::uint64_t{design_.edge_lanes} * t.results_buffer * operands +
                     design_.normal_tests * bits<NormalOperands>() +
                     t.edges_in_sequence * (operands + bits<TestedEdge>()),
                 copies);
    }

    /// With repeat on one axis a rectangle may wrap and then reads six entries, with both nine.
    std::uint64_t corners_of_a_rectangle() const {
        const std::uint64_t across = registers_.map.address_u == datapath::AddressMode::repeat ? 3 : 2;
        const std::uint64_t along = registers_.map.address_v == datapath::AddressMode::repeat ? 3 : 2;
        return across * along;
    }

    /// addresses: per request. Waiting addresses, in the buffer or at the banks, are registers. entry_bits: 0 if the
    /// bits are counted elsewhere.
    void table(const char* name, const datapath::TableLayout& layout, int entry_bits, const MemoryTiming& timing,
               std::uint64_t addresses) {
        std::uint64_t entries = std::uint64_t{layout.rows} * layout.columns;
        if (timing.cache.bytes > 0)
            entries = std::max(timing.cache.bytes, timing.cache.line_bytes) / layout.entry_bytes;
        std::uint64_t address_bits = 1;
        while (std::uint64_t{layout.rows} * layout.columns >> address_bits != 0)
            ++address_bits;
        areas_.push_back({name, 0, (timing.buffer + timing.window) * addresses * address_bits,
                          entries * static_cast<std::uint64_t>(entry_bits),
                          std::uint64_t{timing.ports} * timing.banks});
    }

    const Design& design_;
    const datapath::Registers& registers_;
    const std::uint64_t tag_ = static_cast<std::uint64_t>(tag_bits(design_));
    std::vector<UnitArea> areas_;
};

}  // namespace

std::vector<UnitArea> design_area(const Design& design, const datapath::Registers& registers,
                                  std::size_t queue_places) {
    return AreaCounter(design, registers).count(queue_places);
}

std::vector<UnitArea> area_of(const Simulation& simulation) {
    const std::size_t places = simulation.setup.design.queue.capacity;
    std::vector<UnitArea> units = design_area(simulation.setup.design, simulation.setup.registers,
                                              places == 0 ? Totals(simulation).most_queued : places);
    for (UnitArea& unit : units) {
        unit.multipliers *= simulation.setup.machines;
        unit.register_bits *= simulation.setup.machines;
        unit.memory_bits *= simulation.setup.machines;
        unit.ports *= simulation.setup.machines;
    }
    return units;
}

UnitArea total_area(const std::vector<UnitArea>& units) {
    UnitArea total{"total"};
    for (const UnitArea& unit : units) {
        total.multipliers += unit.multipliers;
        total.register_bits += unit.register_bits;
        total.memory_bits += unit.memory_bits;
        total.ports += unit.ports;
    }
    return total;
}

}  // namespace tessera

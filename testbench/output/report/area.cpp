#include "testbench/output/report/area.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "modules/datapath/bilinear.h"
#include "modules/datapath/bump.h"
#include "modules/datapath/cull.h"
#include "modules/datapath/curvature.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/light.h"
#include "modules/datapath/normalise.h"
#include "modules/datapath/reciprocal.h"
#include "modules/datapath/transform.h"
#include "modules/datapath/widths.h"
#include "modules/memories/line_cache.h"
#include "modules/sockets/items.h"

namespace tessera {
namespace {

using List = Multiplications::List;

List times(unsigned count, int a, int b) {
    return List(count, {std::max(a, b), std::min(a, b)});
}

List all_of(std::initializer_list<List> lists) {
    List all;
    for (const List& list : lists)
        all.insert(all.end(), list.begin(), list.end());
    return all;
}

/// A unit's read for an item: its duration, and the bits of the item kept meanwhile.
struct Read {
    unsigned latency = 0;
    int bits = 0;
};

class AreaCounter {
  public:
    AreaCounter(const Design& design, const datapath::Registers& registers) : design_(design), registers_(registers) {}

    std::vector<UnitArea> count() {
        const Timing& t = design_.timing;
        const datapath::Formats& f = registers_.formats;
        const Multiplications m{f};
        unit("get_triangle",
             std::uint64_t{2} * t.get_triangle.buffer * bits<datapath::Triangle>() + bits<TakenTriangle>());
        stage<GeometryOperands, BasePoint>("calculate_new_p", t.calculate_new_p);
        stage<BasePoint, DisplacedPoint>(
            "displace_vertex", t.displace_vertex,
            all_of({f.families ? all_of({m.bump(), interpolate(3)}) : m.normalise(f.normal.bits), m.displace(),
                    interpolate(1)}),
            1,
            {displace_vertex_latency(design_),
             entries() * (f.displacement.bits + (f.families ? 3 * f.normal.bits : 0))});
        stage<DisplacedPoint, ScreenPoint>("transform", t.transform, all_of({m.transform(), m.transform_normal()}),
                                           design_.transform_pipelines);
        edge_tests();
        if (design_.work == Work::triangle)
            joining_triangles();
        else
            joining_families();
        unit("triangle_queue", t.triangle_queue.buffer * bits<datapath::Triangle>());
        areas_.back().memory_bits = design_.queue.capacity * bits<datapath::Triangle>();
        stage<TriangleToLight, LitTriangle>("lighting", t.lighting, all_of({m.light(), m.light(), m.light()}));
        const auto addresses = static_cast<std::uint64_t>(entries());
        const HeightTestKind& height = kind_of(f.height_test);
        table("displacement_map", registers_.displacement_map, f.displacement.bits, t.displacement_map, addresses);
        if (displacement_map_has_two_sides(design_, f))
            table("displacement_map_for_tests", registers_.displacement_map, f.displacement.bits, t.displacement_map,
                  height.codes);
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

    void unit(const char* name, std::uint64_t register_bits, unsigned copies = 1) {
        areas_.push_back({name, {}, copies * register_bits, 0, 0});
    }

    /// An interval above one reuses a multiplier for as many multiplications, the widest of which it fits.
    void multipliers(List multiplications, unsigned interval, unsigned copies) {
        std::sort(multiplications.begin(), multiplications.end(), [](const OperandWidths& a, const OperandWidths& b) {
            return a.first * a.second > b.first * b.second;
        });
        for (std::size_t k = 0; k < multiplications.size(); k += interval)
            areas_.back().multipliers[multiplications[k]] += copies;
    }

    /// An input buffer, and pipeline registers of the wider of the items in and out.
    template <class In, class Out>
    void stage(const char* name, const UnitTiming& timing, const List& multiplications = {}, unsigned servers = 1,
               Read read = {}, unsigned copies = 1) {
        const std::uint64_t in = bits<In>(), out = bits<Out>();
        unit(name,
             timing.buffer * in + register_stages(timing, servers, read.latency) *
                                      (std::max(in, out) + static_cast<std::uint64_t>(read.bits)),
             copies);
        multipliers(multiplications, timing.interval, servers * copies);
    }

    /// Entries of a map read for a vertex or edge.
    int entries() const { return static_cast<int>(datapath::map_entry_count(registers_.formats)); }
    List interpolate(int values) const {
        List all;
        for (int k = 0; k < values && entries() > 1; ++k)
            all = all_of({all, Multiplications{registers_.formats}.interpolate()});
        return all;
    }

    void culling() {
        if (registers_.back_face_culling)
            multipliers(Multiplications{registers_.formats}.faces_away(), 1, 1);
    }

    void joining_triangles() {
        const UnitTiming& join = design_.timing.pass_or_tessellate;
        unit("pass_or_tessellate", triangles_ahead_of_parts(design_) * bits<TakenTriangle>() + bits<ScreenPoint>() +
                                       std::uint64_t{3} * join.buffer * bits<TestedEdge>() +
                                       (join.buffer + register_stages(join)) * (tag_ + bits<DecidedTriangle>()));
        culling();
        unit("tessellation", (design_.timing.tessellation.buffer + 1) * bits<DecidedTriangle>());
    }

    /// Tessellation joins one triangle and sends another; each place of Pass or Tessellate holds nine edges.
    void joining_families() {
        const UnitTiming& collect = design_.timing.pass_or_tessellate;
        constexpr std::uint64_t midpoints = 3, most_edges = 9;
        unit("pass_or_tessellate",
             bits<Family>() + design_.edge_lanes * bits<TestedEdge>() +
                 collect.buffer * (bits<Family>() + most_edges * bits<TestedEdge>()) +
                 register_stages(collect) * (bits<TriangleToLight>() + bits<datapath::Triangle>()));
        culling();
        unit("tessellation", (triangles_ahead_of_parts(design_) + 1) * bits<TakenTriangle>() +
                                 (design_.timing.tessellation.buffer + midpoints) * bits<ScreenPoint>() +
                                 bits<Family>() + design_.edge_lanes * bits<TestOperands>());
    }

    List height_test_multiplications() const {
        const Multiplications m{registers_.formats};
        switch (registers_.formats.height_test) {
            case datapath::HeightTest::summed_height:
                return registers_.tests.summed_height_unit == datapath::SummedHeightUnit::area ? m.summed_height_limit()
                                                                                               : List{};
            case datapath::HeightTest::curvature: return m.curvature_measure();
            case datapath::HeightTest::rank:
            case datapath::HeightTest::mipmap: break;
        }
        return {};
    }

    void edge_tests() {
        const Timing& t = design_.timing;
        const datapath::Formats& f = registers_.formats;
        const datapath::TestParameters& tests = registers_.tests;
        const Multiplications m{f};
        const unsigned copies = design_.tests_units;
        const unsigned lanes = copies * design_.edge_lanes, normal_tests = copies * design_.normal_tests;
        const std::uint64_t corners = 3 * (1 + 3 * static_cast<std::uint64_t>(f.normal.bits)) + tag_;
        const int screen = 2 * f.screen.bits + (f.distances ? 2 : 1) * f.view_distance.bits + 1;
        const std::uint64_t screens = 3 + 3 * static_cast<std::uint64_t>(screen) + tag_;
        UnitTiming normal = t.normal_test;
        normal.latency += tests.highlight_test ? t.highlight_test_latency : 0;

        stage<TestOperands, TestOperands>("calculate_new_u", t.calculate_new_u, {}, 1, {0, 2 * f.texture.bits}, lanes);
        stage<TexCoordOperands, TexCoordResult>("tex_coord_test", t.tex_coord_test, {}, 1, {}, lanes);
        const HeightTestKind& height = kind_of(f.height_test);
        stage<HeightOperands, HeightResult>(
            height.unit, t.*height.unit_timing, height_test_multiplications(), 1,
            {height_test_latency(design_, f), static_cast<int>(height.requests) * datapath::height_entry_bits(f)},
            copies);
        stage<NormalOperands, NormalResult>(
            "normal_test", normal,
            all_of({m.normalise(f.normal.bits), m.normalise(f.normal.bits), m.bump(), interpolate(3),
                    tests.highlight_test ? m.highlight_test() : List{}}),
            1, {t.read_latency(t.normal_map), entries() * 3 * f.normal.bits}, normal_tests);
        if (!f.families)
            areas_.back().register_bits += copies * corners;
        stage<ViewOperands, ViewResult>("view_test", t.view_test, {}, 1, {}, lanes);
        if (!f.families)
            areas_.back().register_bits +=
                copies * (bits<ScreenCorner>() + (t.pass_or_tessellate.buffer + 2) * screens);
        const std::uint64_t results =
            t.results_buffer * (bits<HeightResult>() + design_.normal_tests * bits<NormalResult>() +
                                design_.edge_lanes * (bits<TexCoordResult>() + bits<ViewResult>()));
        const std::uint64_t operands = bits<NormalOperands>() + bits<HeightOperands>();
        if (design_.test_order == TestOrder::parallel)
            unit("collect_tests", results, copies);
        else
            unit("sequence_tests",
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

    /// addresses: per request. Waiting addresses, in the buffer or at the banks, are registers.
    void table(const char* name, const datapath::TableLayout& layout, int entry_bits, const MemoryTiming& timing,
               std::uint64_t addresses) {
        const std::uint64_t all = std::uint64_t{layout.rows} * layout.columns;
        std::uint64_t entries = all;
        if (timing.cache.bytes > 0)
            entries = CacheShape(timing.cache, layout).bytes() / layout.entry_bytes;
        std::uint64_t address_bits = 1;
        while (std::uint64_t{1} << address_bits < all)
            ++address_bits;
        areas_.push_back({name,
                          {},
                          (timing.buffer + timing.window) * addresses * address_bits,
                          timing.ports * entries * static_cast<std::uint64_t>(entry_bits),
                          std::uint64_t{timing.ports} * timing.banks});
    }

    const Design& design_;
    const datapath::Registers& registers_;
    const std::uint64_t tag_ = static_cast<std::uint64_t>(tag_bits(design_));
    std::vector<UnitArea> areas_;
};

}  // namespace

List Multiplications::normalise(int component_bits) const {
    const datapath::ReciprocalRootWidths w{f};
    const int square = w.square.bits - 32, correction = 32;
    return all_of({times(3, component_bits, component_bits), times(2, w.root.bits, w.root.bits),
                   times(2, w.mantissa.bits, square), times(2, w.root.bits, correction),
                   times(3, w.root.bits, component_bits)});
}

List Multiplications::bump() const {
    const datapath::BumpWidths w{f};
    const int n = f.normal.bits;
    return all_of({times(6, n, n), times(6, n, n), times(3, n, w.bitangent.bits), normalise(w.combined.bits)});
}

List Multiplications::displace() const {
    const datapath::DisplaceWidths w{f};
    return all_of({times(1, f.position.bits, f.displacement.bits + datapath::code_fraction(f)),
                   times(3, w.height.bits, f.normal.bits)});
}

List Multiplications::transform() const {
    const datapath::TransformWidths w{f};
    const datapath::ReciprocalWidths r{f};
    return all_of({times(9, datapath::matrix_entry_bits, f.position.bits), times(2, r.mantissa.bits, r.reciprocal.bits),
                   times(2, r.reciprocal.bits, r.correction.bits), times(2, w.numerator.bits, w.inverse.bits)});
}

List Multiplications::transform_normal() const {
    return times(9, f.normal.bits, f.normal.bits);
}

List Multiplications::light() const {
    constexpr int ambient = 9;
    return all_of({times(3, f.normal.bits, f.normal.bits), times(1, datapath::LightWidths{f}.cosine.bits, ambient)});
}

List Multiplications::faces_away() const {
    const int difference = datapath::CullWidths{f}.difference.bits;
    return times(2, difference, difference);
}

List Multiplications::summed_height_limit() const {
    const datapath::RectangleWidths r{f};
    constexpr int threshold = 19;  // at most 2^18, datapath::summed_height_threshold_bits
    return all_of({times(1, r.width.bits, r.height.bits), times(1, threshold, datapath::EdgeTestWidths{f}.area.bits)});
}

List Multiplications::curvature_measure() const {
    const datapath::CurvatureWidths w{f};
    constexpr int coefficient = 8;
    return all_of({times(3, w.step.bits, w.step.bits), times(3, coefficient, w.product.bits)});
}

List Multiplications::highlight_test() const {
    return times(9, f.normal.bits, f.normal.bits);
}

List Multiplications::interpolate() const {
    const datapath::BilinearWidths w{f};
    const int weight = datapath::weight_bits(f);
    return all_of({times(2, w.columns.bits, weight), times(1, w.rows.bits, weight)});
}

std::uint64_t UnitArea::multiplier_count() const {
    std::uint64_t count = 0;
    for (const auto& [widths, of_these] : multipliers)
        count += of_these;
    return count;
}

std::uint64_t UnitArea::partial_product_bits() const {
    std::uint64_t bits = 0;
    for (const auto& [widths, of_these] : multipliers)
        bits += of_these * static_cast<std::uint64_t>(widths.first) * static_cast<std::uint64_t>(widths.second);
    return bits;
}

std::vector<UnitArea> design_area(const Design& design, const datapath::Registers& registers) {
    return AreaCounter(design, registers).count();
}

std::vector<UnitArea> area_of(const Simulation& simulation) {
    std::vector<UnitArea> units = design_area(simulation.setup.design, simulation.setup.registers);
    for (UnitArea& unit : units) {
        for (auto& [widths, of_these] : unit.multipliers)
            of_these *= simulation.setup.machines;
        unit.register_bits *= simulation.setup.machines;
        unit.memory_bits *= simulation.setup.machines;
        unit.ports *= simulation.setup.machines;
    }
    return units;
}

UnitArea total_area(const std::vector<UnitArea>& units) {
    UnitArea total{"total"};
    for (const UnitArea& unit : units) {
        for (const auto& [widths, of_these] : unit.multipliers)
            total.multipliers[widths] += of_these;
        total.register_bits += unit.register_bits;
        total.memory_bits += unit.memory_bits;
        total.ports += unit.ports;
    }
    return total;
}

}  // namespace tessera

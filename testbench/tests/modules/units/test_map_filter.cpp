#include <catch2/catch.hpp>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "modules/datapath/bilinear.h"
#include "modules/datapath/bump.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/midpoint.h"
#include "modules/memories/table_memory.h"
#include "modules/units/displace_vertex.h"
#include "modules/units/edge_tests/normal.h"
#include "testbench/common/random.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/timed_modules.h"

// Displace Vertex and the Normal Test with a bilinear filter, alone, through their sockets: each result follows from
// the map, whenever its entries arrive.

using namespace tessera;
using namespace tessera::testing;

namespace {

constexpr unsigned items = 60;

struct Row {
    std::string name;
    bool families = false;
    datapath::AddressMode mode = datapath::AddressMode::clamp;
    MemoryTiming memory;
    StallParameters stalls;
};

datapath::Registers registers_of(const Row& row) {
    datapath::Registers registers;
    registers.formats.filter = datapath::MapFilter::bilinear;
    registers.formats.families = row.families;
    registers.formats.codes = true;
    registers.map = {5, 3, row.mode, row.mode};
    registers.displacement_map = {0x1000, 5, 3, 2};
    registers.normal_map = {0x2000, 5, 3, 6};
    registers.displacement = {3 << 16, -7};
    return registers;
}

Design design_of(const Row& row) {
    Design design;
    design.work = row.families ? Work::family : Work::triangle;
    design.timing.displacement_map = design.timing.normal_map = row.memory;
    design.timing.stalls = row.stalls;
    return design;
}

/// Calls a function after the modules are connected, before the first cycle.
struct AtStart : sc_core::sc_module {
    std::function<void()> run;
    explicit AtStart(const sc_core::sc_module_name& name) : sc_module(name) {}
    void start_of_simulation() override { run(); }
};

/// The maps as arrays, and the data from which a unit is built.
struct Bench {
    datapath::Registers registers;
    Design design;
    CycleScheduler clock{"clock", sc_core::sc_time(10, sc_core::SC_PS)};
    UnitContext context{clock, registers, design};
    Random random{12};
    std::vector<std::uint64_t> codes, normals;

    explicit Bench(const Row& row) : registers(registers_of(row)), design(design_of(row)) {
        for (unsigned texel = 0; texel < 15; ++texel) {
            codes.push_back(random.natural(0, 65535));
            normals.push_back(datapath::pack_normal(direction(), 16));
        }
    }

    datapath::Direction direction() {
        datapath::Saturations unused;
        const auto component = [&] { return random.integer32(-999, 999); };
        return normalise(datapath::Direction{component(), component(), component()}, registers.formats, unused);
    }
    datapath::TexCoord coordinate() {
        return {random.chance(20) ? 5u << 12 : random.natural(0, 5 << 12),
                random.chance(20) ? 0 : random.natural(0, 3 << 12)};
    }
    template <class Memory>
    std::unique_ptr<Memory> memory(const char* name, const datapath::TableLayout& table, const MemoryTiming& timing,
                                   MemoryPort& port) {
        auto made = std::make_unique<Memory>(name, clock, table, timing, design.timing.stalls);
        clock.attach(*made);
        port.bind(*made);
        return made;
    }
    /// The entries around t, found by texel position instead of address.
    std::vector<std::uint64_t> around(const datapath::TexCoord& t, const std::vector<std::uint64_t>& map) const {
        std::vector<std::uint64_t> entries;
        const auto inside = [&](std::int64_t index, std::int64_t size) {
            return registers.map.address_u == datapath::AddressMode::repeat
                       ? (index + size) % size
                       : std::min(std::max<std::int64_t>(index, 0), size - 1);
        };
        for (const std::int64_t up : {0, 1})
            for (const std::int64_t right : {0, 1})
                entries.push_back(
                    map[static_cast<std::size_t>(5 * inside((std::int64_t{t.v} + 2048) / 4096 - 1 + up, 3) +
                                                 inside((std::int64_t{t.u} + 2048) / 4096 - 1 + right, 5))]);
        return entries;
    }
    datapath::Direction normal_at(const datapath::TexCoord& t) const {
        return datapath::map_normal(t, around(t, normals).data(), registers.formats);
    }
};

const std::initializer_list<Row> rows{
    {"one port", false, datapath::AddressMode::clamp, {}, {}},
    {"four banks, latency 20", false, datapath::AddressMode::repeat, {1, 4, 20}, {}},
    {"random stalls", false, datapath::AddressMode::repeat, {1, 1, 3}, {3, 400, 9}},
    {"with families, two ports", true, datapath::AddressMode::clamp, {2}, {}},
    {"with families, random stalls", true, datapath::AddressMode::repeat, {2, 2, 5}, {4, 300, 20}}};

const CaseTable displaced("a bilinear filter in Displace Vertex, ", rows, [](const Row& row) {
    Bench bench(row);
    DisplaceVertex unit("unit", bench.context);
    Sink<DisplacedPoint> sink("sink", bench.clock, bench.design.timing.stalls);
    Driver<BasePoint> driver("driver", bench.clock, bench.design.timing.stalls);
    bench.clock.attach(unit);
    const auto map = bench.memory<DisplacementMap>("displacement_map", bench.registers.displacement_map, row.memory,
                                                   unit.displacement_map);
    std::unique_ptr<NormalMap> normals;
    if (row.families)
        normals = bench.memory<NormalMap>("normal_map", bench.registers.normal_map, row.memory, *unit.normal_map);
    unit.to_transform.bind(sink.in);
    driver.out.bind(unit.from_calculate_new_p);
    for (unsigned k = 0; k < items; ++k) {
        BasePoint point;
        point.tag.part = static_cast<std::uint8_t>(k % 3 + (k % 2 == 0 ? 0 : first_edge_part));
        point.p = {bench.random.integer32(-1000, 1000), 5, bench.random.integer32(-1000, 1000)};
        point.n = bench.direction();
        point.displaced_n = bench.direction();
        point.t = bench.coordinate();
        driver.items.push_back(point);
    }
    AtStart fill("fill");
    fill.run = [&] {
        fill_table(unit.displacement_map, bench.registers.displacement_map, bench.codes);
        if (row.families)
            fill_table(*unit.normal_map, bench.registers.normal_map, bench.normals);
    };
    sc_core::sc_start();

    REQUIRE(sink.items.size() == items);
    datapath::Saturations unused;
    const datapath::Formats& formats = bench.registers.formats;
    unsigned vertices = 0;
    for (unsigned k = 0; k < items; ++k) {
        const BasePoint& in = driver.items[k];
        const DisplacedPoint& out = sink.items[k];
        INFO("item " << k);
        const bool edge = in.tag.is_edge();
        vertices += edge ? 0 : 1;
        const datapath::Direction n = edge && !row.families ? normalise(in.n, formats, unused) : in.n;
        const auto entries = bench.around(in.t, bench.codes);
        CHECK(out.displaced == displace(in.p, n, datapath::map_code(in.t, entries.data(), formats),
                                        bench.registers.displacement, formats, unused));
        const bool last = in.t.u == 5u << 12;
        const std::uint32_t column = last ? (row.mode == datapath::AddressMode::clamp ? 4 : 0) : in.t.u >> 12;
        const std::uint32_t up = in.t.v == 3u << 12 ? (row.mode == datapath::AddressMode::clamp ? 2 : 0) : in.t.v >> 12;
        CHECK(out.code == bench.codes[5 * up + column]);
        if (row.families)  // other designs have no such field on the stream
            CHECK(out.displaced_n ==
                  (edge ? in.displaced_n
                        : bump(in.n, in.displaced_n, in.handedness, bench.normal_at(in.t), formats, unused)));
    }
    CHECK(unit.displacement_map.reads() == 4 * items);
    CHECK(unit.displacement_map.requests() == items);
    CHECK(map->transactions() == 4 * items);
    CHECK((!normals || normals->transactions() == 4 * vertices));
    if (row.name == "one port") {
        // Taken in cycle 0, addresses in 0 to 3, data in 4, out 6 later; the next four cycles later.
        CHECK(sink.cycles[0] == 3 + 1 + 6);
        CHECK(sink.cycles[items - 1] == sink.cycles[0] + 4 * (items - 1));
    }
});

const CaseTable tested("a bilinear filter in the Normal Test, ", rows, [](const Row& row) {
    Bench bench(row);
    bench.registers.tests.normal_threshold = 4000;
    NormalTest unit("unit", bench.context);
    Sink<NormalResult> sink("sink", bench.clock, bench.design.timing.stalls);
    Driver<NormalOperands> driver("driver", bench.clock, bench.design.timing.stalls);
    bench.clock.attach(unit);
    const auto map = bench.memory<NormalMap>("normal_map", bench.registers.normal_map, row.memory, unit.normal_map);
    unit.output.bind(sink.in);
    driver.out.bind(unit.input);
    for (unsigned k = 0; k < items; ++k) {
        NormalOperands edge;
        edge.tag.part = static_cast<std::uint8_t>(first_edge_part + k % 3);
        for (datapath::Direction* n :
             {&edge.n_i, &edge.n_j, &edge.tangent_i, &edge.tangent_j, &edge.displaced_n_i, &edge.displaced_n_j})
            *n = bench.direction();
        edge.t = bench.coordinate();
        driver.items.push_back(edge);
    }
    AtStart fill("fill");
    fill.run = [&] { fill_table(unit.normal_map, bench.registers.normal_map, bench.normals); };
    sc_core::sc_start();

    REQUIRE(sink.items.size() == items);
    datapath::Saturations unused;
    const datapath::Formats& formats = bench.registers.formats;
    for (unsigned k = 0; k < items; ++k) {
        const NormalOperands& in = driver.items[k];
        INFO("item " << k);
        const datapath::Direction n = normalise(midpoint(in.n_i, in.n_j), formats, unused);
        const datapath::Direction tangent = normalise(midpoint(in.tangent_i, in.tangent_j), formats, unused);
        CHECK(sink.items[k].displaced_n == bump(n, tangent, 1, bench.normal_at(in.t), formats, unused));
    }
    CHECK(unit.normal_map.reads() == 4 * items);
    CHECK(unit.normal_map.requests() == items);
    if (row.name == "one port") {
        CHECK(sink.cycles[0] == 3 + 1 + 9);
        CHECK(sink.cycles[items - 1] == sink.cycles[0] + 4 * (items - 1));
    }
});

}  // namespace

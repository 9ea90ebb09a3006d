#include <catch2/catch.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "modules/datapath/height_tests.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/table_shapes.h"
#include "modules/memories/table_memory.h"
#include "modules/units/edge_tests/height_test.h"
#include "testbench/common/random.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/timed_modules.h"

// The Curvature Test alone, through its sockets: each result follows from the tables, whenever their entries arrive.

using namespace tessera;
using namespace tessera::testing;

namespace {

constexpr unsigned items = 200;

struct Row {
    std::string name;
    datapath::AddressMode mode = datapath::AddressMode::clamp;
    MemoryTiming memory;
    StallParameters stalls;
    bool on = true;
};

datapath::Registers registers_of(const Row& row) {
    datapath::Registers registers;
    registers.formats.height_test = datapath::number_of<datapath::CurvatureTest>();
    registers.map = {21, 13, row.mode, row.mode};
    registers.covered = {33, 17};
    registers.displacement_map.base = 0x1000;
    registers.height_table.base = 0x2000;
    registers.tests.summed_height_test = row.on;
    registers.tests.height_thresholds[0] = 30000;
    shape_tables(registers);
    return registers;
}

/// Fills its memories after the modules are connected, before the first cycle.
struct Bench : sc_core::sc_module {
    datapath::Registers registers;
    Design design;
    CycleScheduler clock{"clock", sc_core::sc_time(10, sc_core::SC_PS)};
    UnitContext context{clock, registers, design};
    Random random{5};
    std::vector<std::uint64_t> codes, cells;
    std::unique_ptr<HeightTestUnit> unit;
    std::unique_ptr<TableMemory> map, table;

    explicit Bench(const Row& row) : sc_module(sc_core::sc_module_name("bench")), registers(registers_of(row)) {
        design.timing.displacement_map = design.timing.height_table = row.memory;
        design.timing.stalls = row.stalls;
        for (unsigned texel = 0; texel < 21 * 13; ++texel)
            codes.push_back(random.natural(0, 65535));
        for (std::uint32_t cell = 0; cell < registers.height_table.columns; ++cell)
            cells.push_back(std::uint64_t{random.natural(0, 262143)} << 18 | random.natural(0, 262143));
        unit = std::make_unique<HeightTestUnit>("unit", context);
        clock.attach(*unit);
        map = std::make_unique<DisplacementMap>("displacement_map", clock, registers.displacement_map, row.memory,
                                                row.stalls);
        table = std::make_unique<TableMemory>("curvature_table", clock, registers.height_table, row.memory, row.stalls);
        for (TableMemory* memory : {map.get(), table.get()})
            clock.attach(*memory);
        unit->displacement_map->bind(*map);
        unit->table.bind(*table);
    }
    void start_of_simulation() override {
        fill_table(*unit->displacement_map, registers.displacement_map, codes);
        fill_table(unit->table, registers.height_table, cells);
    }

    datapath::TexCoord near(const datapath::TexCoord& t, std::uint32_t reach) {
        return {t.u + random.natural(0, reach), t.v + random.natural(0, reach)};
    }
    /// Short and long edges, with the first end anywhere.
    HeightOperands edge(unsigned number) {
        HeightOperands made;
        made.tag.part = static_cast<std::uint8_t>(first_edge_part + number % 3);
        const datapath::TexCoord corner{random.natural(0, 16 << 12), random.natural(0, 8 << 12)};
        made.t_i = near(corner, number % 2 == 0 ? 2 << 12 : 16 << 12);
        made.t_j = near(corner, number % 2 == 0 ? 2 << 12 : 16 << 12);
        made.t_ij = midpoint(made.t_i, made.t_j);
        return made;
    }
    std::uint64_t code_under(const datapath::TexCoord& t) const {
        const bool repeat = registers.map.address_u == datapath::AddressMode::repeat;
        const std::uint32_t x = t.u >> 12, y = t.v >> 12;
        return codes[std::size_t{repeat ? y % 13 : std::min(y, 12u)} * 21 + (repeat ? x % 21 : std::min(x, 20u))];
    }
    /// The formula of golden/ALGORITHM.md 4.8, in integers.
    bool expected(const HeightOperands& e) const {
        const auto difference = [](std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; };
        const std::uint32_t du = difference(e.t_i.u, e.t_j.u), dv = difference(e.t_i.v, e.t_j.v);
        int level = 1;
        while (std::max(du, dv) > 4096u << level)
            ++level;
        if (level == 1) {
            const auto code = [&](const datapath::TexCoord& t) { return static_cast<std::int64_t>(code_under(t)); };
            return 8 * std::abs(2 * code(e.t_ij) - code(e.t_i) - code(e.t_j)) > 30000;
        }
        const datapath::CurvatureEntry entry = datapath::unpack_curvature(
            cells[(datapath::curvature_address(e.t_ij, level, 0, covered_texels(registers), registers.formats)) / 5]);
        const auto u = static_cast<std::int64_t>(8 * std::uint64_t{du} >> (12 + level)),
                   v = static_cast<std::int64_t>(8 * std::uint64_t{dv} >> (12 + level));
        const bool falls = (e.t_i.u < e.t_j.u) != (e.t_i.v < e.t_j.v);
        const std::int64_t bend =
            std::abs(entry.xx * u * u + (falls ? -entry.xy : entry.xy) * u * v + entry.yy * v * v) / 64;
        const std::int64_t rest = entry.rest;
        return (std::max(bend, rest) + std::min(bend, rest) / 2) << (entry.exponent + level) > 30000;
    }
};

const CaseTable decided("a Curvature Test through its sockets, ",
                        {
                            Row{"one port", datapath::AddressMode::clamp, {}, {}},
                            {"four banks, latency 20", datapath::AddressMode::repeat, {1, 4, 20}, {}},
                            {"random stalls", datapath::AddressMode::repeat, {1, 1, 3}, {3, 400, 9}},
                            {"two ports, random stalls", datapath::AddressMode::clamp, {2, 2, 5}, {4, 300, 20}},
                            {"switched off", datapath::AddressMode::clamp, {}, {}, false},
                        },
                        [](const Row& row) {
                            Bench bench(row);
                            Sink<HeightResult> sink("sink", bench.clock, row.stalls);
                            Driver<HeightOperands> driver("driver", bench.clock, row.stalls);
                            bench.unit->output.bind(sink.in);
                            driver.out.bind(bench.unit->input);
                            unsigned by_codes = 0;
                            for (unsigned k = 0; k < items; ++k) {
                                driver.items.push_back(bench.edge(k));
                                const HeightOperands& edge = driver.items.back();
                                if (curvature_by_codes(edge.t_i, edge.t_j, bench.registers.formats))
                                    ++by_codes;
                            }
                            sc_core::sc_start();
                            REQUIRE(sink.items.size() == items);
                            REQUIRE(by_codes >= items / 2);
                            REQUIRE(by_codes < items);
                            unsigned splits = 0;
                            for (unsigned k = 0; k < items; ++k) {
                                INFO("item " << k);
                                CHECK(sink.items[k].tag.part == driver.items[k].tag.part);
                                CHECK(sink.items[k].summed_height == (row.on && bench.expected(driver.items[k])));
                                splits += sink.items[k].summed_height ? 1u : 0u;
                            }
                            CHECK((splits > items / 10) == row.on);
                            CHECK(bench.unit->displacement_map->reads() == (row.on ? 3 * by_codes : 0));
                            CHECK(bench.unit->displacement_map->requests() == (row.on ? by_codes : 0));
                            CHECK(bench.unit->table.reads() == (row.on ? items - by_codes : 0));
                        });

}  // namespace

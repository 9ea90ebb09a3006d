#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/map_entry.h"
#include "modules/memories/table_memory.h"
#include "modules/units/edge_tests/normal.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/timed_modules.h"

// The Normal Test unit alone, through its sockets, with and without a Highlight Test.

using namespace tessera;
using namespace tessera::testing;

namespace {

datapath::Registers registers_of(bool highlight_test) {
    datapath::Registers registers;
    registers.map = {4, 1, datapath::AddressMode::clamp, datapath::AddressMode::clamp};
    registers.normal_map = {4096, 4, 1, datapath::entry_bytes(3 * registers.formats.normal.bits)};
    registers.tests.normal_threshold = 9000;
    registers.tests.highlight_test = highlight_test;
    registers.formats.highlight_tag = highlight_test;
    registers.tests.half_vector = {9830, 0, 13107};  // (0.6, 0, 0.8)
    registers.tests.highlight_cosine = 255'000'000;  // 0.95
    registers.tests.highlight_normal_threshold = 2000;
    return registers;
}

constexpr datapath::Direction up{0, 0, 1 << 14};
constexpr datapath::Direction at_half{9830, 0, 13107};
constexpr datapath::Direction tilted{3000, 0, 16107};  // 3000 from up, 0.90 from H: outside

/// The unit, with its memory full of upright normals, and three edges whose midpoints therefore have N' = up: (at_half,
/// up): both tests; (up, tilted): neither, it lies outside; (tilted, at_half): both.
struct Bench {
    datapath::Registers registers;
    Design design;
    CycleScheduler clock{"clock", sc_core::sc_time(10, sc_core::SC_PS)};
    NormalMap memory;
    Sink<NormalResult> sink{"sink", clock};
    NormalTest unit;
    Driver<NormalOperands> driver{"driver", clock};
    std::vector<NormalOperands> edges;

    Bench(bool highlight_test, const Timing& timing)
        : registers(registers_of(highlight_test)),
          design(with(timing)),
          memory("memory", clock, registers.normal_map, timing.normal_map, timing.stalls),
          unit("unit", {clock, registers, design}) {
        clock.attach(memory);
        clock.attach(unit);
        unit.normal_map.bind(memory);
        unit.output.bind(sink.in);
        driver.out.bind(unit.input);
        const std::vector<datapath::Direction> ends{at_half, up, tilted};
        for (unsigned k = 0; k < 3; ++k) {
            NormalOperands edge;
            edge.tag.part = static_cast<std::uint8_t>(first_edge_part + k);
            edge.n_i = edge.n_j = up;
            edge.tangent_i = edge.tangent_j = {1 << 14, 0, 0};
            edge.displaced_n_i = ends[k];
            edge.displaced_n_j = ends[(k + 1) % 3];
            edge.t = {k << 12, 0};
            edges.push_back(edge);
        }
    }

    static Design with(const Timing& timing) {
        Design design;
        design.timing = timing;
        return design;
    }

    void fill_memory() {
        fill_table(unit.normal_map, registers.normal_map,
                   std::vector<std::uint64_t>(4, datapath::pack_normal(up, registers.formats.normal.bits)));
    }

    /// Timed mode: edges one after another; returns the cycles in which they leave.
    std::vector<std::uint64_t> run_timed() {
        sc_core::sc_start(sc_core::SC_ZERO_TIME);
        fill_memory();
        driver.items = edges;
        clock.wake(driver);
        sc_core::sc_start();
        REQUIRE(driver.offered.front() == 0);
        return sink.cycles;
    }

    std::vector<int> tests() const {
        std::vector<int> bits;
        for (const NormalResult& result : sink.items)
            bits.push_back((result.normal ? datapath::normal_bit : 0) |
                           (result.highlight ? datapath::highlight_bit : 0));
        return bits;
    }
};

struct Row {
    std::string name;
    bool highlight_test;
    unsigned latency;  ///< of the Highlight Test
    std::uint64_t cycle;
};

// Taken in cycle 0, read in 1, compared 9 later, or later by the Highlight Test's latency; another edge each cycle.
const CaseTable latencies(
    "Normal Test unit ",
    {
        Row{"without a Highlight Test, whose latency has no effect", false, 7, 10},
        {"with a Highlight Test of 0 cycles", true, 0, 10},
        {"with a Highlight Test of one cycle", true, 1, 11},
        {"with a Highlight Test of 7 cycles", true, 7, 17},
    },
    [](const Row& row) {
        Timing timing;
        timing.highlight_test_latency = row.latency;
        Bench bench(row.highlight_test, timing);
        CHECK(bench.run_timed() == std::vector<std::uint64_t>{row.cycle, row.cycle + 1, row.cycle + 2});
        const int asked = datapath::normal_bit | (row.highlight_test ? datapath::highlight_bit : 0);
        CHECK(bench.tests() == std::vector<int>{asked, 0, asked});
    });

}  // namespace

// Of a triangle only vertex 0 is new: its N' is `up`, that of the others as the edges carry it.
TEST_CASE("Normal Test unit: N' of a new vertex is its own, that of any other the edge's") {
    Bench bench(false, {});
    NormalOperands vertex = bench.edges[0];
    vertex.tag.part = 0;
    vertex.new_vertices = 1;
    vertex.displaced_n_i = vertex.displaced_n_j = tilted;  // not used
    for (NormalOperands& edge : bench.edges)
        edge.new_vertices = 1;
    bench.edges[0].displaced_n_i = tilted;  // replaced by `up`: (up, up)
    bench.edges[0].displaced_n_j = up;
    bench.edges[2].displaced_n_j = at_half;  // replaced by `up`: (tilted, up)
    bench.edges.insert(bench.edges.begin(), vertex);
    bench.run_timed();
    CHECK(bench.tests() == std::vector<int>{0, 0, 0});
}

TEST_CASE("Normal Test unit with a Highlight Test, blocking transport: the same bits, one more cycle") {
    Bench bench(true, {});
    bench.registers.tests.normal_threshold = 16384;  // so that only the Highlight Test can ask for a split
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    bench.fill_memory();
    for (NormalOperands& edge : bench.edges) {
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        bench.driver.out.transport(edge, delay);
        // one cycle for the read, then 9 and 1
        CHECK(bench.sink.delays.back() == 11 * bench.clock.period());
    }
    CHECK(bench.tests() == std::vector<int>{datapath::highlight_bit, 0, datapath::highlight_bit});
}

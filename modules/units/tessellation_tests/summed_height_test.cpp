#include "modules/units/tessellation_tests/summed_height_test.h"

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/rectangle.h"

namespace tessera {

SummedHeightTest::SummedHeightTest(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                                   const Timing& timing, bool use_direct_memory)
    : sc_module(name),
      summed_height_table("summed_height_table", registers.summed_height_table.entry_bytes,
                          use_direct_memory),
      registers_(registers),
      latency_(timing.cycle * timing.summed_height_test.latency) {
    input.register_b_transport(this, &SummedHeightTest::b_transport);
}

std::uint64_t SummedHeightTest::sum_around(const datapath::TexCoord& t, const datapath::RectangleSize& size,
                                           MemoryPort::Burst& table) const {
    return rectangle_sum(centred_rectangle(t, size, registers_.map, registers_.formats), registers_.map,
                         registers_.summed_height_table, registers_.formats,
                         [&](std::uint64_t address) { return table.read(address); });
}

void SummedHeightTest::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    delay += latency_;
    if (!registers_.tests.summed_height_test)
        return;
    MemoryPort::Burst table(summed_height_table, delay);
    for (int k = 0; k < 3; ++k) {
        const datapath::TexCoord& i = pass.edge_begin(k).texture;
        const datapath::TexCoord& j = pass.edge_end(k).texture;
        datapath::EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
        const datapath::RectangleSize size = rectangle_size(i, j, registers_.map, registers_.formats);
        const std::uint64_t sum_i = sum_around(i, size, table);
        const std::uint64_t sum_j = sum_around(j, size, table);
        const std::uint64_t sum_ij = sum_around(edge.texture, size, table);
        if (summed_height_test(sum_i, sum_j, sum_ij, size, registers_.tests))
            edge.tests |= datapath::summed_height_bit;
    }
}

}  // namespace tessera

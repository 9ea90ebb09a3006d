#include "modules/units/tessellation_tests/summed_height_test.h"

#include "modules/datapath/edge_tests.h"
#include "modules/unit/signals.h"

namespace tessera {

namespace {

/// Where rectangle k of an edge is centred: t_i, t_j, t_ij.
const datapath::TexCoord& centre(const Pass& pass, unsigned edge, unsigned k) {
    if (k == 2)
        return pass.edges[edge].texture;
    return k == 0 ? pass.edge_begin(static_cast<int>(edge)).texture
                  : pass.edge_end(static_cast<int>(edge)).texture;
}

}  // namespace

SummedHeightTest::SummedHeightTest(const sc_core::sc_module_name& name, Clock& clock,
                                   const datapath::Registers& registers, const Timing& timing,
                                   bool use_direct_memory)
    : TableStage(name, clock, timing.summed_height_test, timing.summed_height_table.latency),
      summed_height_table("summed_height_table", registers.summed_height_table.entry_bytes,
                          use_direct_memory),
      registers_(registers) {
    takes_from(input, timing.stalls);
    delivers_to(output);
    reads_through(summed_height_table, 3);
    input.serve<&SummedHeightTest::b_transport>(*this);
}

void SummedHeightTest::decide(Pass& pass, unsigned edge, const datapath::RectangleSize& size,
                              const std::array<std::uint64_t, 3>& sums) const {
    if (summed_height_test(sums[0], sums[1], sums[2], size, registers_.tests))
        pass.edges[edge].tests |= datapath::summed_height_bit;
}

void SummedHeightTest::b_transport(Work& work, sc_core::sc_time& delay) {
    delay += clock_.period() * timing_.latency;
    if (registers_.tests.summed_height_test) {
        Pass& pass = *work.pass;
        MemoryPort::Burst table(summed_height_table, delay);
        for_each_of_three(work.parts, first_edge_part, [&](unsigned edge) {
            const datapath::RectangleSize size = rectangle_size(centre(pass, edge, 0), centre(pass, edge, 1),
                                                                registers_.map, registers_.formats);
            std::array<std::uint64_t, 3> sums{};
            for (unsigned k = 0; k < 3; ++k)
                sums[k] = rectangle_sum(
                    centred_rectangle(centre(pass, edge, k), size, registers_.map, registers_.formats),
                    registers_.map, registers_.summed_height_table, registers_.formats,
                    [&](std::uint64_t address) { return table.read(address); });
            decide(pass, edge, size, sums);
        });
    }
    output->b_transport(work, delay);
}

unsigned SummedHeightTest::begin(SummedHeightItem& item) {
    if (!registers_.tests.summed_height_test)
        return 0;
    const Pass& pass = *item.work.pass;
    for_each_of_three(item.work.parts, first_edge_part, [&](unsigned edge) { item.edge = edge; });
    item.size = rectangle_size(centre(pass, item.edge, 0), centre(pass, item.edge, 1), registers_.map,
                               registers_.formats);
    return 3;
}

void SummedHeightTest::ask(SummedHeightItem& item, unsigned k) {
    const datapath::RectangleReads reads =
        rectangle_reads(centred_rectangle(centre(*item.work.pass, item.edge, k), item.size, registers_.map,
                                          registers_.formats),
                        registers_.map, registers_.summed_height_table);
    item.subtracted[k] = reads.subtracted;
    item.count[k] = static_cast<std::uint8_t>(reads.count);
    summed_height_table.request(reads.address.data(), reads.count);
}

void SummedHeightTest::receive(SummedHeightItem& item, unsigned k) {
    datapath::RectangleReads reads;
    reads.count = item.count[k];
    reads.subtracted = item.subtracted[k];
    item.sums[k] = rectangle_sum(reads, registers_.formats,
                                 [&](unsigned entry) { return summed_height_table.entry(entry); });
    if (k == 2)
        decide(*item.work.pass, item.edge, item.size, item.sums);
}

void SummedHeightTest::show(Signals& signals) const {
    TableStage::show(signals);
    signals.value("threshold", 64, registers_.tests.summed_height_threshold);
}

void SummedHeightTest::trace_item(Signals& signals, const SummedHeightItem& item) const {
    signals.edge_textures(item.work);
    signals.value("width", 16, item.size.width);
    signals.value("height", 16, item.size.height);
}

void SummedHeightTest::trace_answered(Signals& signals, const SummedHeightItem& item) const {
    signals.value("sum_i", 48, item.sums[0]);
    signals.value("sum_j", 48, item.sums[1]);
    signals.value("sum_ij", 48, item.sums[2]);
    signals.value("difference", 64,
                  datapath::summed_height_difference(item.sums[0], item.sums[1], item.sums[2]));
    signals.value("limit", 64, summed_height_limit(item.size, registers_.tests));
    const unsigned tests = Signals::pass_of(item.work).edges[item.edge].tests;
    signals.flag("summed_height", (tests & datapath::summed_height_bit) != 0);
}

}  // namespace tessera

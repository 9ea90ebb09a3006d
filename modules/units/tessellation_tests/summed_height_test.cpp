#include "modules/units/tessellation_tests/summed_height_test.h"

#include "modules/datapath/edge_tests.h"
#include "modules/unit/signals.h"

namespace tessera {

SummedHeightTest::SummedHeightTest(const sc_core::sc_module_name& name, Clock& clock,
                                   const datapath::Registers& registers, const Timing& timing,
                                   bool use_direct_memory)
    : Stage(name, clock, timing.summed_height_test, 1, timing.summed_height_table.latency),
      summed_height_table("summed_height_table", registers.summed_height_table.entry_bytes,
                          use_direct_memory),
      registers_(registers) {
    takes_from(input, timing.stalls);
    delivers_to(output);
    reads_through(summed_height_table, 3);
}

/// Of an edge's three rectangles.
datapath::RectangleSize SummedHeightTest::size(const Work& edge) const {
    return rectangle_size(Signals::begin_of(edge).texture, Signals::end_of(edge).texture, registers_.map,
                          registers_.formats);
}

/// The reads of one of them: around t_i, t_j, t_ij in this order.
datapath::RectangleReads SummedHeightTest::rectangle(const Work& edge, const datapath::RectangleSize& size,
                                                     unsigned number) const {
    const datapath::TexCoord& centre = number == 0   ? Signals::begin_of(edge).texture
                                       : number == 1 ? Signals::end_of(edge).texture
                                                     : edge.pass->edges[edge.index()].texture;
    return rectangle_reads(centred_rectangle(centre, size, registers_.map, registers_.formats),
                           registers_.map, registers_.summed_height_table);
}

void SummedHeightTest::reads(const Work& edge, Reads& reads) const {
    if (!registers_.tests.summed_height_test)
        return;
    const datapath::RectangleSize its_size = size(edge);
    for (unsigned k = 0; k < 3; ++k) {
        const datapath::RectangleReads its = rectangle(edge, its_size, k);
        reads.add(its.address.data(), its.count);
    }
}

Work SummedHeightTest::process(const Work& edge, const Entries& entries) {
    if (!registers_.tests.summed_height_test)
        return edge;
    const datapath::RectangleSize its_size = size(edge);
    unsigned next = 0;
    for (unsigned k = 0; k < 3; ++k)
        sums_[k] = rectangle_sum(rectangle(edge, its_size, k), registers_.formats,
                                 [&](unsigned) { return entries[next++]; });
    if (summed_height_test(sums_[0], sums_[1], sums_[2], its_size, registers_.tests))
        edge.pass->edges[edge.index()].tests |= datapath::summed_height_bit;
    return edge;
}

void SummedHeightTest::show(Signals& signals) const {
    Stage::show(signals);
    signals.value("threshold", 64, registers_.tests.summed_height_threshold);
}

void SummedHeightTest::trace_started(Signals& signals, const Work& edge) const {
    const datapath::RectangleSize its_size = size(edge);
    signals.edge_textures(edge);
    signals.value("width", 16, its_size.width);
    signals.value("height", 16, its_size.height);
}

void SummedHeightTest::trace_processed(Signals& signals, const Work& edge, const Work&) const {
    signals.value("sum_i", 48, sums_[0]);
    signals.value("sum_j", 48, sums_[1]);
    signals.value("sum_ij", 48, sums_[2]);
    signals.value("difference", 64, datapath::summed_height_difference(sums_[0], sums_[1], sums_[2]));
    signals.value("limit", 64, summed_height_limit(size(edge), registers_.tests));
    const unsigned tests = Signals::pass_of(edge).edges[edge.index()].tests;
    signals.flag("summed_height", (tests & datapath::summed_height_bit) != 0);
}

}  // namespace tessera

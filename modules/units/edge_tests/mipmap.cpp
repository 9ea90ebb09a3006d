#include "modules/units/edge_tests/mipmap.h"

#include "modules/stage/stage_steps.h"

namespace tessera {

void MipmapTest::reads(const HeightOperands& edge, Reads& reads) const {
    if (registers_.tests.summed_height_test)
        mipmap_reads(edge.t_i, edge.t_j, edge.t_ij, registers_, [&](std::uint64_t address) { reads.add(address); });
}

HeightResult MipmapTest::process(const HeightOperands& edge, const Entries& entries) {
    difference_ = registers_.tests.summed_height_test ? datapath::mipmap_difference(entries) : 0;
    return {edge.tag, registers_.tests.summed_height_test && mipmap_test(difference_, registers_.tests), 0};
}

void MipmapTest::trace_signals(Signals& signals) const {
    Stage::trace_signals(signals);
    signals.value("threshold", 17, registers_.tests.mipmap_threshold);
}

void MipmapTest::trace_processed(Signals& signals, const HeightOperands& edge, const HeightResult&) const {
    signals.value("level", 4,
                  static_cast<unsigned>(mipmap_level(edge.t_i, edge.t_j, registers_.map, registers_.formats)));
    signals.value("difference", 17, difference_);
}

}  // namespace tessera

#include "modules/units/edge_tests/rank.h"

#include "modules/stage/stage_steps.h"

namespace tessera {

bool RankTest::may_split(const HeightOperands& edge) const {
    return registers_.tests.summed_height_test && has_lattice_midpoint(edge.t_i, edge.t_j, registers_.formats);
}

void RankTest::reads(const HeightOperands& edge, Reads& reads) const {
    if (!may_split(edge))
        return;
    reads.add(rank_address(edge.t_ij, registers_.height_table, registers_.map, registers_.formats));
}

HeightResult RankTest::process(const HeightOperands& edge, const Entries& entries) {
    entry_ = may_split(edge) ? datapath::rank_entry(entries[0], registers_.formats) : datapath::RankEntry{};
    return {edge.tag, rank_test(entry_, registers_.tests), ordering_rank(entry_, registers_.formats)};
}

void RankTest::trace_signals(Signals& signals) const {
    Stage::trace_signals(signals);
    signals.value("rank_threshold", 16, registers_.tests.rank_threshold);
    signals.value("bound_threshold", 16, registers_.tests.bound_threshold);
}

void RankTest::trace_processed(Signals& signals, const HeightOperands&, const HeightResult&) const {
    signals.value("rank", 16, entry_.rank);
    signals.value("bound", 16, entry_.bound);
}

}  // namespace tessera

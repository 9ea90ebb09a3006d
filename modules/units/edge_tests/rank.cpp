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
    return {edge.tag, asks_by_rank(entry_, edge.ends, registers_.tests, registers_.formats),
            ordering_rank(entry_, registers_.formats)};
}

void RankTest::trace_signals(Signals& signals) const {
    Stage::trace_signals(signals);
    const auto threshold = [&](const char* threshold_name, int bits, std::int32_t value) {
        signals.value(threshold_name, static_cast<unsigned>(bits),
                      static_cast<std::uint32_t>(value) & ((1u << bits) - 1));
    };
    threshold("rank_threshold", datapath::rank_limit_bits, registers_.tests.rank_threshold);
    threshold("bound_threshold", datapath::bound_limit_bits, registers_.tests.bound_threshold);
}

void RankTest::trace_processed(Signals& signals, const HeightOperands& edge, const HeightResult&) const {
    signals.value("rank", 16, entry_.rank);
    signals.value("bound", 16, entry_.bound);
    if (!registers_.formats.distances)
        return;
    signals.value("radius", datapath::radius_bits, entry_.radius);
    signals.value("level", 18, datapath::distance_level(edge.ends.distance));
}

}  // namespace tessera

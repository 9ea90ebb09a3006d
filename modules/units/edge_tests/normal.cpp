#include "modules/units/edge_tests/normal.h"

#include "modules/datapath/bilinear.h"
#include "modules/datapath/bump.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/normalise.h"
#include "modules/stage/stage_steps.h"

namespace tessera {
namespace {

UnitTiming with_highlight_test(const UnitContext& context) {
    UnitTiming timing = context.timing().normal_test;
    if (context.registers.tests.highlight_test)
        timing.latency += context.timing().highlight_test_latency;
    return timing;
}

}  // namespace

NormalTest::NormalTest(const sc_core::sc_module_name& name, const UnitContext& context)
    : Stage(name, context, with_highlight_test(context), 1, context.timing().read_latency(context.timing().normal_map)),
      normal_map("normal_map", context.registers.normal_map.entry_bytes, context.design.direct_memory),
      registers_(context.registers),
      takes_(parts_for_tests(context.tests_unit, context.design.tests_units)) {
    takes_from(context, input);
    delivers_to(context, output, edge_parts);
    reads_through(normal_map, 1);
    may_wait(true);
    const datapath::Formats& f = registers_.formats;
    datapath::Multiplications all;
    all.add(normalise_multiplications(f, f.normal.bits), 2)
        .add(bump_multiplications(f))
        .add(interpolate_multiplications(f), 3);
    if (registers_.tests.highlight_test)
        all.add(highlight_test_multiplications(f));
    multiplies(all);
    keeps(static_cast<int>(map_entry_count(f)) * 3 * f.normal.bits);
    if (!f.families)  // corners
        area_.register_bits += static_cast<unsigned>(3 * (1 + 3 * f.normal.bits) + tag_bits(context.design));
}

bool NormalTest::may_start(const NormalOperands& part) const {
    const unsigned needed = part.new_vertices & takes_;
    if (!part.tag.is_edge() || needed == 0)
        return true;
    const Corners* corners = corners_.find(part.tag.triangle);
    return corners != nullptr && corners->bumped == needed && corners->known_from <= clock_.last_cycle();
}

void NormalTest::reads(const NormalOperands& part, Reads& reads) const {
    reads.add_request();
    map_entries(part.t, registers_.normal_map, registers_.map, registers_.formats,
                [&](std::uint64_t address) { reads.add_entry(address); });
}

NormalResult NormalTest::process(const NormalOperands& part, const Entries& entries) {
    const datapath::Direction entry = map_normal(part.t, entries.data(), registers_.formats);
    if (part.tag.is_edge())
        return test_edge(part, entry);
    const datapath::Direction n = bumped(part.n_i, part.tangent_i, part.handedness_i, entry);
    Corners& corners = corners_.find_or_open(part.tag.triangle);
    corners.bumped |= part.tag.bit();
    corners.known_from = entries_arrive();
    corners.displaced_n[part.tag.index()] = n;
    compared_ = {n, n, n};
    return {part.tag};
}

datapath::Direction NormalTest::bumped(const datapath::Direction& n, const datapath::Direction& t, int handedness,
                                       const datapath::Direction& map_normal) {
    return bump(n, t, handedness, map_normal, registers_.formats, saturations_);
}

/// Fills in the N' of an edge's ends that this unit has calculated itself.
void NormalTest::take_corners(const NormalOperands& edge) {
    Corners& corners = *corners_.find(edge.tag.triangle);
    const unsigned i = edge.tag.index();
    const unsigned j = (i + 1) % 3;
    if ((corners.bumped >> i & 1u) != 0)
        compared_[0] = corners.displaced_n[i];
    if ((corners.bumped >> j & 1u) != 0)
        compared_[1] = corners.displaced_n[j];
    corners.tested |= edge.tag.bit();
    if (corners.tested == (takes_ & triangle_edge_parts))
        corners_.close(edge.tag.triangle);
}

NormalResult NormalTest::test_edge(const NormalOperands& edge, const datapath::Direction& map_normal) {
    const datapath::TestParameters& tests = registers_.tests;
    compared_ = {edge.displaced_n_i, edge.displaced_n_j, {}};
    if ((edge.new_vertices & takes_) != 0)
        take_corners(edge);
    NormalResult result{edge.tag};
    result.n = normalise(midpoint(edge.n_i, edge.n_j), registers_.formats, saturations_);
    result.tangent = normalise(midpoint(edge.tangent_i, edge.tangent_j), registers_.formats, saturations_);
    result.displaced_n = bumped(result.n, result.tangent,
                                datapath::inserted_handedness(edge.handedness_i, edge.handedness_j), map_normal);
    result.displaced_n_i = compared_[0];
    compared_[2] = result.displaced_n;
    const auto& [i, j, ij] = compared_;
    result.normal = tests.normal_test && normal_test(i, j, ij, tests);
    result.highlight = tests.highlight_test && highlight_test(i, j, ij, tests);
    return result;
}

void NormalTest::trace_signals(Signals& signals) const {
    Stage::trace_signals(signals);
    signals.value("threshold", 18, registers_.tests.normal_threshold);
    if (registers_.tests.highlight_test)
        signals.value("highlight_threshold", 18, registers_.tests.highlight_normal_threshold);
}

/// A bumped corner is shown as an edge whose two ends and midpoint are all equal to it.
void NormalTest::trace_processed(Signals& signals, const NormalOperands&, const NormalResult& result) const {
    const auto& [i, j, ij] = compared_;
    signals.direction("n_i", i);
    signals.direction("n_j", j);
    signals.direction("n_ij", ij);
    signals.value("difference", 19, largest_difference(i, j, ij));
    if (registers_.tests.highlight_test)
        signals.flag("highlight", result.highlight);
}

}  // namespace tessera

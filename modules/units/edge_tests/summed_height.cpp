#include "modules/units/edge_tests/summed_height.h"

#include "modules/datapath/edge_tests.h"
#include "modules/stage/stage_steps.h"

namespace tessera {

SummedHeightTest::SummedHeightTest(const sc_core::sc_module_name& name, const UnitContext& context)
    : HeightTestUnit(name, context) {
    if (registers_.tests.summed_height_unit == datapath::SummedHeightUnit::area)
        multiplies(summed_height_limit_multiplications(registers_.formats));
}

/// The size of the edge's three rectangles.
datapath::RectangleSize SummedHeightTest::size(const HeightOperands& edge) const {
    return rectangle_size(edge.t_i, edge.t_j, registers_.map, registers_.formats);
}

/// Whether the sums are codes: those of the edge's ends, and the code at its midpoint.
bool SummedHeightTest::has_codes(const HeightOperands& edge, const datapath::RectangleSize& its_size) const {
    return displacement_map && edge.codes_known && its_size.is_one_texel();
}

void SummedHeightTest::reads(const HeightOperands& edge, Reads& reads) const {
    if (!registers_.tests.summed_height_test)
        return;
    const datapath::RectangleSize its_size = size(edge);
    if (has_codes(edge, its_size)) {
        reads.through(1);
        reads.add(texel_address(edge.t_ij, registers_.displacement_map, registers_.map, registers_.formats));
        return;
    }
    for (const datapath::TexCoord& centre : {edge.t_i, edge.t_j, edge.t_ij}) {
        reads.add_request();
        rectangle_entries(centred_rectangle(centre, its_size, registers_.map, registers_.formats), registers_.map,
                          registers_.height_table, [&](std::uint64_t address, bool) { reads.add_entry(address); });
    }
}

HeightResult SummedHeightTest::process(const HeightOperands& edge, const Entries& entries) {
    if (!registers_.tests.summed_height_test)
        return {edge.tag, false, 0};
    const datapath::RectangleSize its_size = size(edge);
    unsigned sum = 0;
    unsigned next = 0;
    if (has_codes(edge, its_size)) {
        for (const std::uint64_t code : {std::uint64_t{edge.code_i}, std::uint64_t{edge.code_j}, entries[0]})
            sums_[sum++] = code;
    } else {
        for (const datapath::TexCoord& centre : {edge.t_i, edge.t_j, edge.t_ij})
            sums_[sum++] = rectangle_sum(centred_rectangle(centre, its_size, registers_.map, registers_.formats),
                                         registers_.map, registers_.height_table, registers_.formats,
                                         [&](std::uint64_t) { return entries[next++]; });
    }
    return {edge.tag, summed_height_test(sums_[0], sums_[1], sums_[2], its_size, registers_.tests), 0};
}

void SummedHeightTest::trace_signals(Signals& signals) const {
    Stage::trace_signals(signals);
    signals.value("threshold", 64, registers_.tests.summed_height_threshold);
}

void SummedHeightTest::trace_started(Signals& signals, const HeightOperands& edge) const {
    const datapath::RectangleSize its_size = size(edge);
    signals.value("width", 16, its_size.width);
    signals.value("height", 16, its_size.height);
}

void SummedHeightTest::trace_processed(Signals& signals, const HeightOperands& edge, const HeightResult&) const {
    signals.value("sum_i", 48, sums_[0]);
    signals.value("sum_j", 48, sums_[1]);
    signals.value("sum_ij", 48, sums_[2]);
    signals.value("difference", 64, datapath::summed_height_difference(sums_[0], sums_[1], sums_[2]));
    signals.value("limit", 64, summed_height_limit(size(edge), registers_.tests));
}

}  // namespace tessera

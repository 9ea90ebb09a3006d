#include "modules/units/edge_tests/sequencing_unit.h"

#include <algorithm>
#include <type_traits>

#include "modules/datapath/rank.h"
#include "modules/units/edge_tests/test_results.h"

namespace tessera {
namespace {

bool may_split(const TestedEdge& edge) {
    return (edge.found.tests & datapath::gating_tests) == datapath::gating_tests;
}

}  // namespace

SequencingUnit::SequencingUnit(const sc_core::sc_module_name& name, const UnitContext& context)
    : CollectingUnit(name, context.clock),
      registers_(context.registers),
      height_first_(registers_.formats.height_test == datapath::HeightTest::rank) {
    add_input(context, from_summed_height_test);
    to_summed_height_test.clocked_by(context, *this);
    const ItemWidths bits(context);
    const Timing& t = context.timing();
    const std::uint64_t lanes = context.design.edge_lanes, normal_tests = context.design.normal_tests;
    const std::uint64_t operands = bits.of<NormalOperands>() + bits.of<HeightOperands>();
    area_.register_bits += t.results_buffer * (bits.of<HeightResult>() + normal_tests * bits.of<NormalResult>() +
                                               lanes * (bits.of<TexCoordResult>() + bits.of<ViewResult>() + operands)) +
                           normal_tests * bits.of<NormalOperands>() +
                           t.edges_in_sequence * (operands + bits.of<TestedEdge>());
}

template <class Item>
void SequencingUnit::add_input(const UnitContext& context, StreamInput<Item>& input) {
    input.template register_b_transport<&SequencingUnit::b_transport<Item>>(*this);
    input.clocked_by(context.clock, *this, context.timing().results_buffer, context.timing().stalls);
}

SequencingUnit::Next SequencingUnit::after_cheap_tests(const TestedEdge& edge, const NormalOperands& normal,
                                                       const HeightOperands& height) const {
    if (normal.new_vertices != 0)
        return Next::normal_test;
    if (!may_split(edge))
        return Next::leave;
    if (!height_first_)
        return Next::normal_test;
    return has_rank(height) ? Next::summed_height_test : without_rank();
}

/// Whether the Rank Test applies to the edge. This is known without reading its table.
bool SequencingUnit::has_rank(const HeightOperands& edge) const {
    return registers_.tests.summed_height_test && has_lattice_midpoint(edge.t_i, edge.t_j, registers_.formats);
}

/// The next test of an edge that the Rank Test does not split.
SequencingUnit::Next SequencingUnit::without_rank() const {
    return registers_.tests.normal_test || registers_.tests.highlight_test ? Next::normal_test : Next::leave;
}

SequencingUnit::Next SequencingUnit::after_normal_test(const Edge& its) const {
    const TestedEdge& edge = its.tested;
    const bool splits = (edge.found.tests & datapath::requesting_tests) != 0;
    const bool answered = (edge.found.evaluated & datapath::summed_height_bit) != 0;
    if (!may_split(edge) || answered)
        return Next::leave;
    // A Rank Test is also evaluated for the rank of an edge that splits.
    const bool matters = height_first_ ? has_rank(its.height) : !splits && registers_.tests.summed_height_test;
    return matters ? Next::summed_height_test : Next::leave;
}

SequencingUnit::Next SequencingUnit::after_height_test(const TestedEdge& edge) const {
    if ((edge.found.evaluated & datapath::normal_bit) != 0)
        return Next::leave;
    const bool splits = (edge.found.tests & datapath::summed_height_bit) != 0;
    return splits ? Next::normal_test : without_rank();
}

template <class Item>
void SequencingUnit::b_transport(Item& item, sc_core::sc_time& delay) {
    if constexpr (std::is_same_v<Item, NormalResult> || std::is_same_v<Item, HeightResult>) {
        add_result(**in_test_.find(item.tag.triangle), item);
        return;
    } else {
        if (item.tag.is_vertex()) {
            if constexpr (std::is_same_v<Item, NormalOperands>)
                normal_test().transport(item, delay);
            return;
        }
        Arriving& arriving = arriving_.find_or_open(item.tag.triangle);
        arriving.edge.tested.tag = item.tag;
        if constexpr (std::is_same_v<Item, NormalOperands>)
            arriving.edge.normal = item;
        else if constexpr (std::is_same_v<Item, HeightOperands>)
            arriving.edge.height = item;
        else
            add_result(arriving.edge.tested, item);
        if constexpr (std::is_same_v<Item, ViewResult>)
            arriving.ends = item.ends;
        arriving.latest = std::max(arriving.latest, delay);
        if (++arriving.come < 4)
            return;
        delay = arriving.latest;
        Edge edge = arriving.edge;
        edge.height.ends = arriving.ends;
        arriving_.close(item.tag.triangle);
        run_tests(edge, delay);
    }
}

void SequencingUnit::run_tests(Edge& edge, sc_core::sc_time& delay) {
    in_test_.open(edge.tested.tag.triangle) = &edge.tested;
    for (Next next = after_cheap_tests(edge.tested, edge.normal, edge.height); next != Next::leave;) {
        if (next == Next::normal_test) {
            normal_test().transport(edge.normal, delay);
            next = after_normal_test(edge);
        } else {
            to_summed_height_test.transport(edge.height, delay);
            next = after_height_test(edge.tested);
        }
    }
    in_test_.close(edge.tested.tag.triangle);
    tested_edges().transport(edge.tested, delay);
}

// Inputs of the derived units.
template void SequencingUnit::add_input(const UnitContext&, StreamInput<NormalOperands>&);
template void SequencingUnit::add_input(const UnitContext&, StreamInput<HeightOperands>&);
template void SequencingUnit::add_input(const UnitContext&, StreamInput<TexCoordResult>&);
template void SequencingUnit::add_input(const UnitContext&, StreamInput<ViewResult>&);
template void SequencingUnit::add_input(const UnitContext&, StreamInput<NormalResult>&);

}  // namespace tessera

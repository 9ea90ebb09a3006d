#include "modules/units/edge_tests/sequencing_unit.h"

#include <algorithm>
#include <type_traits>

#include "modules/units/edge_tests/test_results.h"

namespace tessera {
namespace {

bool may_split(const TestedEdge& edge) {
    return (edge.found.tests & datapath::gating_tests) == datapath::gating_tests;
}

}  // namespace

SequencingUnit::SequencingUnit(const sc_core::sc_module_name& name, const UnitContext& context)
    : Unit(name, context.clock), registers_(context.registers) {
    add_input(context, from_summed_height_test);
    to_summed_height_test.clocked_by(context, *this);
}

template <class Item>
void SequencingUnit::add_input(const UnitContext& context, StreamInput<Item>& input) {
    input.template register_b_transport<&SequencingUnit::b_transport<Item>>(*this);
    input.clocked_by(context.clock, *this, context.timing().results_buffer, context.timing().stalls);
}

SequencingUnit::Next SequencingUnit::after_cheap_tests(const Edge& edge) const {
    return may_split(edge.tested) || edge.normal.new_vertices != 0 ? Next::normal_test : Next::leave;
}

SequencingUnit::Next SequencingUnit::after_normal_test(const TestedEdge& edge) const {
    const bool splits = (edge.found.tests & datapath::requesting_tests) != 0;
    return may_split(edge) && !splits && registers_.tests.summed_height_test ? Next::summed_height_test : Next::leave;
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
        arriving.latest = std::max(arriving.latest, delay);
        if (++arriving.come < 4)
            return;
        delay = arriving.latest;
        Edge edge = arriving.edge;
        arriving_.close(item.tag.triangle);
        run_tests(edge, delay);
    }
}

void SequencingUnit::run_tests(Edge& edge, sc_core::sc_time& delay) {
    in_test_.open(edge.tested.tag.triangle) = &edge.tested;
    if (after_cheap_tests(edge) == Next::normal_test) {
        normal_test().transport(edge.normal, delay);
        if (after_normal_test(edge.tested) == Next::summed_height_test)
            to_summed_height_test.transport(edge.height, delay);
    }
    in_test_.close(edge.tested.tag.triangle);
    pass_or_tessellate().transport(edge.tested, delay);
}

// Inputs of the derived units.
template void SequencingUnit::add_input(const UnitContext&, StreamInput<NormalOperands>&);
template void SequencingUnit::add_input(const UnitContext&, StreamInput<HeightOperands>&);
template void SequencingUnit::add_input(const UnitContext&, StreamInput<TexCoordResult>&);
template void SequencingUnit::add_input(const UnitContext&, StreamInput<ViewResult>&);
template void SequencingUnit::add_input(const UnitContext&, StreamInput<NormalResult>&);

}  // namespace tessera

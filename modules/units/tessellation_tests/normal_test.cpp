#include "modules/units/tessellation_tests/normal_test.h"

#include "modules/datapath/bump.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/normalise.h"
#include "modules/unit/signals.h"

namespace tessera {
namespace {

UnitTiming with_highlight_test(UnitTiming timing, const Timing& all, const datapath::TestParameters& tests) {
    if (tests.highlight_test)
        timing.latency += all.highlight_test_latency;
    return timing;
}

}  // namespace

NormalTest::NormalTest(const sc_core::sc_module_name& name, Clock& clock,
                       const datapath::Registers& registers, const Timing& timing, bool use_direct_memory)
    : TableStage(name, clock, with_highlight_test(timing.normal_test, timing, registers.tests),
                 timing.normal_map.latency),
      normal_map("normal_map", registers.normal_map.entry_bytes, use_direct_memory),
      registers_(registers) {
    takes_from(input, timing.stalls);
    delivers_to(output);
    reads_through(normal_map, 1);
    input.serve<&NormalTest::b_transport>(*this);
}

std::uint64_t NormalTest::address(const datapath::TexCoord& t) const {
    return texel_address(t, registers_.normal_map, registers_.map, registers_.formats);
}

datapath::Direction NormalTest::bumped(const datapath::Direction& n, const datapath::Direction& t,
                                       int handedness, std::uint64_t entry) {
    return bump(n, t, handedness, datapath::unpack_normal(entry, registers_.formats.normal.bits),
                registers_.formats, saturations_);
}

void NormalTest::bump_corner(datapath::Vertex& vertex, std::uint64_t entry) {
    vertex.displaced_normal = bumped(vertex.normal, vertex.tangent, vertex.handedness, entry);
}

void NormalTest::test_edge(Pass& pass, unsigned k, std::uint64_t entry) {
    const datapath::Vertex& i = pass.edge_begin(static_cast<int>(k));
    const datapath::Vertex& j = pass.edge_end(static_cast<int>(k));
    datapath::EdgeTests& edge = pass.edges[k];
    edge.normal = normalise(midpoint(i.normal, j.normal), registers_.formats, saturations_);
    edge.tangent = normalise(midpoint(i.tangent, j.tangent), registers_.formats, saturations_);
    edge.displaced_normal = bumped(edge.normal, edge.tangent, inserted_handedness(i, j), entry);
    if (registers_.tests.normal_test &&
        normal_test(i.displaced_normal, j.displaced_normal, edge.displaced_normal, registers_.tests))
        edge.tests |= datapath::normal_bit;
}

void NormalTest::test_for_highlight(const Work& work) const {
    Pass& pass = *work.pass;
    for_each_of_three(work.parts, first_edge_part, [&](unsigned k) {
        const datapath::Direction& i = pass.edge_begin(static_cast<int>(k)).displaced_normal;
        const datapath::Direction& j = pass.edge_end(static_cast<int>(k)).displaced_normal;
        datapath::EdgeTests& edge = pass.edges[k];
        if (highlight_test(i, j, edge.displaced_normal, registers_.tests))
            edge.tests |= datapath::highlight_bit;
    });
}

void NormalTest::b_transport(Work& work, sc_core::sc_time& delay) {
    Pass& pass = *work.pass;
    for_each_of_three(work.parts, 0, [&](unsigned k) {
        datapath::Vertex& vertex = pass.triangle.vertices[k];
        bump_corner(vertex, normal_map.read(address(vertex.texture), delay));
    });
    for_each_of_three(work.parts, first_edge_part, [&](unsigned k) {
        test_edge(pass, k, normal_map.read(address(pass.edges[k].texture), delay));
    });
    if (registers_.tests.highlight_test)
        test_for_highlight(work);
    delay += clock_.period() * timing_.latency;
    output->b_transport(work, delay);
}

bool NormalTest::may_begin(const Work& work) {
    return (work.parts & edge_parts) == 0 || work.pass->corners_bumped == work.pass->new_vertices;
}

void NormalTest::ask(TableItem& item, unsigned) {
    const Pass& pass = *item.work.pass;
    const auto ask_at = [&](const datapath::TexCoord& t) {
        const std::uint64_t at = address(t);
        normal_map.request(&at, 1);
    };
    for_each_of_three(item.work.parts, 0, [&](unsigned k) { ask_at(pass.triangle.vertices[k].texture); });
    for_each_of_three(item.work.parts, first_edge_part, [&](unsigned k) { ask_at(pass.edges[k].texture); });
}

void NormalTest::receive(TableItem& item, unsigned) {
    Pass& pass = *item.work.pass;
    const std::uint64_t entry = normal_map.entry(0);
    for_each_of_three(item.work.parts, 0, [&](unsigned k) {
        bump_corner(pass.triangle.vertices[k], entry);
        pass.corners_bumped = static_cast<std::uint8_t>(pass.corners_bumped | 1u << k);
        for (Clocked* other : others_)
            clock_.wake(*other);
        clock_.wake(*this);
    });
    for_each_of_three(item.work.parts, first_edge_part, [&](unsigned k) { test_edge(pass, k, entry); });
    if (registers_.tests.highlight_test)
        test_for_highlight(item.work);
}

void NormalTest::show(Signals& signals) const {
    TableStage::show(signals);
    signals.value("threshold", 18, registers_.tests.normal_threshold);
    if (registers_.tests.highlight_test)
        signals.value("highlight_threshold", 18, registers_.tests.highlight_normal_threshold);
}

void NormalTest::trace_item(Signals& signals, const TableItem& item) const {
    signals.edge_textures(item.work);
}

/// A corner that was bumped shows as its own edge's ends, which do not differ.
void NormalTest::trace_answered(Signals& signals, const TableItem& item) const {
    const datapath::EdgeTests& edge = Signals::pass_of(item.work).edges[Signals::index_of(item.work)];
    const datapath::Direction& i = Signals::begin_of(item.work).displaced_normal;
    const bool is_edge = Signals::is_edge(item.work);
    signals.direction("n_i_x", "n_i_y", "n_i_z", i);
    signals.direction("n_j_x", "n_j_y", "n_j_z", Signals::end_of(item.work).displaced_normal);
    signals.direction("n_ij_x", "n_ij_y", "n_ij_z", is_edge ? edge.displaced_normal : i);
    signals.value(
        "difference", 19,
        is_edge ? largest_difference(i, Signals::end_of(item.work).displaced_normal, edge.displaced_normal)
                : 0);
    signals.flag("normal", is_edge && (edge.tests & datapath::normal_bit) != 0);
    if (registers_.tests.highlight_test)
        signals.flag("highlight", is_edge && (edge.tests & datapath::highlight_bit) != 0);
}

}  // namespace tessera

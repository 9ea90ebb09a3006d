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
                       const datapath::Registers& registers, const Timing& timing, bool use_direct_memory,
                       Parts takes)
    : Stage(name, clock, with_highlight_test(timing.normal_test, timing, registers.tests), 1,
            timing.normal_map.latency),
      normal_map("normal_map", registers.normal_map.entry_bytes, use_direct_memory),
      registers_(registers),
      takes_(takes) {
    takes_from(input, timing.stalls);
    delivers_to(output, edge_parts);
    reads_through(normal_map, 1);
}

bool NormalTest::may_start(const Work& part) const {
    const unsigned needed = part.pass->new_vertices & takes_;
    if (!part.is_edge() || needed == 0)
        return true;
    const Parts* bumped = corners_bumped_.find(part.tag());
    return bumped != nullptr && *bumped == needed;
}

void NormalTest::reads(const Work& part, Reads& reads) const {
    const datapath::TexCoord& t = part.is_edge() ? part.pass->edges[part.index()].texture
                                                 : part.pass->triangle.vertices[part.index()].texture;
    reads.add(texel_address(t, registers_.normal_map, registers_.map, registers_.formats));
}

Work NormalTest::process(const Work& part, const Entries& entries) {
    if (part.is_edge()) {
        test_edge(part, entries[0]);
        if (part.pass->new_vertices != 0 && part.parts == last_of(takes_))
            corners_bumped_.close(part.tag());
    } else {
        datapath::Vertex& vertex = part.pass->triangle.vertices[part.index()];
        vertex.displaced_normal = bumped(vertex.normal, vertex.tangent, vertex.handedness, entries[0]);
        corners_bumped_.find_or_open(part.tag()) |= part.parts;
    }
    return part;
}

datapath::Direction NormalTest::bumped(const datapath::Direction& n, const datapath::Direction& t,
                                       int handedness, std::uint64_t entry) {
    return bump(n, t, handedness, datapath::unpack_normal(entry, registers_.formats.normal.bits),
                registers_.formats, saturations_);
}

void NormalTest::test_edge(const Work& part, std::uint64_t entry) {
    const datapath::TestParameters& tests = registers_.tests;
    const int k = static_cast<int>(part.index());
    const datapath::Vertex& i = part.pass->edge_begin(k);
    const datapath::Vertex& j = part.pass->edge_end(k);
    datapath::EdgeTests& edge = part.pass->edges[part.index()];
    edge.normal = normalise(midpoint(i.normal, j.normal), registers_.formats, saturations_);
    edge.tangent = normalise(midpoint(i.tangent, j.tangent), registers_.formats, saturations_);
    edge.displaced_normal = bumped(edge.normal, edge.tangent, inserted_handedness(i, j), entry);
    if (tests.normal_test &&
        normal_test(i.displaced_normal, j.displaced_normal, edge.displaced_normal, tests))
        edge.tests |= datapath::normal_bit;
    if (tests.highlight_test &&
        highlight_test(i.displaced_normal, j.displaced_normal, edge.displaced_normal, tests))
        edge.tests |= datapath::highlight_bit;
}

void NormalTest::show(Signals& signals) const {
    Stage::show(signals);
    signals.value("threshold", 18, registers_.tests.normal_threshold);
    if (registers_.tests.highlight_test)
        signals.value("highlight_threshold", 18, registers_.tests.highlight_normal_threshold);
}

void NormalTest::trace_started(Signals& signals, const Work& part) const {
    signals.edge_textures(part);
}

/// A corner that was bumped shows as its own edge's ends, which do not differ.
void NormalTest::trace_processed(Signals& signals, const Work& part, const Work&) const {
    const datapath::EdgeTests& edge = Signals::pass_of(part).edges[part.index()];
    const datapath::Direction& i = Signals::begin_of(part).displaced_normal;
    const bool is_edge = part.is_edge();
    signals.direction("n_i_x", "n_i_y", "n_i_z", i);
    signals.direction("n_j_x", "n_j_y", "n_j_z", Signals::end_of(part).displaced_normal);
    signals.direction("n_ij_x", "n_ij_y", "n_ij_z", is_edge ? edge.displaced_normal : i);
    signals.value(
        "difference", 19,
        is_edge ? largest_difference(i, Signals::end_of(part).displaced_normal, edge.displaced_normal) : 0);
    signals.flag("normal", is_edge && (edge.tests & datapath::normal_bit) != 0);
    if (registers_.tests.highlight_test)
        signals.flag("highlight", is_edge && (edge.tests & datapath::highlight_bit) != 0);
}

}  // namespace tessera

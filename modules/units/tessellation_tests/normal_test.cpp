#include "modules/units/tessellation_tests/normal_test.h"

#include "modules/datapath/bump.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/normalise.h"

namespace tessera {

NormalTest::NormalTest(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                       const Timing& timing, bool use_direct_memory)
    : sc_module(name),
      normal_map("normal_map", registers.normal_map.entry_bytes, use_direct_memory),
      registers_(registers),
      latency_(timing.cycle * timing.normal_test.latency) {
    input.register_b_transport(this, &NormalTest::b_transport);
}

datapath::Direction NormalTest::bumped(const datapath::Direction& n, const datapath::Direction& t,
                                       int handedness, const datapath::TexCoord& texture,
                                       sc_core::sc_time& delay) {
    const std::uint64_t entry = normal_map.read(
        texel_address(texture, registers_.normal_map, registers_.map, registers_.formats), delay);
    return bump(n, t, handedness, datapath::unpack_normal(entry, registers_.formats.normal.bits),
                registers_.formats, saturations_);
}

void NormalTest::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    for (std::size_t k = 0; k < 3; ++k) {
        if ((pass.new_vertices >> k & 1u) == 0)
            continue;
        datapath::Vertex& vertex = pass.triangle.vertices[k];
        vertex.displaced_normal =
            bumped(vertex.normal, vertex.tangent, vertex.handedness, vertex.texture, delay);
    }
    delay += latency_;
    for (int k = 0; k < 3; ++k) {
        const datapath::Vertex& i = pass.edge_begin(k);
        const datapath::Vertex& j = pass.edge_end(k);
        datapath::EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
        edge.normal = normalise(midpoint(i.normal, j.normal), registers_.formats, saturations_);
        edge.tangent = normalise(midpoint(i.tangent, j.tangent), registers_.formats, saturations_);
        edge.displaced_normal =
            bumped(edge.normal, edge.tangent, inserted_handedness(i, j), edge.texture, delay);
        if (registers_.tests.normal_test &&
            normal_test(i.displaced_normal, j.displaced_normal, edge.displaced_normal, registers_.tests))
            edge.tests |= datapath::normal_bit;
    }
}

}  // namespace tessera

#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/memory/memory_port.h"
#include "modules/stream/stream_input.h"
#include "modules/stream/stream_output.h"
#include "modules/stream/work.h"
#include "modules/timing.h"
#include "modules/unit/table_stage.h"

namespace tessera {

/// Normal Test (paper figure 8, 2.2, 3.1.4): Calculate New N, Normalise, Bump, and the comparison of the displaced
/// normals. And, in the same place because it needs the same three normals and their differences, the optional Highlight
/// Test (golden/ALGORITHM.md 4.6), which asks for more where the Phong highlight is.
///
/// In:   edges, with N, T, N' of both ends and edges[k].texture; vertices of a base triangle, with N, T, t.
/// Out:  edges[k].normal = N_ij, .tangent = T_ij, .displaced_normal = N'_ij, normal_bit and highlight_bit of
///       edges[k].tests;
///       vertices[k].displaced_normal (a base triangle's corners are bumped first, and end here).
/// Memory: one read of the normal map per edge or vertex.
/// Arithmetic: add, shift by 1; the pipeline's existing normalise and bump units; six absolute differences and
///       compares, one OR. The Highlight Test adds three dot products with one vector, six compares with another
///       threshold and three with a cosine; the differences are the Normal Test's.
/// Timing: one edge or vertex per interval; latency 9 plus the map read, interval 1 by default. A Highlight Test adds its
///       own latency, 1 by default, and nothing to the interval.
/// Waits for Calculate New U and the normal map; with three Tessellation Tests units an edge of a base triangle also
/// for the corner that another unit bumps. Held back by the collection of the tests.
class NormalTest : public TableStage<NormalTest, TableItem> {
  public:
    StreamInput<Work> input{"input"};
    StreamOutput<Work> output{"output"};
    MemoryPort normal_map;

    NormalTest(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
               const Timing& timing, bool use_direct_memory);

    /// The Normal Tests of the other Tessellation Tests units, which wait for the corners that this one bumps.
    void tells(Clocked& other) { others_.push_back(&other); }

    const datapath::Saturations& saturations() const { return saturations_; }

    void show(Signals& signals) const override;

  private:
    friend class TableStage<NormalTest, TableItem>;
    void b_transport(Work& work, sc_core::sc_time& delay);
    unsigned begin(TableItem&) { return 1; }
    void ask(TableItem& item, unsigned k);
    void receive(TableItem& item, unsigned k);
    bool goes_on(const TableItem& item) const { return (item.work.parts & edge_parts) != 0; }
    bool may_begin(const Work& work);
    void trace_item(Signals& signals, const TableItem& item) const;
    void trace_answered(Signals& signals, const TableItem& item) const;

    std::uint64_t address(const datapath::TexCoord& t) const;
    datapath::Direction bumped(const datapath::Direction& n, const datapath::Direction& t, int handedness,
                               std::uint64_t entry);
    void bump_corner(datapath::Vertex& vertex, std::uint64_t entry);
    void test_edge(Pass& pass, unsigned edge, std::uint64_t entry);
    /// Apart from test_edge, which in a design without it would still pay for the registers it takes.
    [[gnu::noinline]] void test_for_highlight(const Work& work) const;

    const datapath::Registers& registers_;
    std::vector<Clocked*> others_;
    datapath::Saturations saturations_;
};

}  // namespace tessera

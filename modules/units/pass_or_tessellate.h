#pragma once
#include <cstdint>
#include <systemc>
#include <tlm>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// Pass or Tessellate (paper figures 7 and 8, 3.1.5): joins Transform and Tessellation Tests, decides per edge, and
/// culls finished triangles that face away.
///
/// In:   a pass from each branch; the second of the two to come completes it.
/// Out:  to Tessellation, a pass with split != 0, or one that is finished but lacks N's of a vertex (it goes round
///       once more for its normals); to Lighting, a finished triangle.
/// Arithmetic: logic; for culling two products of screen bits + 1 and a compare.
/// Check: both branches' t_ij must agree, or the branches have lost step: an SC_ERROR.
/// Timing: one triangle per interval; latency 1, interval 1 by default. Capacity: one triangle.
/// Waits for both branches; held back by Tessellation and Lighting.
class PassOrTessellate : public sc_core::sc_module {
  public:
    StreamTarget<PassOrTessellate, datapath::TrianglePass> from_transform{"from_transform"};
    StreamTarget<PassOrTessellate, datapath::TrianglePass> from_tessellation_tests{"from_tessellation_tests"};
    StreamInitiator<PassOrTessellate, datapath::TrianglePass> to_tessellation{"to_tessellation"};
    StreamInitiator<PassOrTessellate, datapath::Triangle> to_lighting{"to_lighting"};

    /// Every pass whose edges have been decided, complete: for the scoreboard.
    tlm::tlm_analysis_port<datapath::TrianglePass> decided{"decided"};
    /// Every finished triangle, culled ones too: for the mesh monitor.
    tlm::tlm_analysis_port<datapath::Triangle> finished{"finished"};

    struct Counts {
        std::uint64_t passes = 0;         ///< triangles that went through the tests
        std::uint64_t normal_passes = 0;  ///< finished triangles that went round once more for N's
        std::uint64_t edges_split = 0;
        std::uint64_t split_by_normal = 0;         ///< by NT alone
        std::uint64_t split_by_summed_height = 0;  ///< by SHT alone
        std::uint64_t split_by_both = 0;
        std::uint64_t stopped_by_view = 0;        ///< NT or SHT would split, VT is false
        std::uint64_t stopped_by_tex_coord = 0;   ///< likewise TCT
        std::uint64_t stopped_by_generation = 0;  ///< likewise GT
        std::uint64_t finished = 0;
        std::uint64_t culled = 0;
    };

    PassOrTessellate(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                     const Timing& timing);

    const Counts& counts() const { return counts_; }
    bool idle() const { return waiting_ == nullptr; }

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);
    void join(datapath::TrianglePass& pass, sc_core::sc_time& delay);
    void decide_edges(datapath::TrianglePass& pass);
    void finish(datapath::Triangle& triangle, sc_core::sc_time& delay);

    const datapath::Registers& registers_;
    sc_core::sc_time latency_;
    datapath::TrianglePass* waiting_ = nullptr;  // the pass of which one branch has come
    sc_core::sc_time waiting_delay_;             // and when
    Counts counts_;
};

}  // namespace tessera

#pragma once
#include <cstdint>
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/unit/stage.h"

namespace tessera {

/// Transform (paper figure 7): world to screen; the pipeline's existing unit, OpenGL's clipping, perspective and
/// viewport application.
///
/// In:   edges and vertices with their displaced positions; vertices[k].displaced_normal of normals.
/// Out:  new_vertex[k].screen; vertices[k].screen; vertices[k].screen_normal. A base triangle's screen positions also
///       go to the View Test, which waits for them.
/// Arithmetic: 9 multiplications (position or normal); for a position a reciprocal (a table and 4 multiplications) and
///       2 more, saturate (counted).
/// Timing: one vertex, normal or edge per interval and pipeline; latency 20, interval 1, one pipeline by default.
///       Several pipelines take turns; items stay in order.
/// Waits for nothing but its input; held back by Pass or Tessellate.
class Transform final : public Stage<Work> {
  public:
    StreamInput<Work> from_displace_vertex{"from_displace_vertex"};
    StreamOutput<Work> to_pass_or_tessellate{"to_pass_or_tessellate"};
    sc_core::sc_vector<StreamOutput<Work>> to_view_test;  ///< one per Tessellation Tests unit

    Transform(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
              const Timing& timing, unsigned pipelines, unsigned tests_units);

    const datapath::Saturations& saturations() const { return saturations_; }
    std::uint64_t positions() const { return positions_; }
    std::uint64_t normals() const { return normals_; }

  private:
    Work process(const Work& part, const Entries& entries) override;
    void trace_processed(Signals& signals, const Work& part, const Work& result) const override;

    const datapath::Registers& registers_;
    datapath::Saturations saturations_;
    std::uint64_t positions_ = 0;
    std::uint64_t normals_ = 0;
};

}  // namespace tessera

#pragma once
#include <array>
#include <cstdint>
#include <systemc>
#include <tlm>

#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/unit.h"

namespace tessera {

/// Common base of Tessellation in the paper's design and in the family design (family/tessellation.h).
class TessellatingUnit : public Unit {
  public:
    /// In the family design, every triangle that is split and the vertices inserted on its edges: for the scoreboard.
    tlm::tlm_analysis_port<datapath::TrianglePass> inserted{"inserted"};

    ~TessellatingUnit() override;

    /// Triangles split into 2, 3 or 4 children, by number of children; index 1: passed on unchanged.
    const std::array<std::uint64_t, 5>& made_into() const { return made_into_; }
    /// Decided triangles at its input.
    virtual std::size_t waiting() const { return 0; }
    std::uint64_t children() const { return made_into_[1] + 2 * made_into_[2] + 3 * made_into_[3] + 4 * made_into_[4]; }

  protected:
    TessellatingUnit(const sc_core::sc_module_name& name, const UnitContext& context);

    const datapath::Registers& registers_;
    UnitTiming timing_;
    std::array<std::uint64_t, 5> made_into_{};
};

/// Tessellation (paper figures 6 and 7): builds the two, three or four children of a triangle from its vertices and
/// the new ones. Winding order is kept. A child's edge from corner to corner of its parent was tested with the parent
/// and is final (Formats::final_edges).
///
/// In:   DecidedTriangle. Out: its children, one after another; for a finished triangle that still needs its normals,
///       the triangle itself.
/// Arithmetic: wiring; with the `shorter` diagonal two Manhattan lengths (6 subtractions, 4 adds), a margin (1
///       subtraction) and a compare. New vertices' generations saturate (counted), only with the Generation Test off.
/// Timing: one child per interval, the first a latency after the triangle was accepted.
/// Capacity: one triangle; the next is accepted when the last child has been accepted.
/// Waits only for its input; held back by the Triangle Queue.
class Tessellation : public TessellatingUnit {
  public:
    StreamInput<DecidedTriangle> from_pass_or_tessellate{"from_pass_or_tessellate"};
    StreamOutput<datapath::Triangle> to_triangle_queue{"to_triangle_queue"};

    Tessellation(const sc_core::sc_module_name& name, const UnitContext& context);

    std::size_t waiting() const override { return from_pass_or_tessellate.size(); }
    std::string describe_contents() const override;
    std::uint64_t occupied_cycles() const override {
        return one_at_a_time_cycles(timing_, activity_.items_in(), children());
    }
    void trace_signals(Signals& signals) const override;

  private:
    void b_transport(DecidedTriangle& decided, sc_core::sc_time& delay);
    void step() override;

    sc_core::sc_time latency_;
    std::array<datapath::Triangle, 4> children_;
    unsigned made_ = 0;  // children of the triangle that is being worked on
    unsigned sent_ = 0;  // of these, sent
    std::uint64_t next_ = 0;
};

}  // namespace tessera

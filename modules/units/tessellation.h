#pragma once
#include <cstdint>
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// Tessellation (paper figures 6 and 7): builds the two, three or four children of a triangle from its vertices and
/// the new ones. Winding order is kept.
///
/// In:   a pass with split set, both branches complete. Out: its children, one after another; for a finished triangle
///       on its way to fetch normals, the triangle itself.
/// Arithmetic: wiring; with the `shorter` diagonal two Manhattan lengths (6 subtractions, 4 adds) and a compare.
/// Timing: one child per interval; latency 1, interval 1 by default. Capacity: one triangle.
/// Waits for nothing but its input; held back by the Triangle Queue.
class Tessellation : public sc_core::sc_module {
  public:
    StreamTarget<Tessellation, datapath::TrianglePass> from_pass_or_tessellate{"from_pass_or_tessellate"};
    StreamInitiator<Tessellation, datapath::Triangle> to_triangle_queue{"to_triangle_queue"};

    Tessellation(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                 const Timing& timing);

    /// Triangles made into 2, 3, 4 children; index 1: passed unchanged.
    const std::array<std::uint64_t, 5>& made_into() const { return made_into_; }

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);

    const datapath::Registers& registers_;
    sc_core::sc_time latency_;
    std::array<std::uint64_t, 5> made_into_{};
};

}  // namespace tessera

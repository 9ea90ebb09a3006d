#pragma once
#include <cstdint>
#include <systemc>
#include <tlm>

#include "modules/sockets/stream_input.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/units/lighting.h"

namespace tessera {

/// The machine's sink (paper figure 7): accepts and counts every lit triangle. Never blocks.
class Rasteriser : public sc_core::sc_module, public CycleProcess {
  public:
    StreamInput<LitTriangle> from_lighting{"from_lighting"};
    /// Every accepted triangle, for the transport check.
    tlm::tlm_analysis_port<LitTriangle> taken{"taken"};

    Rasteriser(const sc_core::sc_module_name& name, CycleScheduler& clock, const StallParameters& stalls)
        : sc_module(name) {
        clock.attach(*this);
        from_lighting.register_b_transport<&Rasteriser::b_transport>(*this);
        from_lighting.clocked_by(clock, *this, 1, stalls);
    }

    std::uint64_t triangles() const { return triangles_; }

  private:
    void b_transport(LitTriangle& triangle, sc_core::sc_time&) { take(triangle); }
    void take(const LitTriangle& triangle) {
        ++triangles_;
        taken.write(triangle);
    }
    void step() override {
        while (!from_lighting.empty()) {
            take(from_lighting.front());
            from_lighting.pop();
        }
    }

    std::uint64_t triangles_ = 0;
};

}  // namespace tessera

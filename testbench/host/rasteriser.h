#pragma once
#include <cstdint>
#include <systemc>

#include "modules/stream/stream.h"
#include "modules/units/lighting.h"

namespace tessera {

/// Where the machine ends (paper figure 7): takes every lit triangle and counts it. Never holds back.
class Rasteriser : public sc_core::sc_module {
  public:
    StreamTarget<Rasteriser, LitTriangle> from_lighting{"from_lighting"};

    explicit Rasteriser(const sc_core::sc_module_name& name) : sc_module(name) {
        from_lighting.register_b_transport(this, &Rasteriser::b_transport);
    }

    std::uint64_t triangles() const { return triangles_; }

  private:
    void b_transport(LitTriangle&, sc_core::sc_time&) { ++triangles_; }

    std::uint64_t triangles_ = 0;
};

}  // namespace tessera

#pragma once
#include <array>
#include <cstdint>
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// What the rasteriser gets of a triangle: P's, t and an intensity per vertex.
struct LitTriangle {
    struct Corner {
        datapath::ScreenPosition screen;
        datapath::TexCoord texture;
        std::uint8_t intensity = 0;
    };
    std::array<Corner, 3> corners;
};

/// Lighting (paper figure 7): per-vertex lighting, after Transform so that re-meshing happens in world space.
///
/// In:   a finished triangle: P's, N's, t. Out: P's, t, intensity, to the rasteriser.
/// Arithmetic: three multiplications and a maximum per vertex, one multiplication; truncated to 8 bits.
/// Timing: one triangle per interval; latency 4, interval 1 by default. Capacity: its pipeline.
/// Waits for nothing but its input; held back by the rasteriser.
class Lighting : public sc_core::sc_module {
  public:
    StreamTarget<Lighting, datapath::Triangle> from_pass_or_tessellate{"from_pass_or_tessellate"};
    StreamInitiator<Lighting, LitTriangle> to_rasteriser{"to_rasteriser"};

    Lighting(const sc_core::sc_module_name& name, const datapath::Registers& registers, const Timing& timing);

  private:
    void b_transport(datapath::Triangle& triangle, sc_core::sc_time& delay);

    const datapath::Registers& registers_;
    sc_core::sc_time latency_;
};

}  // namespace tessera

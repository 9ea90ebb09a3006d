#pragma once
#include <array>
#include <cstdint>
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"
#include "modules/unit/stage.h"

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
/// Arithmetic: three multiplications and a maximum per vertex, one multiplication; truncated to 8 bits, saturates (counted).
/// Timing: one triangle per interval; latency 4, interval 1 by default.
/// Waits for nothing but its input; held back by the rasteriser.
class Lighting final : public Stage<datapath::Triangle, LitTriangle> {
  public:
    StreamInput<datapath::Triangle> from_pass_or_tessellate{"from_pass_or_tessellate"};
    StreamOutput<LitTriangle> to_rasteriser{"to_rasteriser"};

    Lighting(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
             const Timing& timing);

    const datapath::Saturations& saturations() const { return saturations_; }

  private:
    LitTriangle process(const datapath::Triangle& triangle, const Entries& entries) override;
    void trace_processed(Signals& signals, const datapath::Triangle& triangle,
                         const LitTriangle& lit) const override;

    const datapath::Registers& registers_;
    datapath::Saturations saturations_;
};

}  // namespace tessera

#pragma once
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/stage/stage.h"

namespace tessera {

/// Lighting (paper figure 7): per-vertex lighting, after Transform, so that tessellation works on world-space data.
///
/// In:   TriangleToLight: P's, N's, t. Out: LitTriangle: P's, t, intensity, to the rasteriser.
/// Arithmetic: three multiplications and a maximum per vertex, one multiplication; truncated to 8 bits, saturates
///       (counted).
/// Timing: one triangle per interval.
/// Waits only for its input; held back by the rasteriser. Timed mode calls the rasteriser from an SC_METHOD, so it must
///       not call wait() (modules/device/frame_streams.h has a buffer for a thread that does).
class Lighting : public Stage<TriangleToLight, LitTriangle> {
  public:
    StreamInput<TriangleToLight> from_pass_or_tessellate{"from_pass_or_tessellate"};
    StreamOutput<LitTriangle> to_rasteriser{"to_rasteriser"};

    Lighting(const sc_core::sc_module_name& name, const UnitContext& context);

  protected:
    LitTriangle process(const TriangleToLight& triangle, const Entries& entries) override;

    const datapath::Registers& registers_;
};

}  // namespace tessera

#pragma once
#include <array>
#include <cstdint>
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"
#include "modules/stream/stream_input.h"
#include "modules/stream/stream_output.h"
#include "modules/timing.h"
#include "modules/unit/elastic_pipeline.h"
#include "modules/unit/unit.h"

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
class Lighting : public Unit {
  public:
    StreamInput<datapath::Triangle> from_pass_or_tessellate{"from_pass_or_tessellate"};
    StreamOutput<LitTriangle> to_rasteriser{"to_rasteriser"};

    Lighting(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
             const Timing& timing);

    const datapath::Saturations& saturations() const { return saturations_; }

    std::string holds() const override;
    std::uint64_t occupied_cycles() const override { return activity_.items_in() * timing_.interval; }
    void show(Signals& signals) const override;
    /// Counts only: a triangle comes without its number.
    Begun begun() const override { return {activity_.items_in()}; }

  private:
    void b_transport(datapath::Triangle& triangle, sc_core::sc_time& delay);
    void step() override;
    LitTriangle light(const datapath::Triangle& triangle);

    const datapath::Registers& registers_;
    UnitTiming timing_;
    ElasticPipeline<LitTriangle> pipeline_;
    bool offered_ = false;  // the first is on offer to the rasteriser
    datapath::Saturations saturations_;
};

}  // namespace tessera

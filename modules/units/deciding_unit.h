#pragma once
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <tlm>

#include "modules/datapath/triangle_pass.h"
#include "modules/sockets/items.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/unit.h"

namespace tessera {

/// Common base of Pass or Tessellate in the paper's design (pass_or_tessellate.h) and in the family design
/// (family/pass_or_tessellate.h): decides per edge, and culls finished triangles that face away.
class DecidingUnit : public Unit {
  public:
    StreamOutput<TriangleToLight> to_lighting{"to_lighting"};

    /// Every triangle whose edges have been decided: for the scoreboard.
    tlm::tlm_analysis_port<datapath::TrianglePass> decided{"decided"};
    /// Every finished triangle, including culled ones: for the mesh monitor.
    tlm::tlm_analysis_port<datapath::Triangle> finished{"finished"};

    struct Counts {
        std::uint64_t passes = 0;         ///< triangles whose edges were decided
        std::uint64_t normal_passes = 0;  ///< additional passes of finished triangles, for N's
        std::uint64_t edges_tested = 0;   ///< edges of these triangles, without final edges
        std::uint64_t edges_split = 0;
        std::uint64_t edges_uncut = 0;  ///< to be split, but another edge was cut: tested again
        std::uint64_t finished = 0;
        std::uint64_t culled = 0;
    };

    ~DecidingUnit() override;

    const Counts& counts() const { return counts_; }
    /// True if no triangle waits for its parts.
    virtual bool joined() const = 0;
    /// The largest number of triangles that waited for parts at a time.
    virtual std::size_t most_incomplete() const = 0;

  protected:
    enum class Way : std::uint8_t { tessellation, lighting, dropped };

    DecidingUnit(const sc_core::sc_module_name& name, const UnitContext& context);

    void decide_edges(datapath::TrianglePass& pass);
    /// Culls a finished triangle, or not. Returns Way::lighting or Way::dropped.
    Way finish(datapath::Triangle& triangle);
    static TriangleToLight to_light(const Origin& origin, const datapath::Triangle& triangle);

    const datapath::Registers& registers_;
    UnitTiming timing_;
    sc_core::sc_time latency_;
    Counts counts_;
};

}  // namespace tessera

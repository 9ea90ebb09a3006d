#pragma once
#include <cstdint>
#include <string>
#include <systemc>
#include <tlm>

#include "modules/datapath/triangle_pass.h"
#include "testbench/job/job.h"

namespace tessera {

/// How many of a run's edges have an end or a midpoint one LSB of the texture coordinate below a texel's border.
struct TexelBorderCount {
    int fraction = 0;  ///< bits of the texture coordinate
    std::uint64_t edges = 0;
    std::uint64_t below = 0;

    /// More than one per cent, and more than twice what coordinates at random would give.
    bool many() const;
};

/// Counts edges with an end or a midpoint one LSB of the texture coordinate below a texel's border. That is where
/// rounding down puts a midpoint that lies on the border in exact arithmetic but between base vertices that the format
/// cannot hold, such as thirds of 256 texels: it then reads the texel before, with formats of any width. A
/// coordinate on the border itself is not counted.
class TexelBorders : public tlm::tlm_analysis_if<datapath::TrianglePass> {
  public:
    explicit TexelBorders(const datapath::Formats& formats);

    void write(const datapath::TrianglePass& pass) override;

    const TexelBorderCount& count() const { return count_; }

  private:
    bool below(const datapath::TexCoord& t) const {
        return (t.u & fraction_) == fraction_ || (t.v & fraction_) == fraction_;
    }

    TexelBorderCount count_;
    std::uint32_t fraction_;  // the fraction's bits: all set one LSB below a border
};

/// What to tell the user where there are many: how many, and a map size or a number of quads, as the keys allow, that
/// has none. Else empty. `width`, `height`: the map's.
std::string texel_borders_warning(const TexelBorderCount& count, const Job& job, std::int64_t width,
                                  std::int64_t height);

}  // namespace tessera

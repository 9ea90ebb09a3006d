#pragma once
#include <cstdint>
#include <string>
#include <systemc>
#include <tlm>

#include "modules/datapath/triangle_pass.h"
#include "testbench/job/job.h"

namespace tessera {

/// Number of edges of a run with an end or midpoint one LSB of the texture coordinate below a texel's border.
struct TexelBorderCount {
    int fraction = 0;  ///< bits of the texture coordinate
    std::uint64_t edges = 0;
    std::uint64_t below = 0;

    /// More than one per cent, and more than twice the expected number for random coordinates.
    bool many() const;
};

/// Counts edges with an end or a midpoint one LSB of the texture coordinate below a texel's border. A midpoint that
/// lies on the border in exact arithmetic is rounded to that place if the format cannot represent the base vertices'
/// texture coordinates, such as thirds of 256 texels. It then reads the preceding texel, whatever the format's width. A
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
    std::uint32_t fraction_;  // mask of the fraction bits, which are all set one LSB below a border
};

/// A warning if there are many, else empty: their number, and a map size or a number of quads, within the keys' ranges,
/// that avoids them. `width`, `height`: the map's.
std::string texel_borders_warning(const TexelBorderCount& count, const Job& job, std::int64_t width,
                                  std::int64_t height);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <string>

#include "modules/datapath/format.h"
#include "testbench/check/mesh/corner_table.h"

namespace tessera {

/// "P (x, y, z) P' (x, y, z) t (u, v) = texel (u, v)", all but the texels in LSB.
std::string describe_corner(const EmittedMesh& mesh, CornerRef ref, const datapath::Formats& formats);

/// The same for a vertex of which nothing was emitted, so that it has no P'.
std::string describe_point(const SurfacePoint& point, const datapath::Formats& formats);

/// Keeps the text of the violation with the lowest base triangle; of several there, the first offered.
class FirstViolation {
  public:
    template <class MakeText>
    void offer(std::uint64_t base, MakeText&& make_text) {
        if (base >= base_)
            return;
        base_ = base;
        text_ = make_text();
    }
    const std::string& text() const { return text_; }

  private:
    std::uint64_t base_ = UINT64_MAX;
    std::string text_;
};

}  // namespace tessera

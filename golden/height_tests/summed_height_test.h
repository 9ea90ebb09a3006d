#pragma once
#include "golden/height_tests/height_test.h"

namespace tessera::golden {

/// Section 4.2. value: |2 S(r_ij) - S(r_i) - S(r_j)|, exact; limit: 4 * threshold, or threshold * area.
class SummedHeightTest : public HeightTest {
  public:
    /// threshold: a sum of codes; with the area option: one code.
    explicit SummedHeightTest(double threshold = 0, bool area = false) : threshold_(threshold), area_(area) {}

    Verdict decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                   const Parameters& parameters) const override;

  private:
    double threshold_;
    bool area_;
};

}  // namespace tessera::golden

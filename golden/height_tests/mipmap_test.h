#pragma once
#include <vector>

#include "golden/height_tests/height_test.h"

namespace tessera::golden {

/// The height of a block of a mipmap (4.9): the mean of its texels, rounded to nearest, or their maximum.
enum class MipmapFilter { mean, maximum };

/// Section 4.9. value: codes.
class MipmapTest : public HeightTest {
  public:
    /// Heights of the blocks of 2^l x 2^l texels of each level l, rows from the bottom.
    using Levels = std::vector<std::vector<double>>;

    /// threshold: codes.
    MipmapTest(const Map& map, MipmapFilter filter, double threshold);

    const Levels& levels() const { return levels_; }
    double threshold() const { return threshold_; }
    /// The height of the block that holds the texel that contains t. level: at most the last.
    double height(const glm::dvec2& t, int level, const Map& map) const;
    Verdict decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                   const Parameters& parameters) const override;

  private:
    Levels levels_;
    double threshold_;
};

}  // namespace tessera::golden

#pragma once
#include "golden/golden_map.h"
#include "golden/golden_model.h"

namespace tessera::golden {

/// Section 4.2, or a test in its place, 4.7 to 4.9: does the map ask for a split of this edge?
class HeightTest {
  public:
    struct Verdict {
        bool asks = false;
        double value = 0, limit = 0;  ///< asks = value > limit; both 0 for a Rank Test
        int order = 0;  ///< of a Rank Test: by which `greatest_rank` compares midpoints, 0 if it is not a lattice point
    };

    HeightTest() = default;
    virtual ~HeightTest() = default;
    HeightTest(const HeightTest&) = delete;
    HeightTest& operator=(const HeightTest&) = delete;

    /// m: the vertex inserted between i and j.
    virtual Verdict decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                           const Parameters& parameters) const = 0;
    virtual bool uses_distances() const { return false; }  ///< of vertices, from the eye
};

/// The map's height test if it is of this kind; else null.
template <class Test>
const Test* height_test_of(const Map& map) {
    return dynamic_cast<const Test*>(&map.height_test());
}

}  // namespace tessera::golden

#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// Subdivides each triangle of an emitted mesh into m * m congruent parts for sampling; m is the least for which no
/// part's edge is longer than a texel along u, along v or in space. Beyond `most` parts every m is lowered by the same
/// factor; density() gives the result.
class MeshSamples {
  public:
    /// `map`: texels across and up; `texel`: a texel's length, model units.
    MeshSamples(const RecordedMesh& mesh, const glm::dvec2& map, double texel, std::uint64_t most);

    std::uint32_t subdivision(std::size_t triangle) const { return subdivisions_[triangle]; }
    double density() const { return density_; }  ///< minimum parts per texel along an edge

    /// Calls at(b) with the barycentric coordinates of each part's centroid.
    template <class At>
    static void for_each_part(std::uint32_t m, At&& at) {
        const double step = 1.0 / (3.0 * static_cast<double>(m));
        for (std::uint32_t j = 0; j < m; ++j) {
            for (std::uint32_t i = 0; i + j < m; ++i) {
                const double b1 = 3.0 * i + 1, b2 = 3.0 * j + 1;
                at(glm::dvec3(3.0 * m - b1 - b2, b1, b2) * step);
                if (i + j + 1 < m)
                    at(glm::dvec3(3.0 * m - b1 - b2 - 2, b1 + 1, b2 + 1) * step);
            }
        }
    }

  private:
    std::vector<std::uint32_t> subdivisions_;
    double density_ = 1;
};

}  // namespace tessera

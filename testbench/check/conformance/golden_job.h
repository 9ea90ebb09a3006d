#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "golden/golden_frames.h"
#include "golden/golden_setup.h"
#include "testbench/job/job.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// What golden takes from the host's set-up. Each member, and each argument of GoldenJob and GoldenRun, has its row in the
/// table in golden/ALGORITHM.md, section 8; a test compares them.
struct TakenFromHost {
    TakenFromHost(const PreparedScene& scene)  // a set-up is passed for it
        : fitted_heights(scene.fitted_heights),
          rank_tables(scene.rank_tables),
          curvature_table(scene.curvature_table),
          view_distance_fraction(scene.registers.formats.view_distance.fraction) {}

    const std::vector<std::uint16_t>& fitted_heights;
    const RankTables& rank_tables;
    const CurvatureTable& curvature_table;
    int view_distance_fraction;
};

/// The golden model's inputs, derived from a job, its mesh and its map independently of the host. setup_check.h compares
/// the host's set-up of the same job with this; golden's own run (end_to_end.h) starts from it.
///
/// The map's values are those of its file, in which golden itself replaces what is no height (NaN, map.no_data). Its
/// codes are golden's own, of the job's width. Memory: 12
/// bytes per texel.
class GoldenJob {
  public:
    /// `job` must be resolved (resolve_job.h), `mesh` and `height_map` must outlive this.
    GoldenJob(const Job& job, const BaseMesh& mesh, const HeightMap& height_map, const ModelScale& model_scale,
              const TakenFromHost& taken = PreparedScene{});

    const Job& job() const { return job_; }
    const BaseMesh& mesh() const { return mesh_; }
    const golden::Scene& scene() const { return scene_; }
    const golden::Parameters& parameters() const { return parameters_; }
    const golden::Map& map() const { return map_; }
    int view_distance_fraction() const { return view_distance_fraction_; }

    /// A triangle's corner in the world: the first five members. Of the mesh it takes position, normal and texture
    /// coordinates; the frame is golden's own.
    golden::Vertex vertex(std::uint32_t triangle, std::size_t corner) const;
    /// Error bounds in double precision: of the components of that tangent, and of a texel's size, relative.
    double tangent_rounding(std::uint32_t triangle, std::size_t corner) const {
        return frames_.corners[triangle][corner].rounding;
    }
    double texel_rounding() const { return frames_.size_rounding; }

    /// World units, along u and v.
    glm::dvec2 texel_size() const;

    /// The code of a texel of the map before rounding.
    double unrounded_code(std::size_t texel) const;

  private:
    const std::vector<float>& heights() const { return own_heights_.empty() ? height_map_.values : own_heights_; }

    Job job_;
    const BaseMesh& mesh_;
    const HeightMap& height_map_;
    golden::BaseFrames frames_;
    std::vector<float> own_heights_;    // empty: all of the map's values are heights
    std::array<double, 2> code_range_;  // values of the lowest and the highest code
    int view_distance_fraction_;
    golden::Scene scene_;
    golden::Parameters parameters_;
    golden::Map map_;
};

}  // namespace tessera

#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "golden/golden_model.h"
#include "testbench/job/job.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// The golden model on a job's own mesh, map and thresholds without rounding to formats: the result of a machine with
/// unlimited word length. In double precision; the map's heights in steps of 2^-32 of their range (2^-27 for a map of
/// 4096 x 4096), texture coordinates in steps of 2^-30 texels. Map and mesh are in the machine's world units;
/// model_scale converts back. The matrix has the machine's 24 fraction bits, which no format changes.
class ExactModel {
  public:
    ExactModel(const Job& job, const BaseMesh& mesh, const HeightMap& map);

    const golden::Map& map() const { return map_; }
    const golden::Parameters& parameters() const { return parameters_; }
    const ModelScale& model_scale() const { return model_scale_; }

    /// The exact corners of each of the setup's base triangles, complete (golden::complete_base_vertex). A setup omits
    /// triangles of the mesh that collapse in its formats.
    std::vector<std::array<golden::Vertex, 3>> corners_of(const MachineSetup& setup) const;

  private:
    golden::Vertex base_vertex(const BaseVertex& vertex, bool beyond_map) const;

    golden::Map map_;
    golden::Parameters parameters_;
    ModelScale model_scale_;
    std::vector<std::array<golden::Vertex, 3>> base_;
};

}  // namespace tessera

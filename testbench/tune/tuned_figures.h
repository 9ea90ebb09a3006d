#pragma once
#include <cstdint>
#include <string>

#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// A mesh's figures, bit for bit those of `tessera compare`.
struct TunedFigures {
    std::uint64_t triangles = 0;
    double rms = 0,
           max = 0;  ///< on a height field the vertical error, else from the reference to the mesh; in `unit`
    double rms_model = 0, max_model = 0;  ///< the same in model units
    std::string what;                     ///< "vertical error", "distance from the surface to the mesh"
    std::string unit;                     ///< "map unit" or "model unit"
};

/// The unit of reported errors, in model units: that of the map's source on a height field (1 where it has no
/// displacement), else 1.
struct ErrorUnit {
    double model_units = 1;
    bool map_units = false;
    bool height_field = false;

    const char* name() const { return map_units ? "map unit" : "model unit"; }
};
ErrorUnit error_unit(const Job& job, const BaseMesh& base, const HeightMap& map);

/// `mesh` must be sorted as in a run. Throws the errors of measuring.
TunedFigures measure_tuned(const Job& job, const BaseMesh& base, const HeightMap& map, const MachineSetup& setup,
                           const EmittedMesh& mesh);

}  // namespace tessera

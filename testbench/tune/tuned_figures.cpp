#include "testbench/tune/tuned_figures.h"

#include <cmath>

#include "testbench/compare/measure_error.h"
#include "testbench/output/report/indexed_mesh.h"

namespace tessera {

ErrorUnit error_unit(const Job& job, const BaseMesh& base, const HeightMap& map) {
    const DisplacementOf displacement = DisplacementOf::from(job, map);
    std::string why;
    ErrorUnit unit;
    unit.height_field = find_height_field(base, map, displacement, why).has_value();
    if (unit.height_field && displacement.scale != 0) {
        unit.map_units = true;
        unit.model_units = std::abs(displacement.scale) / map.source_units;
    }
    return unit;
}

TunedFigures measure_tuned(const Job& job, const BaseMesh& base, const HeightMap& map, const MachineSetup& setup,
                           const EmittedMesh& mesh) {
    const DisplacementOf displacement = DisplacementOf::from(job, map);
    const RecordedMesh recorded = recorded_mesh(
        mesh, {setup.registers.formats, setup.registers.map, setup.model_scale.scale, setup.model_scale.centre});
    TunedFigures figures;
    figures.triangles = recorded.triangles.size();
    figures.unit = "model unit";
    std::string why;
    if (const auto field = find_height_field(base, map, displacement, why)) {
        const VerticalError error = measure_vertical_error(*field, base, map, displacement, recorded);
        figures.what = "vertical error";
        figures.rms = figures.rms_model = error.rms;
        figures.max = figures.max_model = error.max;
        if (error.map_unit > 0) {
            figures.unit = "map unit";
            figures.rms = error.rms / error.map_unit;
            figures.max = error.max / error.map_unit;
        }
        return figures;
    }
    const DirectedError error =
        measure_surface_error(base, map, displacement, recorded, Sampling::interpolated).reference_to_mesh;
    figures.what = "distance from the surface to the mesh (searched: at equal texture coordinates, an upper bound)";
    figures.rms = figures.rms_model = error.rms;
    figures.max = figures.max_model = error.max;
    return figures;
}

}  // namespace tessera

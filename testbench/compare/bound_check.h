#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "testbench/compare/height_field.h"
#include "testbench/job/job.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Whether a run's mesh keeps tests.bound_threshold, measured over all texel centres of the map, against the map's own
/// values; in the picture over those that are in it.
struct BoundResult {
    enum class Verdict : std::uint8_t {
        holds,
        nothing,       ///< no texel centre was compared
        not_promised,  ///< exceeded; a condition is broken (bound_promise.h), which the set-up's remark names
        positions,     ///< exceeded by the rounding of positions
        heights,       ///< in the picture: by the rounding of heights to codes
        near_plane,    ///< a point's distance in the picture is infinite: the near plane is between it and the mesh
        saturated,     ///< exceeded, and values did not fit their formats
        fault          ///< exceeded without any of these
    };
    Verdict verdict = Verdict::holds;
    bool promised = false;    ///< all conditions are met
    bool in_picture = false;  ///< in pixels, else full scale
    double threshold = 0;
    double deviation = 0;  ///< the largest found
    std::uint64_t points = 0;
    glm::dvec2 worst_texel{0};  ///< its place on the surface
    std::string remedy;         ///< what to set, for rounding

    bool empty() const { return points == 0; }
    bool passed() const { return verdict != Verdict::fault && verdict != Verdict::nothing; }
    std::string text() const;  ///< one sentence
};

/// Nothing if the job asks for no bound, or if its base mesh is no height field. `saturated`: values of the run did not
/// fit their formats. Takes about as long as drawing the mesh.
std::optional<BoundResult> check_bound(const Job& job, const BaseMesh& base, const HeightMap& map,
                                       const MachineSetup& setup, const RecordedMesh& mesh, bool saturated);

}  // namespace tessera

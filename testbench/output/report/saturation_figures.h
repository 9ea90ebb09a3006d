#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/format.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// How often one quantity of a run did not fit its format.
struct SaturationFigure {
    const char* name;  ///< in the statistics' group "saturations"
    std::uint64_t count;
    const char* unit;
    const char* description;
    const char* remedy;             ///< the key to widen, or what else helps; null: no width does
    const char* meaning = nullptr;  ///< where no width helps: what to make of the count; null: the setup remarks on it
};

/// Of every quantity that can saturate, in the machine (`saturations`) or on its way into it (MachineSetup), in the
/// order of the pipeline; those of count 0 too.
std::vector<SaturationFigure> saturation_figures(const MachineSetup& setup, const datapath::Saturations& saturations);

/// "normal 3, screen position 12", or "none".
std::string saturations_text(const std::vector<SaturationFigure>& figures);

/// A sentence for each quantity that saturated and that something can be done about: how often, what, and what to do.
std::vector<std::string> saturation_warnings(const std::vector<SaturationFigure>& figures);

/// A sentence for each quantity that saturated and that no width helps: how often, what, and what that means.
std::vector<std::string> saturation_notes(const std::vector<SaturationFigure>& figures);

}  // namespace tessera

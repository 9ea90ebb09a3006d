#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/format.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Number of values of one quantity of a run that did not fit their format.
struct SaturationFigure {
    const char* name;  ///< in the statistics' group "saturations"
    std::uint64_t count;
    const char* unit;
    const char* description;
    const char* remedy;             ///< the key to widen, or another remedy; null: no width helps
    const char* meaning = nullptr;  ///< if no width helps: how to judge the count; null: the setup has a remark
};

/// Figures of every quantity that can saturate, in the machine (`saturations`) or on input (MachineSetup), in pipeline
/// order, including counts of 0.
std::vector<SaturationFigure> saturation_figures(const MachineSetup& setup, const datapath::Saturations& saturations);

/// "normal 3, screen position 12", or "none".
std::string saturations_text(const std::vector<SaturationFigure>& figures);

/// A sentence for each quantity that saturated and has a remedy: count, quantity and remedy.
std::vector<std::string> saturation_warnings(const std::vector<SaturationFigure>& figures);

/// A sentence for each quantity that saturated and that no width helps: count, quantity and meaning.
std::vector<std::string> saturation_notes(const std::vector<SaturationFigure>& figures);

}  // namespace tessera

#pragma once
#include <vector>

#include "modules/stage/signals.h"

namespace tessera {

/// The numbers of units and memories in waveforms, from the list of units (waveforms/units.txt). They are the same in every
/// design; lanes and Normal Tests from the fifth on have none.
const std::vector<UnitNumbers::Entry>& numbered_units();

}  // namespace tessera

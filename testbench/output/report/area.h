#pragma once
#include <string>
#include <vector>

#include "modules/stage/area.h"
#include "testbench/machine/simulation.h"

namespace tessera {

/// Hardware of the units or memories of one kind, added up.
struct UnitArea : Area {
    std::string name;  ///< "transform"
};

/// In the order of the figures. Kinds without hardware are left out; a cache counts as its table.
std::vector<UnitArea> area_of(const std::vector<Unit*>& units);

/// The area of a run's design, all machines together.
std::vector<UnitArea> area_of(const Simulation& simulation);

/// The sum, named "total".
UnitArea total_area(const std::vector<UnitArea>& units);

}  // namespace tessera

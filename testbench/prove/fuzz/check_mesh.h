#pragma once
#include "testbench/input/mesh/base_mesh.h"

namespace tessera::fuzz {

/// What base_mesh.h promises of every mesh, whatever it was read from.
void promise_complete(const BaseMesh& mesh);

}  // namespace tessera::fuzz

#pragma once
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera::fuzz {

/// Checks the guarantees of base_mesh.h for a mesh of any source.
void promise_complete(const BaseMesh& mesh);

}  // namespace tessera::fuzz

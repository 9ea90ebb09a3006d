#pragma once
#include <string>

#include "modules/datapath/format.h"
#include "testbench/machine/emitted_mesh.h"

namespace tessera {

/// "P (x, y, z) P' (x, y, z) N' (x, y, z) t (u, v) = texel (u, v) generation g", all but the texels in LSB.
std::string corner_text(const EmittedTriangle::Corner& corner, const datapath::Formats& formats);

}  // namespace tessera

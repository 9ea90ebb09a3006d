#include "testbench/check/mesh/corner_text.h"

#include <fmt/core.h>

#include <cmath>

namespace tessera {

std::string corner_text(const EmittedTriangle::Corner& corner, const datapath::Formats& formats) {
    const auto vector_text = [](const auto& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); };
    const auto texels = [&](std::uint32_t value) {
        return std::ldexp(static_cast<double>(value), -formats.texture.fraction);
    };
    const datapath::TexCoord& t = corner.texture;
    return fmt::format("P {} P' {} N' {} t ({}, {}) = texel ({:.4f}, {:.4f}) generation {}",
                       vector_text(corner.position), vector_text(corner.displaced),
                       vector_text(corner.displaced_normal), t.u, t.v, texels(t.u), texels(t.v),
                       int{corner.generation});
}

}  // namespace tessera

#include "testbench/check/mesh/violation_text.h"

#include <fmt/core.h>

#include <cmath>

namespace tessera {
namespace {

std::string position_text(const datapath::Position& p) {
    return fmt::format("({}, {}, {})", p.x, p.y, p.z);
}

std::string texture_text(const datapath::TexCoord& t, const datapath::Formats& formats) {
    const auto texels = [&](std::uint32_t value) {
        return std::ldexp(static_cast<double>(value), -formats.texture.fraction);
    };
    return fmt::format("t ({}, {}) = texel ({:.4f}, {:.4f})", t.u, t.v, texels(t.u), texels(t.v));
}

}  // namespace

std::string describe_corner(const EmittedMesh& mesh, CornerRef ref, const datapath::Formats& formats) {
    const auto& corner = corner_of(mesh, ref);
    return fmt::format("P {} P' {} {}", position_text(corner.position), position_text(corner.displaced),
                       texture_text(corner.texture, formats));
}

std::string describe_point(const SurfacePoint& point, const datapath::Formats& formats) {
    return fmt::format("P {} {}", position_text(point.position), texture_text(point.texture, formats));
}

}  // namespace tessera

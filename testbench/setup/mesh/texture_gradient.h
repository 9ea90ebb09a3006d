#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera {

/// Derivatives of the position by the texture coordinate inside one triangle.
struct TextureGradient {
    glm::dvec3 dp_du, dp_dv;  ///< model units per unit of u, of v
    bool mirrored;            ///< winding is opposite in texture space
    double area;              ///< of the triangle, square model units
    double texture_area;      ///< in units of u times v
};

/// Nothing if the triangle has no area in texture space (or so little that a gradient is not finite).
inline std::optional<TextureGradient> texture_gradient(const BaseMesh& mesh,
                                                       const std::array<std::uint32_t, 3>& triangle) {
    const BaseVertex& a = mesh.vertices[triangle[0]];
    const BaseVertex& b = mesh.vertices[triangle[1]];
    const BaseVertex& c = mesh.vertices[triangle[2]];
    const glm::dvec2 ab = b.texture - a.texture, ac = c.texture - a.texture;
    // same criterion of "no area" as for a triangle in space
    const glm::dvec3 facing =
        triangle_normal(glm::dvec3(a.texture, 0), glm::dvec3(b.texture, 0), glm::dvec3(c.texture, 0));
    if (facing.z == 0)
        return std::nullopt;
    const double determinant = ab.x * ac.y - ab.y * ac.x;
    const glm::dvec3 p = b.position - a.position, q = c.position - a.position;
    TextureGradient gradient;
    gradient.dp_du = (p * ac.y - q * ab.y) / determinant;
    gradient.dp_dv = (q * ab.x - p * ac.x) / determinant;
    gradient.mirrored = facing.z < 0;
    gradient.area = triangle_area(a.position, b.position, c.position);
    gradient.texture_area = std::abs(determinant) / 2;
    const double check = safe_length(gradient.dp_du) + safe_length(gradient.dp_dv);
    if (!std::isfinite(check))
        return std::nullopt;
    return gradient;
}

}  // namespace tessera

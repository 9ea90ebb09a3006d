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

/// Derivatives of a vector of the vertices by u and by v; the triangle has an area in texture space.
inline std::array<glm::dvec3, 2> by_texture(const BaseMesh& mesh, const std::array<std::uint32_t, 3>& triangle,
                                            glm::dvec3 BaseVertex::*vector) {
    const BaseVertex& a = mesh.vertices[triangle[0]];
    const BaseVertex& b = mesh.vertices[triangle[1]];
    const BaseVertex& c = mesh.vertices[triangle[2]];
    const glm::dvec2 ab = b.texture - a.texture, ac = c.texture - a.texture;
    const double determinant = ab.x * ac.y - ab.y * ac.x;
    const glm::dvec3 p = b.*vector - a.*vector, q = c.*vector - a.*vector;
    return {(p * ac.y - q * ab.y) / determinant, (q * ab.x - p * ac.x) / determinant};
}

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
    TextureGradient gradient;
    const auto [dp_du, dp_dv] = by_texture(mesh, triangle, &BaseVertex::position);
    gradient.dp_du = dp_du;
    gradient.dp_dv = dp_dv;
    gradient.mirrored = facing.z < 0;
    gradient.area = triangle_area(a.position, b.position, c.position);
    gradient.texture_area = std::abs(ab.x * ac.y - ab.y * ac.x) / 2;
    const double check = safe_length(gradient.dp_du) + safe_length(gradient.dp_dv);
    if (!std::isfinite(check))
        return std::nullopt;
    return gradient;
}

}  // namespace tessera

#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "testbench/render/image.h"
#include "testbench/render/render.h"
#include "testbench/render/render_mesh.h"
#include "testbench/render/style.h"
#include "testbench/render/view.h"

namespace tessera {

// Meshes and cameras for which the position of everything in the picture is known.

constexpr double pi = 3.14159265358979323846;

inline void add_quad(RenderMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({{a, b, c}, 0, DecidingTest::base});
    mesh.triangles.push_back({{a, c, d}, 1, DecidingTest::normal});
}

/// A sphere of radius 1 around `origin`.
inline RenderMesh make_sphere(const glm::dvec3& origin, std::uint32_t columns = 192) {
    const std::uint32_t rows = columns / 2;
    RenderMesh mesh;
    mesh.origin = origin;
    for (std::uint32_t row = 0; row <= rows; ++row)
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const double polar = pi * row / rows;
            const double angle = 2 * pi * column / columns;
            mesh.positions.emplace_back(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                                        std::cos(polar));
        }
    mesh.normals = mesh.positions;
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t first = row * (columns + 1) + column;
            add_quad(mesh, first, first + columns + 1, first + columns + 2, first + 1);
        }
    return mesh;
}

/// A square from -1 to 1 in x and y, facing +z, cut from lower left to upper right.
inline RenderMesh make_square() {
    RenderMesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    add_quad(mesh, 0, 1, 2, 3);
    return mesh;
}

inline View look_down(double distance, int width, int height, double focal) {
    View view;
    view.eye = {0, 0, distance};
    view.width = width;
    view.height = height;
    view.focal = focal;
    view.centre = glm::dvec2(width, height) / 2.0;
    view.near_plane = 0.01;
    return view;
}

inline std::vector<Image> render_styles(const RenderMesh& mesh, const View& view, const std::vector<Style>& styles) {
    std::vector<Image> images;
    for (Picture& picture : render_pictures(mesh, view, styles))
        images.push_back(std::move(picture.image));
    return images;
}

inline Image render(const RenderMesh& mesh, const View& view, const Style& style) {
    return render_styles(mesh, view, {style}).front();
}

inline bool is_background(const Image& image) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (image.at(x, y) != Style{}.background)
                return false;
    return true;
}

inline int brightness(const Image& image, int x, int y) {
    const Colour colour = image.at(x, y);
    return colour[0] + colour[1] + colour[2];
}

/// Quads side by side, each from x = 2 i - n to x = 2 i + 2 - n and from y = -1 to 1, facing +z; quad i has two
/// triangles.
inline RenderMesh make_row(std::uint32_t quads) {
    RenderMesh mesh;
    for (std::uint32_t i = 0; i <= quads; ++i)
        for (const float y : {-1.f, 1.f})
            mesh.positions.emplace_back(2.f * static_cast<float>(i) - static_cast<float>(quads), y, 0);
    mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
    for (std::uint32_t i = 0; i < quads; ++i)
        add_quad(mesh, 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
    return mesh;
}

}  // namespace tessera

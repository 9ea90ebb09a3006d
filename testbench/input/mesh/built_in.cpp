#include "testbench/input/mesh/built_in.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>

#include "testbench/common/error.h"
#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/setup/mesh/tangent_frames.h"
#include "testbench/setup/mesh/texture_scale.h"

namespace tessera {
namespace {

constexpr double pi = glm::pi<double>();

void check_count(const char* key, std::int64_t value, std::int64_t smallest) {
    if (value < smallest || value > largest_grid)
        throw InputError(fmt::format("{} = {}: must be {} to {} for this mesh", key, value, smallest, largest_grid));
}

void check_size(const char* key, double value) {
    if (!(value >= smallest_size && value <= largest_size)) {
        throw InputError(fmt::format("{} = {}: must be a length above 0, {:g} to {:g} model units", key, value,
                                     smallest_size, largest_size));
    }
}

void check_triangles(std::int64_t columns, std::int64_t rows) {
    const auto triangles = static_cast<std::size_t>(2 * columns * rows);
    if (triangles > largest_base_triangles) {
        throw ResourceError(
            fmt::format("mesh.columns = {} and mesh.rows = {} give {} base triangles, the limit is {}: "
                        "use fewer, the tessellator refines them",
                        columns, rows, triangles, largest_base_triangles));
    }
}

BaseMesh finished(BaseMesh mesh) {
    complete_tangent_frames(mesh);
    measure_texture_scale(mesh);
    return mesh;
}

/// Vertices of the grid lines first_row..last_row, all columns, row by row.
void add_rows(BaseMesh& mesh, std::int64_t columns, std::int64_t first_row, std::int64_t last_row,
              const std::function<BaseVertex(std::int64_t, std::int64_t)>& vertex) {
    for (std::int64_t j = first_row; j <= last_row; ++j)
        for (std::int64_t i = 0; i <= columns; ++i)
            mesh.vertices.push_back(vertex(i, j));
}

/// Two triangles per quad, for `rows` rows of quads on the first vertices of the mesh. alternate: diagonals alternate
/// like the colours of a chessboard.
void add_quads(BaseMesh& mesh, std::int64_t columns, std::int64_t rows, bool alternate = false) {
    const auto line = static_cast<std::uint32_t>(columns + 1);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j) {
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
            const std::uint32_t a = j * line + i, b = a + 1, c = b + line, d = a + line;
            const bool turned = alternate && (i + j) % 2 == 1;
            mesh.triangles.push_back(turned ? std::array{a, b, d} : std::array{a, b, c});
            mesh.triangles.push_back(turned ? std::array{b, c, d} : std::array{a, c, d});
        }
    }
}

/// The horizontal direction at column i. The seam's second copy uses the first one's index, so that both are
/// bit-identical.
glm::dvec2 around(std::int64_t i, std::int64_t columns) {
    const double angle = 2 * pi * static_cast<double>(i % columns) / static_cast<double>(columns);
    return {-std::sin(angle), std::cos(angle)};
}

double part(std::int64_t i, std::int64_t n) {
    return static_cast<double>(i) / static_cast<double>(n);
}

}  // namespace

BaseMesh make_plane(std::int64_t columns, std::int64_t rows, double width, double depth) {
    check_count("mesh.columns", columns, 1);
    check_count("mesh.rows", rows, 1);
    check_size("mesh.width", width);
    check_size("mesh.depth", depth);
    check_triangles(columns, rows);
    BaseMesh mesh;
    add_rows(mesh, columns, 0, rows, [&](std::int64_t i, std::int64_t j) {
        BaseVertex vertex;
        vertex.texture = {part(i, columns), part(j, rows)};
        // from integers, so that the plane is exactly symmetric
        vertex.position = {width * part(2 * i - columns, 2 * columns), depth * part(2 * j - rows, 2 * rows), 0};
        vertex.normal = {0, 0, 1};
        return vertex;
    });
    add_quads(mesh, columns, rows);
    return finished(std::move(mesh));
}

std::int64_t lattice_quads(std::int64_t texels, bool repeats, std::int64_t spacing) {
    const std::int64_t across = repeats ? texels : texels - 1;
    return std::max<std::int64_t>(1, (across + spacing - 1) / spacing);
}

BaseMesh make_lattice(const std::array<std::int64_t, 2>& texels, const std::array<bool, 2>& repeats,
                      std::int64_t spacing, double width, double depth) {
    check_size("mesh.width", width);
    check_size("mesh.depth", depth);
    const std::int64_t columns = lattice_quads(texels[0], repeats[0], spacing),
                       rows = lattice_quads(texels[1], repeats[1], spacing);
    check_triangles(columns, rows);
    BaseMesh mesh;
    mesh.beyond_map = true;
    add_rows(mesh, columns, 0, rows, [&](std::int64_t i, std::int64_t j) {
        BaseVertex vertex;
        vertex.texture = {part(2 * i * spacing + 1, 2 * texels[0]), part(2 * j * spacing + 1, 2 * texels[1])};
        vertex.position = {width * part(2 * i * spacing + 1 - texels[0], 2 * texels[0]),
                           depth * part(2 * j * spacing + 1 - texels[1], 2 * texels[1]), 0};
        vertex.normal = {0, 0, 1};
        return vertex;
    });
    add_quads(mesh, columns, rows, true);
    return finished(std::move(mesh));
}

BaseMesh make_cylinder(std::int64_t columns, std::int64_t rows, double radius, double height) {
    check_count("mesh.columns", columns, 3);
    check_count("mesh.rows", rows, 1);
    check_size("mesh.radius", radius);
    check_size("mesh.height", height);
    check_triangles(columns, rows);
    BaseMesh mesh;
    add_rows(mesh, columns, 0, rows, [&](std::int64_t i, std::int64_t j) {
        const glm::dvec2 out = around(i, columns);
        BaseVertex vertex;
        vertex.texture = {part(i, columns), part(j, rows)};
        vertex.position = {radius * out.x, radius * out.y, height * part(2 * j - rows, 2 * rows)};
        vertex.normal = {out, 0};
        return vertex;
    });
    add_quads(mesh, columns, rows);
    return finished(std::move(mesh));
}

BaseMesh make_sphere(std::int64_t columns, std::int64_t rows, double radius) {
    check_count("mesh.columns", columns, 3);
    check_count("mesh.rows", rows, 2);
    check_size("mesh.radius", radius);
    check_triangles(columns, rows - 1);
    BaseMesh mesh;
    add_rows(mesh, columns, 1, rows - 1, [&](std::int64_t i, std::int64_t j) {
        const double latitude = pi * part(2 * j - rows, 2 * rows);
        const glm::dvec2 out = around(i, columns) * std::cos(latitude);
        BaseVertex vertex;
        vertex.texture = {part(i, columns), part(j, rows)};
        vertex.normal = {out, std::sin(latitude)};
        vertex.position = radius * vertex.normal;
        return vertex;
    });
    add_quads(mesh, columns, rows - 2);

    const auto line = static_cast<std::uint32_t>(columns + 1);
    const std::uint32_t last_line = static_cast<std::uint32_t>(rows - 2) * line;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
        for (const bool north : {false, true}) {
            BaseVertex pole;
            pole.texture = {part(2 * std::int64_t{i} + 1, 2 * columns), north ? 1 : 0};
            pole.normal = {0, 0, north ? 1 : -1};
            pole.position = radius * pole.normal;
            const auto index = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.push_back(pole);
            if (north)
                mesh.triangles.push_back({last_line + i, last_line + i + 1, index});
            else
                mesh.triangles.push_back({i + 1, i, index});
        }
    }
    return finished(std::move(mesh));
}

}  // namespace tessera

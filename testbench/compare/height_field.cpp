#include "testbench/compare/height_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "testbench/bake/texel_centres.h"
#include "testbench/common/error.h"

namespace tessera {
namespace {

constexpr std::int64_t most_cells = std::int64_t{1} << 22;  // per band

/// Rows of a band, and its columns.
struct Band {
    GridRange columns, rows;

    std::size_t index(std::int64_t x, std::int64_t y) const {
        return static_cast<std::size_t>((y - rows.first) * (columns.last - columns.first + 1) + (x - columns.first));
    }
};

/// Calls at(x, y, height) for the band's grid points under a triangle, including its border; with a margin, in texels,
/// also for those beside it, with the height at about the triangle's nearest point.
template <class At>
void cover(const HeightField& field, const std::array<glm::dvec3, 3>& corners, const Band& band, double margin,
           At&& at) {
    std::array<glm::dvec2, 3> texel;
    std::array<double, 3> height{};
    for (std::size_t k = 0; k < 3; ++k) {
        texel[k] = field.texel(corners[k]);
        height[k] = field.height(corners[k]);
    }
    for_texel_centres(
        texel, band.columns, band.rows,
        [&](std::int64_t x, std::int64_t y, glm::dvec3 b) {
            if (margin > 0) {
                b = glm::max(b, 0.0);
                b /= b.x + b.y + b.z;
            }
            at(x, y, b.x * height[0] + b.y * height[1] + b.z * height[2]);
        },
        margin);
}

/// How far rounding moved the emitted mesh's vertices along the plane, in texels: the largest distance between a
/// vertex's place and its texture coordinate, which a repeating map may have taken back by whole periods.
double moved_by_rounding(const HeightField& field, const HeightMap& map, const RecordedMesh& mesh) {
    const glm::dvec2 size(map.width, map.height);
    double most = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        glm::dvec2 apart = field.texel(mesh.positions[v]) - mesh.textures[v] * size;
        apart -= size * glm::round(apart / size);
        most = std::max(most, glm::length(apart));
    }
    return std::min(most, 0.5);
}

}  // namespace

std::optional<HeightField> find_height_field(const BaseMesh& base, const HeightMap& map,
                                             const DisplacementOf& displacement, std::string& why) {
    constexpr double tolerance = 1e-6, texel_tolerance = 1e-3;
    const auto corner = [&](std::size_t triangle, std::size_t k) -> const BaseVertex& {
        return base.vertices[base.triangles[triangle][k]];
    };
    // The triangle with the largest texture area defines the plane and the affine function.
    std::size_t largest = base.triangles.size();
    double largest_area = 0;
    const auto texels = [&](std::size_t triangle) {
        std::array<glm::dvec2, 3> t;
        for (std::size_t k = 0; k < 3; ++k)
            t[k] = texel_of(corner(triangle, k), base, map, displacement);
        return t;
    };
    for (std::size_t k = 0; k < base.triangles.size(); ++k) {
        const auto t = texels(k);
        const double area = std::abs(cross(t[1] - t[0], t[2] - t[0]));
        if (area > largest_area) {
            largest_area = area;
            largest = k;
        }
    }
    why = "no base triangle has an area in texture space";
    if (largest == base.triangles.size())
        return std::nullopt;
    HeightField field;
    field.origin = corner(largest, 0).position;
    const glm::dvec3 p = corner(largest, 1).position - field.origin, q = corner(largest, 2).position - field.origin;
    const glm::dvec3 across = glm::cross(p, q);
    const double area = glm::length(across);
    why = "the base triangle that is largest in texture space has a zero or infinite area";
    if (!(area > 0) || !std::isfinite(area))
        return std::nullopt;
    field.normal = across / area;
    // dot(dual_p, p) = 1, dot(dual_p, q) = 0, and the other way round
    const glm::dvec3 dual_p = glm::cross(q, field.normal) / area, dual_q = glm::cross(field.normal, p) / area;
    const auto t = texels(largest);
    field.texel_origin = t[0];
    const glm::dvec2 along_p = t[1] - t[0], along_q = t[2] - t[0];
    field.u = along_p.x * dual_p + along_q.x * dual_q;
    field.v = along_p.y * dual_p + along_q.y * dual_q;

    // Heights are measured along the vertices' normals, whichever side of the triangle they are on.
    if (glm::dot(field.normal, corner(largest, 0).normal) < 0)
        field.normal = -field.normal;
    const auto [low, high] = bounds_of(base.vertices);
    const double size = glm::length(high - low);
    // The first violation is reported, in this order: all positions, all normals, all texture coordinates.
    const auto holds = [&](const char* else_why, const auto& test) {
        why = else_why;
        for (std::size_t k = 0; k < base.triangles.size(); ++k)
            for (std::size_t c = 0; c < 3; ++c)
                if (!test(corner(k, c)))
                    return false;
        return true;
    };
    if (!holds("the base mesh is not planar",
               [&](const BaseVertex& v) { return std::abs(field.height(v.position)) <= tolerance * size; }) ||
        !holds("the base mesh's normals are not perpendicular to its plane",
               [&](const BaseVertex& v) { return glm::length(v.normal - field.normal) <= tolerance; }) ||
        !holds("texture coordinates are not an affine function of position", [&](const BaseVertex& v) {
            const glm::dvec2 off = glm::abs(field.texel(v.position) - texel_of(v, base, map, displacement));
            return std::max(off.x, off.y) <= texel_tolerance;
        }))
        return std::nullopt;
    why.clear();
    return field;
}

VerticalError measure_vertical_error(const HeightField& field, const BaseMesh& base, const HeightMap& map,
                                     const DisplacementOf& displacement, const RecordedMesh& mesh,
                                     const ErrorView* view) {
    VerticalError result;
    result.map_unit = std::abs(displacement.scale) / map.source_units;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const auto& triangle : base.triangles)
        for (const std::uint32_t v : triangle) {
            const glm::dvec2 t = field.texel(base.vertices[v].position);
            low = glm::min(low, t);
            high = glm::max(high, t);
        }
    // A mesh that reaches beyond a clamped map has no grid points there.
    if (base.beyond_map && displacement.address_u == Addressing::clamp)
        high.x = std::min(high.x, static_cast<double>(map.width));
    if (base.beyond_map && displacement.address_v == Addressing::clamp)
        high.y = std::min(high.y, static_cast<double>(map.height));
    const GridRange columns = grid_lines(low.x, high.x), rows = grid_lines(low.y, high.y);
    const std::int64_t width = columns.last - columns.first + 1, height = rows.last - rows.first + 1;
    if (width < 1 || height < 1)
        return result;
    if (std::max(width, height) > std::int64_t{1} << 30 || width * height > std::int64_t{1} << 32)
        throw ResourceError(
            "the base mesh repeats the map so often that it has more than 2^32 grid points: compare a "
            "run with fewer repetitions");
    const double margin = moved_by_rounding(field, map, mesh);
    const std::int64_t band_rows = std::max<std::int64_t>(1, most_cells / width);
    constexpr float outside = -2, uncovered = -1;  // other values are errors
    std::vector<float> errors, pixels;             // per grid point
    double squares = 0, squared_pixels = 0;
    // inverse of field.texel() on the plane
    const glm::dvec3 across = glm::cross(field.u, field.v);
    const double area = glm::dot(across, across);
    const glm::dvec3 along_u = glm::cross(field.v, across) / area, along_v = glm::cross(across, field.u) / area;
    const auto on_plane = [&](std::int64_t x, std::int64_t y) {
        const glm::dvec2 away = glm::dvec2(x, y) + 0.5 - field.texel_origin;
        return field.origin + away.x * along_u + away.y * along_v;
    };
    for (std::int64_t first = rows.first; first <= rows.last; first += band_rows) {
        const Band band{columns, {first, std::min(rows.last, first + band_rows - 1)}};
        errors.assign(static_cast<std::size_t>(width * (band.rows.last - band.rows.first + 1)), outside);
        pixels.assign(view != nullptr ? errors.size() : 0, outside);
        for (const auto& t : base.triangles)
            cover(field, {base.vertices[t[0]].position, base.vertices[t[1]].position, base.vertices[t[2]].position},
                  band, 0, [&](std::int64_t x, std::int64_t y, double) { errors[band.index(x, y)] = uncovered; });
        const auto measure = [&](std::size_t k, double beside, float below_error) {
            cover(field, mesh.corners(mesh.triangles[k]), band, beside, [&](std::int64_t x, std::int64_t y, double at) {
                float& error = errors[band.index(x, y)];
                if (error == outside || error >= below_error)
                    return;
                const double wanted = displacement.of(
                    static_cast<double>(map.at(static_cast<int>(addressed(x, map.width, displacement.address_u)),
                                               static_cast<int>(addressed(y, map.height, displacement.address_v)))));
                const double off = std::abs(at - wanted);
                error = std::max(error, static_cast<float>(off));
                if (off > result.max) {
                    result.max = off;
                    result.worst_texel = glm::dvec2(x, y) + 0.5;
                    result.worst_triangle = k;
                    result.worst_position = on_plane(x, y) + wanted * field.normal;
                }
                if (view == nullptr)
                    return;
                const glm::dvec3 below = on_plane(x, y);
                if (const auto apart = view->apart(below + wanted * field.normal, below + at * field.normal)) {
                    float& seen = pixels[band.index(x, y)];
                    seen = std::max(seen, static_cast<float>(*apart));
                }
            });
        };
        for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
            measure(k, 0, std::numeric_limits<float>::infinity());
        // Rounding may have moved the mesh's border off the grid points that lie on it, as a lattice's do.
        if (std::find(errors.begin(), errors.end(), uncovered) != errors.end())
            for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
                measure(k, margin, 0);
        for (const float error : errors) {
            result.grid_points += error == outside ? 0 : 1;
            if (error < 0)
                continue;
            ++result.covered;
            squares += static_cast<double>(error) * static_cast<double>(error);
        }
        for (const float apart : pixels) {
            if (apart < 0)
                continue;
            ++result.seen;
            squared_pixels += static_cast<double>(apart) * static_cast<double>(apart);
            result.max_pixels = std::max(result.max_pixels, static_cast<double>(apart));
        }
    }
    if (result.seen > 0)
        result.rms_pixels = std::sqrt(squared_pixels / static_cast<double>(result.seen));
    if (result.covered > 0)
        result.rms = std::sqrt(squares / static_cast<double>(result.covered));
    return result;
}

}  // namespace tessera

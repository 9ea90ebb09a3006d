#include <fmt/format.h>

#include <algorithm>

#include "testbench/common/error.h"
#include "testbench/input/mesh/bezier_patches.h"
#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/input/mesh/mesh_text.h"
#include "testbench/input/mesh/surface_flaws.h"
#include "testbench/setup/mesh/equal_groups.h"
#include "testbench/setup/mesh/smooth_normals.h"
#include "testbench/setup/mesh/tangent_frames.h"
#include "testbench/setup/mesh/texture_scale.h"
#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera {
namespace {

using Curve = std::array<glm::dvec3, 4>;

constexpr double same_normal = 1e-6;  // per component
constexpr int most_normals = 64;      // distinct ones at one position
constexpr double vanishing = 1e-9;    // limit of a derivative relative to the patch's size

/// The parameter step / steps.
struct Place {
    std::int64_t step, steps;
    double value() const { return static_cast<double>(step) / static_cast<double>(steps); }
};

/// Interpolates between a and b. Exactly a or b at the ends and if both are equal, and bit-identical in either
/// direction, so that both patches of a border get the same points.
glm::dvec3 between(const glm::dvec3& a, const glm::dvec3& b, const Place& place) {
    if (place.step == 0 || a == b)
        return a;
    if (place.step == place.steps)
        return b;
    const double from_middle = static_cast<double>(2 * place.step - place.steps) / static_cast<double>(2 * place.steps);
    return (a + b) / 2.0 + from_middle * (b - a);
}

/// The two points of De Casteljau's next-to-last step: the curve's point lies between them, and its derivative is three
/// times their difference.
std::array<glm::dvec3, 2> last_two(Curve curve, const Place& place) {
    for (std::size_t left = 3; left > 1; --left)
        for (std::size_t i = 0; i < left; ++i)
            curve[i] = between(curve[i], curve[i + 1], place);
    return {curve[0], curve[1]};
}

glm::dvec3 point_on(const Curve& curve, const Place& place) {
    const auto [a, b] = last_two(curve, place);
    return between(a, b, place);
}

glm::dvec3 derivative(const Curve& curve, const Place& place) {
    const auto [a, b] = last_two(curve, place);
    return 3.0 * (b - a);
}

class Patch {
  public:
    Patch(const BezierPatches& patches, std::size_t number) {
        glm::dvec3 low(0), high(0);
        for (std::size_t k = 0; k < 16; ++k) {
            const glm::dvec3& p = patches.points[patches.patches[number][k]];
            along_u_[k / 4][k % 4] = p;
            along_v_[k % 4][k / 4] = p;
            low = k == 0 ? p : glm::min(low, p);
            high = k == 0 ? p : glm::max(high, p);
        }
        size_ = safe_length(high - low);
    }

    BaseVertex vertex(const Place& u, const Place& v) const {
        Curve across_u, across_v, slopes;
        for (std::size_t k = 0; k < 4; ++k) {
            across_u[k] = point_on(along_v_[k], v);
            across_v[k] = point_on(along_u_[k], u);
            slopes[k] = derivative(along_u_[k], u);
        }
        BaseVertex vertex;
        vertex.position = point_on(across_u, u);
        vertex.texture = {u.value(), v.value()};
        vertex.normal = normal(derivative(across_u, u), derivative(across_v, v), derivative(slopes, v), u, v);
        return vertex;
    }

  private:
    /// At a collapsed border dP/du is zero; to first order it is the mixed derivative times the distance from the
    /// border. Zero if that gives no normal.
    glm::dvec3 normal(glm::dvec3 du, glm::dvec3 dv, const glm::dvec3& mixed, const Place& u, const Place& v) const {
        const auto into = [](const Place& place) {
            return place.step == 0 ? 1.0 : place.step == place.steps ? -1.0 : 0.0;
        };
        const bool flat_u = safe_length(du) <= vanishing * size_, flat_v = safe_length(dv) <= vanishing * size_;
        if (flat_u && !flat_v)
            du = into(v) * mixed;
        else if (flat_v && !flat_u)
            dv = into(u) * mixed;
        const glm::dvec3 across = glm::cross(unit_or_zero(du), unit_or_zero(dv));
        return safe_length(across) > vanishing ? unit_or_zero(across) : glm::dvec3(0);
    }

    std::array<Curve, 4> along_u_, along_v_;
    double size_ = 0;
};

void check(const BezierPatches& patches, std::int64_t columns, std::int64_t rows, const std::string& name) {
    for (const auto& [key, value] : {std::pair{"mesh.columns", columns}, {"mesh.rows", rows}})
        if (value < 1 || value > largest_grid)
            throw InputError(fmt::format("{} = {}: must be 1 to {} for a patch mesh", key, value, largest_grid));
    const std::size_t triangles = 2 * static_cast<std::size_t>(columns * rows) * patches.patches.size();
    if (triangles > largest_base_triangles) {
        throw ResourceError(
            fmt::format("{}: mesh.columns = {} and mesh.rows = {} give {} base triangles on {} patches, the limit is "
                        "{}: use fewer, the tessellator refines them",
                        name, columns, rows, triangles, patches.patches.size(), largest_base_triangles));
    }
}

/// All vertices of all patches, patch by patch, row by row.
std::vector<BaseVertex> all_vertices(const BezierPatches& patches, std::int64_t columns, std::int64_t rows) {
    std::vector<BaseVertex> vertices;
    for (std::size_t k = 0; k < patches.patches.size(); ++k) {
        const Patch patch(patches, k);
        for (std::int64_t j = 0; j <= rows; ++j)
            for (std::int64_t i = 0; i <= columns; ++i)
                vertices.push_back(patch.vertex({i, columns}, {j, rows}));
    }
    return vertices;
}

/// Vertices at one position whose normals differ by rounding only get the normal of the first.
void share_normals(std::vector<BaseVertex>& vertices) {
    const std::vector<std::uint32_t> first = first_at_position(vertices);
    // The distinct normals at a position so far, as a list linked through their vertices.
    std::vector<std::uint32_t> next(vertices.size(), UINT32_MAX);
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        std::uint32_t k = first[i];
        for (int met = 0; k != i && met < most_normals; ++met) {
            const glm::dvec3 apart = glm::abs(vertices[k].normal - vertices[i].normal);
            if (std::max({apart.x, apart.y, apart.z}) <= same_normal) {
                vertices[i].normal = vertices[k].normal;
                break;
            }
            if (next[k] == UINT32_MAX)
                next[k] = i;
            k = next[k];
        }
    }
}

}  // namespace

BaseMesh make_patch_mesh(const BezierPatches& patches, std::int64_t columns, std::int64_t rows,
                         const std::string& name) {
    check(patches, columns, rows, name);
    std::vector<BaseVertex> vertices = all_vertices(patches, columns, rows);
    share_normals(vertices);

    BaseMesh mesh;
    std::vector<std::uint32_t> used(vertices.size(), UINT32_MAX);
    const auto keep = [&](std::array<std::uint32_t, 3> triangle) {
        if (triangle_normal(vertices[triangle[0]].position, vertices[triangle[1]].position,
                            vertices[triangle[2]].position) == glm::dvec3(0)) {
            ++mesh.dropped_degenerate;
            return;
        }
        for (std::uint32_t& i : triangle) {
            if (used[i] == UINT32_MAX) {
                used[i] = static_cast<std::uint32_t>(mesh.vertices.size());
                mesh.vertices.push_back(vertices[i]);
            }
            i = used[i];
        }
        mesh.triangles.push_back(triangle);
    };
    const auto line = static_cast<std::uint32_t>(columns + 1);
    const std::uint32_t lines = static_cast<std::uint32_t>(rows + 1) * line;
    for (std::uint32_t patch = 0; patch < patches.patches.size(); ++patch) {
        for (std::uint32_t j = 0; j < rows; ++j) {
            for (std::uint32_t i = 0; i < columns; ++i) {
                const std::uint32_t a = patch * lines + j * line + i, b = a + 1, c = b + line, d = a + line;
                keep({a, b, c});
                keep({a, c, d});
            }
        }
    }
    if (mesh.triangles.empty()) {
        throw InputError(
            fmt::format("{}: no triangle is left: all {} patch(es) are collapsed to a point or a line; "
                        "correct their points",
                        name, patches.patches.size()));
    }
    if (mesh.dropped_degenerate > 0) {
        mesh.repairs.push_back(fmt::format(
            "{} triangle(s) of zero area were dropped, as at collapsed borders of patches.", mesh.dropped_degenerate));
    }
    const auto [low, high] = bounds_of(mesh.vertices);
    require_size(high - low, name);
    const auto without_normal = std::count_if(mesh.vertices.begin(), mesh.vertices.end(),
                                              [](const BaseVertex& v) { return v.normal == glm::dvec3(0); });
    if (without_normal > 0) {
        mesh.repairs.push_back(
            fmt::format("{} vertices at cusps of their patches have no normal: replaced by smooth "
                        "normals.",
                        without_normal));
    }
    complete_smooth_normals(mesh);
    constexpr const char* smooth_normals =
        "Move the points beside a common border of patches so that both have one tangent plane there.";
    for (std::string& flaw : surface_flaws(mesh, largest_search, smooth_normals))
        mesh.repairs.push_back(std::move(flaw));
    complete_tangent_frames(mesh);
    measure_texture_scale(mesh);
    return mesh;
}

}  // namespace tessera

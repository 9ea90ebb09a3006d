#include "testbench/bake/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>

#include "testbench/bake/displaced_surface.h"
#include "testbench/bake/texel_centres.h"
#include "testbench/common/error.h"
#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera {
namespace {

constexpr std::uint64_t most_work = std::uint64_t{1} << 31;
constexpr std::uint32_t nobody = UINT32_MAX;

BakedMap empty_map(int width, int height) {
    BakedMap map;
    map.width = width;
    map.height = height;
    map.values.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), NAN);
    return map;
}

/// Gives the texels that are still NaN a height, and raises those below the floor.
void lay_floor(const QuadricSurface& surface, BakedMap& map) {
    double lowest = HUGE_VAL;
    for (const double value : map.values) {
        map.absent += std::isnan(value);
        if (value < lowest)
            lowest = value;
    }
    if (map.absent == map.values.size())
        throw InputError(fmt::format(
            "{}: the quadric was not found: none of {} x {} lines meets it within {:g} model units; move it, "
            "make it larger, or change the sampled region ([domain], --mesh)",
            surface.where, map.width, map.height, largest_displacement));
    map.floor = surface.floor.value_or(lowest);
    for (double& value : map.values) {
        map.raised += value < map.floor;
        if (!(value >= map.floor))
            value = map.floor;
    }
}

/// The centre of piece `part` of `parts` equal pieces from low to high; bit-identical from either end.
double centre_of(int part, int parts, double low, double high) {
    return (low * (2 * parts - 2 * part - 1) + high * (2 * part + 1)) / (2 * parts);
}

std::vector<BasisFunctions> at_centres(const std::vector<double>& knots, std::size_t degree, int texels) {
    std::vector<BasisFunctions> basis;
    basis.reserve(static_cast<std::size_t>(texels));
    for (int k = 0; k < texels; ++k)
        basis.push_back(basis_functions(knots, degree, parameter_at(knots, degree, centre_of(k, texels, 0, 1))));
    return basis;
}

BakedMap bake_patch(const NurbsPatch& patch, int width, int height) {
    BakedMap map = empty_map(width, height);
    const auto u = at_centres(patch.knots_u, patch.degree_u, width),
               v = at_centres(patch.knots_v, patch.degree_v, height);
    auto value = map.values.begin();
    for (const BasisFunctions& row : v)
        for (const BasisFunctions& column : u)
            *value++ = height_of(patch, column, row);
    return map;
}

/// The point of a triangle's border nearest to `p`, in barycentric coordinates.
glm::dvec3 nearest_on_border(const std::array<glm::dvec2, 3>& t, const glm::dvec2& p) {
    glm::dvec3 nearest(0);
    double least = HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const glm::dvec2 from = t[static_cast<std::size_t>(k)], edge = t[static_cast<std::size_t>(next)] - from;
        const double part = std::clamp(glm::dot(p - from, edge) / glm::dot(edge, edge), 0.0, 1.0);
        const double distance = glm::distance(p, from + part * edge);
        if (distance >= least)
            continue;
        least = distance;
        nearest = glm::dvec3(0);
        nearest[k] = 1 - part;
        nearest[next] = part;
    }
    return nearest;
}

/// Finds the texels that a mesh covers, or nearly, and their displacement.
class MeshSampler {
  public:
    MeshSampler(const QuadricSurface& surface, const BaseMesh& mesh, const Job::Map& map, int width, int height)
        : surface_(surface),
          addressing_{1, 0, map.address_u, map.address_v},
          baked_(empty_map(width, height)),
          owner_(baked_.values.size(), nobody),
          inside_(baked_.values.size()),
          overlaps_(baked_.values.size()) {
        size_.width = width;
        size_.height = height;
        const DisplacedSurface base(mesh, size_, addressing_, LocalFrame{});
        check_work(base);
        find_remedy(mesh);
        for (std::uint32_t k = 0; k < base.triangles(); ++k)
            sample(base.corners(k), k);
        if (std::count(owner_.begin(), owner_.end(), nobody) == 0)
            return;
        outside_.assign(owner_.size(), bake_margin);
        for (std::size_t k = 0; k < base.triangles(); ++k)
            continue_past(base.corners(k));
    }

    BakedMap take() {
        std::vector<std::uint32_t> covered;
        for (std::uint32_t k = 0; k < owner_.size(); ++k) {
            if (owner_[k] != nobody)
                covered.push_back(k);
            baked_.overlaps += overlaps_[k];
        }
        if (covered.empty())
            throw InputError("no texel's centre lies in a triangle of the base mesh's texture coordinates: " + remedy_);
        baked_.uncovered = owner_.size() - covered.size();
        // Texels without surface get their height before it spreads to their neighbours.
        std::vector<double> all = std::move(baked_.values);
        baked_.values.clear();
        for (const std::uint32_t k : covered)
            baked_.values.push_back(all[k]);
        lay_floor(surface_, baked_);
        for (std::size_t k = 0; k < covered.size(); ++k)
            all[covered[k]] = baked_.values[k];
        baked_.values = std::move(all);
        for (std::uint32_t k = 0; k < owner_.size(); ++k)
            if (owner_[k] == nobody && !std::isnan(baked_.values[k])) {
                owner_[k] = 0;
                covered.push_back(k);
                ++baked_.continued;
            }
        spread(std::move(covered));
        return std::move(baked_);
    }

  private:
    /// What to do if no texel is covered.
    void find_remedy(const BaseMesh& mesh) {
        std::vector<std::string> axes;
        for (const auto& [axis, mode, name] :
             {std::tuple{0, addressing_.address_u, "u"}, std::tuple{1, addressing_.address_v, "v"}})
            if (const int at = axis; mode == Addressing::clamp &&
                                     std::any_of(mesh.vertices.begin(), mesh.vertices.end(), [at](const BaseVertex& v) {
                                         return v.texture[at] < 0 || v.texture[at] > 1;
                                     }))
                axes.push_back(fmt::format("map.address_{} = \"repeat\"", name));
        remedy_ = axes.empty() ? "bake a larger map, or a mesh with texture coordinates"
                               : fmt::format("set {} in the base mesh's job, or move the coordinates into 0..1",
                                             fmt::join(axes, " and "));
    }

    void check_work(const DisplacedSurface& base) const {
        double work = 0;
        for (std::size_t k = 0; k < base.triangles(); ++k) {
            const auto [columns, rows] = grid_box(base.corners(k).texel);
            work += std::max(0.0, static_cast<double>(columns.last - columns.first) + 1) *
                    std::max(0.0, static_cast<double>(rows.last - rows.first) + 1);
        }
        if (work > static_cast<double>(most_work))
            throw ResourceError(
                fmt::format("the base mesh's triangles span {:g} texels together, the limit is {}: bake a "
                            "smaller map, or a mesh that repeats it less often",
                            work, most_work));
    }

    void sample(const DisplacedSurface::Corners& corners, std::uint32_t triangle) {
        const auto [columns, rows] = grid_box(corners.texel);
        for_texel_centres(corners.texel, columns, rows, [&](std::int64_t x, std::int64_t y, const glm::dvec3& b) {
            const std::size_t texel = texel_index(x, y);
            // A centre on an edge lies in both its triangles, which agree on the value.
            const bool inside = std::min({b.x, b.y, b.z}) > 1e-6;
            if (owner_[texel] != nobody) {
                overlaps_[texel] = overlaps_[texel] || (inside && inside_[texel]);
                return;
            }
            owner_[texel] = triangle;
            inside_[texel] = inside;
            const Foot foot(corners, b);
            if (const std::optional<double> t = displacement(foot))
                baked_.values[texel] = *t;
        });
    }

    /// Gives texels beside a triangle, which none covers, the surface over the triangle's plane and its linear normals,
    /// if no other triangle is nearer.
    void continue_past(const DisplacedSurface::Corners& corners) {
        const auto [columns, rows] = grid_box(corners.texel, bake_margin);
        const auto beyond = [](std::int64_t index, std::int64_t size, Addressing mode) {
            return mode == Addressing::clamp && (index < 0 || index >= size);
        };
        const auto beside = [&](std::int64_t x, std::int64_t y, const glm::dvec3& b) {
            if (beyond(x, baked_.width, addressing_.address_u) || beyond(y, baked_.height, addressing_.address_v))
                return;
            const std::size_t texel = texel_index(x, y);
            if (owner_[texel] != nobody)
                return;
            const glm::dvec3 nearest = nearest_on_border(corners.texel, glm::dvec2(x, y) + 0.5);
            const auto distance = static_cast<float>(glm::length(DisplacedSurface::texel(corners, b - nearest)));
            if (distance >= outside_[texel])
                return;
            outside_[texel] = distance;
            baked_.values[texel] = continued(Foot(corners, b), Foot(corners, nearest)).value_or(NAN);
        };
        for_texel_centres(corners.texel, columns, rows, beside, bake_margin);
    }

    /// Where a displacement begins.
    struct Foot {
        glm::dvec3 position, normal;
        Foot(const DisplacedSurface::Corners& corners, const glm::dvec3& b)
            : position(mixed(corners.position, b)), normal(unit_or_zero(mixed(corners.normal, b))) {}
        static glm::dvec3 mixed(const std::array<glm::dvec3, 3>& at, const glm::dvec3& b) {
            return b.x * at[0] + b.y * at[1] + b.z * at[2];
        }
    };

    std::optional<double> displacement(const Foot& foot) const {
        if (foot.normal == glm::dvec3(0))
            return {};
        return intersect(surface_.quadric, foot.position, foot.normal, surface_.root.value_or(Root::nearest));
    }

    /// The displacement at `outside`, if it continues that at `border`.
    std::optional<double> continued(const Foot& outside, const Foot& border) const {
        constexpr double steepest = 16;  // beyond, the line meets another part of the surface
        const std::optional<double> there = displacement(outside), here = displacement(border);
        if (!there || !here || std::abs(*there - *here) > steepest * glm::distance(outside.position, border.position))
            return {};
        return std::max(*there, surface_.floor.value_or(-HUGE_VAL));
    }

    /// Spreads values ring by ring, from all texels that have one.
    void spread(std::vector<std::uint32_t> reached) {
        for (std::size_t next = 0; next < reached.size(); ++next) {
            const std::int64_t at = reached[next], x = at % baked_.width, y = at / baked_.width;
            const std::array<std::array<std::int64_t, 2>, 4> neighbours{
                {{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}};
            for (const auto& [column, row] : neighbours) {
                const std::size_t texel = texel_index(column, row);
                if (owner_[texel] != nobody)
                    continue;
                owner_[texel] = owner_[reached[next]];
                baked_.values[texel] = baked_.values[reached[next]];
                reached.push_back(static_cast<std::uint32_t>(texel));
            }
        }
    }

    std::size_t texel_index(std::int64_t x, std::int64_t y) const {
        return static_cast<std::size_t>(addressed(y, baked_.height, addressing_.address_v) * baked_.width +
                                        addressed(x, baked_.width, addressing_.address_u));
    }

    const QuadricSurface& surface_;
    DisplacementOf addressing_;
    HeightMap size_;  // only the size is used
    BakedMap baked_;
    std::vector<std::uint32_t> owner_;  // the triangle that gave a texel its value
    std::string remedy_;
    std::vector<bool> inside_, overlaps_;
    std::vector<float> outside_;  // uncovered texels' distance from the nearest triangle, in texels
};

}  // namespace

BakedMap bake_heights(const Surface& surface, int width, int height) {
    if (const auto* const patch = std::get_if<NurbsPatch>(&surface.shape))
        return bake_patch(*patch, width, height);
    const auto& quadric = std::get<QuadricSurface>(surface.shape);
    BakedMap map = empty_map(width, height);
    auto value = map.values.begin();
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x, ++value) {
            const glm::dvec3 foot(centre_of(x, width, surface.low.x, surface.high.x),
                                  centre_of(y, height, surface.low.y, surface.high.y), 0);
            const std::optional<double> z =
                intersect(quadric.quadric, foot, {0, 0, 1}, quadric.root.value_or(Root::highest));
            if (z)
                *value = *z;
        }
    }
    lay_floor(quadric, map);
    return map;
}

BakedMap bake_over_mesh(const QuadricSurface& surface, const BaseMesh& mesh, const Job::Map& map, int width,
                        int height) {
    return MeshSampler(surface, mesh, map, width, height).take();
}

}  // namespace tessera

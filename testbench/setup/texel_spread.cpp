#include "testbench/setup/texel_spread.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "testbench/setup/mesh/texture_gradient.h"

namespace tessera {

namespace {

/// Parts of the surface by the error of N' there.
class Errors {
  public:
    void add(double error, double area) {
        const auto step = static_cast<std::size_t>(error * steps_per_degree);
        areas_[std::min(step, areas_.size() - 1)] += area;
        total_ += area;
        largest_ = std::max(largest_, error);
    }
    double median() const {
        double sum = 0;
        for (std::size_t k = 0; k < areas_.size(); ++k)
            if ((sum += areas_[k]) > 0.5 * total_)
                return static_cast<double>(k) / steps_per_degree;
        return 0;
    }
    double largest() const { return largest_; }
    double percent_beyond(double error) const {
        double sum = 0;
        for (auto k = static_cast<std::size_t>(error * steps_per_degree); k < areas_.size(); ++k)
            sum += areas_[k];
        return total_ > 0 ? 100 * sum / total_ : 0;
    }

  private:
    static constexpr std::size_t steps_per_degree = 100;
    // On the heap: a platform may prepare a scene on a SystemC thread's small stack.
    std::vector<double> areas_ = std::vector<double>(180 * steps_per_degree);
    double total_ = 0, largest_ = 0;
};

/// dp/du and dp/dv of one texel, world units, on axes along dp/du and perpendicular to it: (u, 0) and (across, up).
struct TexelAxes {
    double u, across, up;
};

/// dp_du and dp_dv: world units per unit of u, of v.
TexelAxes texel_axes(const glm::dvec3& dp_du, const glm::dvec3& dp_dv, const PreparedScene& scene) {
    const datapath::MapGeometry& map = scene.registers.map;
    const glm::dvec3 u = unit_or_zero(dp_du);
    const double across = glm::dot(dp_dv, u), up = safe_length(dp_dv - u * across);
    return {safe_length(dp_du) / map.width, across / map.height, up / map.height};
}

/// The normal, of any length, of a surface that rises by the given heights per texel.
glm::dvec3 normal_of(const glm::dvec2& rise, const TexelAxes& axes) {
    const double along = rise.x / axes.u;
    return {-along, -(rise.y - along * axes.across) / axes.up, 1};
}

/// Calls use(x, y) with the texel at a texture coordinate in texels.
template <class Use>
auto with_texel(const glm::dvec2& t, const PreparedScene& scene, Use use) {
    const datapath::MapGeometry& map = scene.registers.map;
    const auto texel = [](double value, std::uint32_t size, datapath::AddressMode mode) {
        const double index = std::floor(value), last = size - 1.0;
        const double inside = mode == datapath::AddressMode::repeat ? index - std::floor(index / size) * size : index;
        return static_cast<std::uint32_t>(std::clamp(inside, 0.0, last));
    };
    return use(texel(t.x, map.width, map.address_u), texel(t.y, map.height, map.address_v));
}

/// Heights per texel, before they are rounded to a normal map.
glm::dvec2 rise_at(const glm::dvec2& t, const PreparedScene& scene) {
    const auto [u, v] = with_texel(
        t, scene, [&](std::uint32_t x, std::uint32_t y) { return map_rise(scene.map, x, y, scene.height_per_code); });
    return {u, v};
}

/// The displacement, world units.
double height_at(const glm::dvec2& t, const PreparedScene& scene) {
    const datapath::Registers& r = scene.registers;
    return std::ldexp(static_cast<double>(r.displacement.bias), -r.formats.position.fraction) +
           scene.height_per_code *
               with_texel(t, scene, [&](std::uint32_t x, std::uint32_t y) { return scene.map.code(x, y); });
}

/// Calls use(t) at the centres of `parts` * `parts` equal parts of a triangle.
template <class Use>
void each_part(const std::array<glm::dvec2, 3>& t, int parts, Use use) {
    const auto at = [&](int i, int j, double inside) {
        const double a = (i + inside) / parts, b = (j + inside) / parts;
        use(t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]));
    };
    for (int i = 0; i < parts; ++i)
        for (int j = 0; i + j < parts; ++j) {
            at(i, j, 1 / 3.0);
            if (i + j + 1 < parts)
                at(i, j, 2 / 3.0);
        }
}

}  // namespace

TexelSpread measure_texel_spread(const BaseMesh& mesh, const PreparedScene& scene) {
    constexpr std::size_t most_points = 1 << 16;
    const BaseMesh::TextureScale& scale = mesh.texture_scale;
    TexelSpread spread;
    spread.mean = {scale.mean_u, scale.mean_v};
    spread.smallest = {scale.smallest_u, scale.smallest_v};
    spread.largest = {scale.largest_u, scale.largest_v};
    const std::size_t stride = 1 + mesh.triangles.size() / most_points, chosen = 1 + mesh.triangles.size() / stride;
    const double each = static_cast<double>(most_points) / static_cast<double>(chosen);
    const int parts = std::max(1, static_cast<int>(std::sqrt(each)));
    const glm::dvec2 texels(scene.registers.map.width, scene.registers.map.height);
    Errors errors, of_map, curved;
    const TexelAxes given{scene.texel_size[0], 0, scene.texel_size[1]};
    for (std::size_t k = 0; k < mesh.triangles.size(); k += stride) {
        const auto& triangle = mesh.triangles[k];
        const auto gradient = texture_gradient(mesh, triangle);
        if (!gradient)
            continue;
        const glm::dvec3 dp_du = gradient->dp_du * scene.scale, dp_dv = gradient->dp_dv * scene.scale;
        const TexelAxes own = texel_axes(dp_du, dp_dv, scene);
        const std::array<glm::dvec3, 2> turn = by_texture(mesh, triangle, &BaseVertex::normal);  // per unit of u, of v
        spread.shear = std::max(spread.shear, glm::degrees(std::atan2(std::abs(own.across), own.up)));
        std::array<glm::dvec2, 3> corners;
        for (std::size_t corner = 0; corner < 3; ++corner)
            corners[corner] = mesh.vertices[triangle[corner]].texture * texels;
        each_part(corners, parts, [&](const glm::dvec2& t) {
            const glm::dvec2 rise = rise_at(t, scene);
            const glm::dvec3 right = normal_of(rise, own);
            const double error = degrees_between(right, normal_of(rise, given));
            errors.add(error, gradient->area);
            of_map.add(error, gradient->texture_area);
            const double height = height_at(t, scene);
            const TexelAxes displaced = texel_axes(dp_du + height * turn[0], dp_dv + height * turn[1], scene);
            curved.add(degrees_between(right, normal_of(rise, displaced)), gradient->area);
        });
    }
    spread.median_error = errors.median();
    spread.largest_error = errors.largest();
    spread.wrong_percent = errors.percent_beyond(TexelSpread::noticeable);
    spread.wrong_map_percent = of_map.percent_beyond(TexelSpread::noticeable);
    spread.curved_median = curved.median();
    spread.curved_largest = curved.largest();
    spread.curved_percent = curved.percent_beyond(TexelSpread::noticeable);
    return spread;
}

std::string curved_base_remark(const TexelSpread& spread) {
    if (spread.curved_percent <= 1)
        return {};
    return fmt::format(
        "displacements are not small against the base mesh's radius of curvature, which N' leaves out: normals are off by "
        "more than {} degrees on {:.3g} % of the surface (median {:.3g}, at most {:.3g} degrees); heights are right. Use a "
        "base mesh nearer to the displaced surface",
        TexelSpread::noticeable, spread.curved_percent, spread.curved_median, spread.curved_largest);
}

std::string texel_spread_remark(const TexelSpread& spread) {
    if (spread.wrong_percent <= 1 && spread.wrong_map_percent <= 1)
        return {};
    std::string spread_of_map, remedy;
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}})
        if (spread.largest[axis] > 1.01 * spread.smallest[axis])
            spread_of_map += fmt::format("{}{:.3g} to {:.3g} model units {} ({:.3g} serves)",
                                         spread_of_map.empty() ? "a whole map is " : " and ", spread.smallest[axis],
                                         spread.largest[axis], axis == 0 ? "wide" : "high", spread.mean[axis]);
    if (!spread_of_map.empty())
        remedy = "with one texel density";
    if (spread.shear >= 1) {
        spread_of_map += fmt::format("{}its axes are up to {:.2g} degrees from perpendicular",
                                     spread_of_map.empty() ? "" : "; ", spread.shear);
        remedy += remedy.empty() ? "without shear" : " and without shear";
    }
    if (spread_of_map.empty()) {
        spread_of_map = "some have next to no area in it";
        remedy = "so that all have an area in the map";
    }
    return fmt::format(
        "one texel size serves the whole mesh, but its triangles spread the map differently: {}. Normals are off by more "
        "than {} degrees on {:.3g} % of the surface and {:.3g} % of the map there (median {:.3g}, at most {:.3g} degrees); "
        "heights are right. Unwrap the mesh {}",
        spread_of_map, TexelSpread::noticeable, spread.wrong_percent, spread.wrong_map_percent, spread.median_error,
        spread.largest_error, remedy);
}

}  // namespace tessera

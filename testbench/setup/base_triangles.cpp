#include "testbench/setup/base_triangles.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "testbench/common/error.h"
#include "testbench/setup/mesh/whole_periods.h"
#include "testbench/setup/rounding.h"

namespace tessera {

using datapath::Format;

namespace {

/// A lattice may extend beyond the map.
bool clamps(const BaseMesh& mesh, datapath::AddressMode mode) {
    return mode == datapath::AddressMode::clamp && !mesh.beyond_map;
}

constexpr double rounding = 1.0 / 16;  // texels; of the program that wrote a file

/// Whether a clamped border stretches the map across a triangle: one corner beyond it, another on its other side.
bool is_crossed(const std::array<double, 3>& at, std::uint32_t size) {
    const auto [least, most] = std::minmax_element(at.begin(), at.end());
    const double low = *least * size, high = *most * size;
    return (low < -rounding && high > rounding) || (high > size + rounding && low < size - rounding);
}

std::uint32_t to_texture(double coordinate, std::uint32_t size, bool clamp, const Format& format, bool& clamped) {
    double texels = coordinate * size;
    if (clamp) {
        clamped = texels < -rounding || texels > size + rounding;
        texels = std::clamp(texels, 0.0, static_cast<double>(size));
    }
    const double fixed = std::nearbyint(std::ldexp(texels, format.fraction));
    return static_cast<std::uint32_t>(fixed);
}

/// Moves texture coordinates by whole periods as near to 0 as possible, so that they fit their format.
BaseMesh with_low_texture(const BaseMesh& mesh, const datapath::MapGeometry& map, const Format& format) {
    const double texels = std::ldexp(1.0, format.bits - 1 - format.fraction);
    return bring_down_texture(
        mesh, {map.address_u == datapath::AddressMode::repeat, map.address_v == datapath::AddressMode::repeat},
        {texels / map.width, texels / map.height});
}

/// The largest texture coordinate on an axis that does not clamp.
struct TextureReach {
    double most = 0;        ///< texels
    double coordinate = 0;  ///< u or v
    std::uint32_t size = 0;
    double limit = 0;  ///< texels: the border bit holds 2^integer itself and nothing beyond
    bool fits = true;

    std::uint32_t fitting_size() const { return static_cast<std::uint32_t>(size * limit / most); }
};

TextureReach texture_reach(const BaseMesh& mesh, const datapath::MapGeometry& map, const Format& format) {
    TextureReach reach;
    const auto look = [&](double value, std::uint32_t side, datapath::AddressMode mode) {
        if (clamps(mesh, mode) || value * side <= reach.most)
            return;
        reach.most = value * side;
        reach.coordinate = value;
        reach.size = side;
    };
    for (const BaseVertex& vertex : mesh.vertices) {
        look(vertex.texture.x, map.width, map.address_u);
        look(vertex.texture.y, map.height, map.address_v);
    }
    reach.limit = std::ldexp(1.0, format.bits - 1 - format.fraction);
    reach.fits = std::nearbyint(std::ldexp(reach.most, format.fraction)) <= std::ldexp(reach.limit, format.fraction);
    return reach;
}

/// Throws InputError if a texture coordinate does not fit its format.
void check_texture(const BaseMesh& mesh, const datapath::MapGeometry& map, const Format& format) {
    const TextureReach reach = texture_reach(mesh, map, format);
    if (reach.fits)
        return;
    const int integer = static_cast<int>(std::ceil(std::log2(reach.most)));
    throw InputError(fmt::format(
        "texture coordinate {} is {} texels of a map of {}, beyond the 0..{} that the texture coordinate's format "
        "holds: {}use a map of at most {} texels a side{}",
        reach.coordinate, reach.most, reach.size, reach.limit,
        integer > datapath::FormatLimits::texture_integer.most
            ? ""
            : fmt::format("set formats.texture_integer = {}, or ", integer),
        reach.fitting_size(),
        mesh.beyond_map ? " or a smaller mesh.spacing" : ", or triangles that repeat it less often"));
}

/// What to do if texture coordinates beyond these clamped borders tile.
std::string tiling_remedy(const BaseMesh& mesh, datapath::MapGeometry map, const Format& format, bool beyond_u,
                          bool beyond_v) {
    if (beyond_u)
        map.address_u = datapath::AddressMode::repeat;
    if (beyond_v)
        map.address_v = datapath::AddressMode::repeat;
    const TextureReach reach = texture_reach(with_low_texture(mesh, map, format), map, format);
    const std::string remedy = !beyond_v   ? "set map.address_u = \"repeat\""
                               : !beyond_u ? "set map.address_v = \"repeat\""
                                           : "set map.address_u = \"repeat\" and map.address_v = \"repeat\"";
    return reach.fits ? remedy
                      : fmt::format("{}, with a map of at most {} texels a side", remedy, reach.fitting_size());
}

}  // namespace

void round_base_triangles(const BaseMesh& original, const ModelScale& model_scale, PreparedScene& scene) {
    const datapath::Formats& formats = scene.registers.formats;
    const datapath::MapGeometry& map = scene.registers.map;
    InputSaturations& saturated = scene.input_saturations;
    const BaseMesh mesh = with_low_texture(original, map, formats.texture);
    bool clamped_u = false, clamped_v = false;
    check_texture(mesh, map, formats.texture);
    std::vector<datapath::Vertex> vertices;
    vertices.reserve(mesh.vertices.size());
    for (const BaseVertex& base : mesh.vertices) {
        const glm::dvec3 world = model_scale.to_world(base.position);
        datapath::Vertex vertex;
        vertex.position = {to_format(world.x, formats.position, saturated.position),
                           to_format(world.y, formats.position, saturated.position),
                           to_format(world.z, formats.position, saturated.position)};
        vertex.normal = to_direction(base.normal, formats.normal, saturated.normal);
        vertex.tangent = to_direction(base.tangent, formats.normal, saturated.normal);
        vertex.handedness = base.handedness < 0 ? std::int8_t{-1} : std::int8_t{1};
        bool beyond_u = false, beyond_v = false;
        vertex.texture = {
            to_texture(base.texture.x, map.width, clamps(mesh, map.address_u), formats.texture, beyond_u),
            to_texture(base.texture.y, map.height, clamps(mesh, map.address_v), formats.texture, beyond_v)};
        scene.texture_clamped += beyond_u || beyond_v ? 1 : 0;
        clamped_u = clamped_u || beyond_u;
        clamped_v = clamped_v || beyond_v;
        vertices.push_back(vertex);
    }
    const auto is_stretched = [&](const std::array<std::uint32_t, 3>& corners) {
        std::array<double, 3> u{}, v{};
        for (std::size_t k = 0; k < 3; ++k) {
            u[k] = mesh.vertices[corners[k]].texture.x;
            v[k] = mesh.vertices[corners[k]].texture.y;
        }
        return (clamped_u && is_crossed(u, map.width)) || (clamped_v && is_crossed(v, map.height));
    };
    const auto same = [](const datapath::Vertex& a, const datapath::Vertex& b) {
        return a.position == b.position && a.texture == b.texture;
    };
    for (const auto& corners : mesh.triangles) {
        datapath::Triangle triangle;
        triangle.vertices = {vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]};
        const auto& v = triangle.vertices;
        if (same(v[0], v[1]) || same(v[1], v[2]) || same(v[2], v[0])) {
            ++scene.base_dropped;
            continue;
        }
        triangle.base = static_cast<std::uint32_t>(scene.base_triangles.size());
        scene.base_triangles.push_back(triangle);
    }
    if (scene.base_triangles.empty())
        throw InputError(
            "every base triangle collapses when rounded to the position's and texture coordinate's formats: "
            "use wider formats (formats.position_bits, formats.texture_fraction)");
    if (scene.base_dropped > 0)
        scene.remarks.push_back(
            fmt::format("{} base triangles collapsed when rounded to the hardware's formats, and were dropped",
                        scene.base_dropped));
    if (scene.texture_clamped > 0) {
        const auto stretched = std::count_if(mesh.triangles.begin(), mesh.triangles.end(), is_stretched);
        scene.remarks.push_back(fmt::format(
            "{} base vertices have texture coordinates outside 0..1, and were set to the map's border, where "
            "normals are not right{}; if they tile, {}, else move them into 0..1",
            scene.texture_clamped,
            stretched > 0
                ? fmt::format("; that stretches the map across {} triangles, and heights and normals within it "
                              "are wrong: cut the mesh along the border",
                              stretched)
                : "",
            tiling_remedy(original, map, formats.texture, clamped_u, clamped_v)));
    }
}

}  // namespace tessera

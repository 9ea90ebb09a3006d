#include "testbench/check/conformance/texel_borders.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "testbench/input/mesh/make_base_mesh.h"
#include "testbench/job/job_keys.h"

namespace tessera {

namespace {

/// Coordinates in a file are truncated decimals, so that thirds miss the border in exact arithmetic, too. With 10 % of
/// the edges one LSB below a border 0.2 % of the decisions differed (the cylinder of a scanned head), with 67 % (256
/// texels on 3 quads) 15.6 %.
constexpr double least_share_of_a_file = 0.2;

/// Whether the texture format represents the base vertices' coordinates exactly on an axis of `quads` quads: texels *
/// 2^fraction is a multiple of quads.
bool held(std::int64_t texels, std::int64_t quads, std::int64_t fraction) {
    return (texels << fraction) % quads == 0;
}

std::int64_t highest(const char* key) {
    return static_cast<std::int64_t>(find_key(key)->range.high);
}

std::string axis_remedy(const Job& job, const char* map_key, const char* quads_key, std::int64_t texels,
                        std::int64_t quads) {
    const std::int64_t fraction = job.formats.texture_fraction;
    if (held(texels, quads, fraction))
        return {};
    std::string text;
    // Eight texels per quad: the first three halvings fall on borders exactly.
    const std::int64_t multiple = 8 * quads;
    const std::int64_t largest = highest(map_key) / multiple * multiple;
    if (job.map.source != MapSource::file && largest > 0)
        text = fmt::format("{} = {} (a multiple of {} quads), or ", map_key,
                           std::min((texels + multiple - 1) / multiple * multiple, largest), quads);
    std::int64_t other = quads + 1;
    while (other <= highest(quads_key) && !held(texels, other, fraction))
        ++other;
    if (other > highest(quads_key))
        for (other = quads - 1; !held(texels, other, fraction);)
            --other;
    return text + fmt::format("{} = {} for a map of {} texels", quads_key, other, texels);
}

}  // namespace

TexelBorders::TexelBorders(const datapath::Formats& formats)
    : count_{formats.texture.fraction}, fraction_((std::uint32_t{1} << formats.texture.fraction) - 1) {}

void TexelBorders::write(const datapath::TrianglePass& pass) {
    const auto& v = pass.triangle.vertices;
    const std::array<bool, 3> ends = {below(v[0].texture), below(v[1].texture), below(v[2].texture)};
    for (std::size_t k = 0; k < 3; ++k) {
        if (((pass.triangle.final_edges | pass.shared) >> k & 1u) != 0)
            continue;
        ++count_.edges;
        count_.below += ends[k] || ends[(k + 1) % 3] || below(pass.edges[k].texture) ? 1u : 0u;
    }
}

bool TexelBorderCount::many() const {
    constexpr double least_share = 0.01;
    // Two coordinates of three vertices, each below a border with a probability of 1 in 2^fraction.
    const double by_chance = 6 * std::ldexp(1.0, -fraction);
    const double share = edges == 0 ? 0 : static_cast<double>(below) / static_cast<double>(edges);
    return share > least_share && share > 2 * by_chance;
}

std::string texel_borders_warning(const TexelBorderCount& count, const Job& job, std::int64_t width,
                                  std::int64_t height) {
    if (!count.many())
        return {};
    const auto [columns, rows] = quads_of(job.mesh);
    const double share = static_cast<double>(count.below) / static_cast<double>(count.edges);
    std::string remedy;
    if (columns > 0) {
        remedy = axis_remedy(job, "map.width", "mesh.columns", width, columns);
        const std::string other = axis_remedy(job, "map.height", "mesh.rows", height, rows);
        if (!remedy.empty() && !other.empty())
            remedy += "; ";
        remedy += other;
    } else if (share > least_share_of_a_file) {
        remedy =
            fmt::format("a mesh with texture coordinates at whole texels, multiples of 1/{} and 1/{}", width, height);
    }
    if (remedy.empty())
        return {};
    return fmt::format(
        "{} of {} edges ({:.1f} %) have an end or midpoint that rounding puts one LSB below a texel's "
        "border, "
        "so that it reads the preceding texel; wider formats do not help. Use {}",
        count.below, count.edges, 100 * share, remedy);
}

}  // namespace tessera

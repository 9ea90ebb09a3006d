#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"
#include "testbench/common/random.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/setup/quantised_map.h"
#include "testbench/tests/support/source_folder.h"

namespace tessera::tables_test {

using datapath::AddressMode;
using datapath::TexCoord;
using Corners = std::array<TexCoord, 3>;

inline std::uint32_t distance(std::uint32_t a, std::uint32_t b) {
    return a > b ? a - b : b - a;
}
inline TexCoord middle_of(const TexCoord& a, const TexCoord& b) {
    return {(a.u + b.u) >> 1, (a.v + b.v) >> 1};
}
/// Whether the hardware's Rank and Bound Tests evaluate the edge at all.
inline bool differs_by_even_texels(const TexCoord& a, const TexCoord& b, const datapath::Formats& formats) {
    const std::uint32_t two_texels = std::uint32_t{2} << formats.texture.fraction;
    return !(a == b) && distance(a.u, b.u) % two_texels == 0 && distance(a.v, b.v) % two_texels == 0;
}

/// The hardware's recursion with the cut `greatest_rank`, from its specification: the split edge of greatest rank is
/// bisected; among equals the longer, then the first. splits(a, b) and rank(a, b) are those of an edge.
template <class Splits, class Rank>
void refine(const Corners& t, const Splits& splits, const Rank& rank, std::vector<Corners>& finished) {
    int chosen = -1;
    std::array<std::uint64_t, 2> best{};
    for (int k = 0; k < 3; ++k) {
        const TexCoord &a = t[static_cast<std::size_t>(k)], &b = t[static_cast<std::size_t>((k + 1) % 3)];
        if (!splits(a, b))
            continue;
        const std::array<std::uint64_t, 2> order{rank(a, b), distance(a.u, b.u) + distance(a.v, b.v)};
        if (chosen < 0 || order > best) {
            chosen = k;
            best = order;
        }
    }
    if (chosen < 0) {
        finished.push_back(t);
        return;
    }
    const auto k = static_cast<std::size_t>(chosen);
    Corners first = t, second = t;
    first[(k + 1) % 3] = second[k] = middle_of(t[k], t[(k + 1) % 3]);
    refine(first, splits, rank, finished);
    refine(second, splits, rank, finished);
}

template <class Splits, class Rank>
std::vector<Corners> refine_all(const std::vector<Corners>& base, const Splits& splits, const Rank& rank) {
    std::vector<Corners> finished;
    for (const Corners& triangle : base)
        refine(triangle, splits, rank, finished);
    return finished;
}

/// A table with one entry per texel, read like the hardware does.
struct TexelTable {
    const std::vector<std::uint16_t>& entries;
    std::uint32_t columns, rows;
    int fraction;

    std::uint32_t at(const TexCoord& t) const {
        return entries[std::size_t{(t.v >> fraction) % rows} * columns + (t.u >> fraction) % columns];
    }
    std::uint32_t of_edge(const TexCoord& a, const TexCoord& b) const { return at(middle_of(a, b)); }
};

inline std::vector<Corners> mesh_of(const std::vector<Corners>& base, const TexelTable& table, std::uint32_t threshold,
                                    const datapath::Formats& formats) {
    return refine_all(
        base,
        [&](const TexCoord& a, const TexCoord& b) {
            return differs_by_even_texels(a, b, formats) && table.of_edge(a, b) > threshold;
        },
        [&](const TexCoord& a, const TexCoord& b) { return table.of_edge(a, b); });
}

inline std::uint32_t within(std::uint32_t index, std::uint32_t size, AddressMode mode) {
    return mode == AddressMode::repeat ? index % size : std::min(index, size - 1);
}
inline double code_at(const QuantisedMap& map, const TexCoord& t, int fraction) {
    const datapath::MapGeometry& g = map.geometry;
    return map.code(within(t.u >> fraction, g.width, g.address_u), within(t.v >> fraction, g.height, g.address_v));
}

/// The vertical error at every grid point, in codes; for a point in several triangles the largest. heights: those of
/// the vertices; null: the map's.
inline std::vector<double> vertical_errors(const QuantisedMap& map, const std::vector<Corners>& mesh, int fraction,
                                           const QuantisedMap* heights = nullptr) {
    const datapath::MapGeometry& g = map.geometry;
    std::vector<double> errors(map.codes.size(), 0);
    const double texel = std::ldexp(1.0, fraction);
    for (const Corners& t : mesh) {
        std::array<double, 3> x{}, y{}, z{};
        for (std::size_t k = 0; k < 3; ++k) {
            x[k] = t[k].u / texel - 0.5;
            y[k] = t[k].v / texel - 0.5;
            z[k] = code_at(heights != nullptr ? *heights : map, t[k], fraction);
        }
        const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        if (area == 0)
            continue;
        const auto [left, right] = std::minmax({x[0], x[1], x[2]});
        const auto [bottom, top] = std::minmax({y[0], y[1], y[2]});
        for (int row = static_cast<int>(std::ceil(bottom)); row <= top; ++row) {
            for (int column = static_cast<int>(std::ceil(left)); column <= right; ++column) {
                const auto c = static_cast<std::uint32_t>(column), r = static_cast<std::uint32_t>(row);
                if ((g.address_u == AddressMode::clamp && c >= g.width) ||
                    (g.address_v == AddressMode::clamp && r >= g.height))
                    continue;
                const double b = ((column - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (row - y[0])) / area;
                const double d = ((x[1] - x[0]) * (row - y[0]) - (column - x[0]) * (y[1] - y[0])) / area;
                if (b < -1e-12 || d < -1e-12 || b + d > 1 + 1e-12)
                    continue;
                const std::size_t texel_number = std::size_t{r % g.height} * g.width + c % g.width;
                const double error = z[0] + b * (z[1] - z[0]) + d * (z[2] - z[0]) - map.codes[texel_number];
                errors[texel_number] = std::max(errors[texel_number], std::abs(error));
            }
        }
    }
    return errors;
}

struct ErrorFigures {
    double rms = 0, largest = 0;
};

inline ErrorFigures error_figures(const std::vector<double>& errors) {
    ErrorFigures figures;
    for (const double error : errors) {
        figures.rms += error * error;
        figures.largest = std::max(figures.largest, error);
    }
    figures.rms = std::sqrt(figures.rms / static_cast<double>(errors.size()));
    return figures;
}

/// The number of edges that are not shared by exactly two triangles, also modulo whole periods, and do not lie on the
/// border of the base mesh's rectangle; 0 for a mesh without cracks over a rectangle.
inline std::size_t count_cracks(const std::vector<Corners>& mesh, const datapath::MapGeometry& map,
                                const datapath::Formats& formats) {
    const auto period = [&](std::uint32_t side, AddressMode mode) {
        return mode == AddressMode::repeat ? side << formats.texture.fraction : 0xffffffffU;
    };
    const std::uint32_t period_u = period(map.width, map.address_u), period_v = period(map.height, map.address_v);
    std::array<std::uint32_t, 2> most{};
    std::map<std::array<std::uint32_t, 4>, int> triangles_at;
    for (const Corners& t : mesh) {
        for (std::size_t k = 0; k < 3; ++k) {
            TexCoord a = t[k], b = t[(k + 1) % 3];
            most = {std::max(most[0], a.u), std::max(most[1], a.v)};
            if (std::array{b.u, b.v} < std::array{a.u, a.v})
                std::swap(a, b);
            ++triangles_at[{a.u % period_u, a.v % period_v, b.u - a.u, b.v - a.v}];
        }
    }
    std::size_t cracks = 0;
    const std::uint32_t first = (std::uint32_t{1} << formats.texture.fraction) / 2;
    for (const auto& [edge, count] : triangles_at) {
        const bool across = edge[2] == 0 && (edge[0] == first || edge[0] == most[0]);
        const bool along = edge[3] == 0 && (edge[1] == first || edge[1] == most[1]);
        const bool on_border =
            (across && map.address_u == AddressMode::clamp) || (along && map.address_v == AddressMode::clamp);
        cracks += count != (on_border ? 1 : 2) ? 1 : 0;
    }
    return cracks;
}

inline QuantisedMap empty_map(std::uint32_t width, std::uint32_t height, AddressMode u, AddressMode v) {
    QuantisedMap map;
    map.geometry = {width, height, u, v};
    map.codes.assign(std::size_t{width} * height, 0);
    return map;
}

/// The base mesh of mesh.source = "lattice" over the map, in the form that the tables take.
inline std::vector<Corners> lattice_triangles(const datapath::MapGeometry& map, std::uint32_t spacing,
                                              const datapath::Formats& formats) {
    const BaseMesh mesh =
        make_lattice({map.width, map.height},
                     {map.address_u == AddressMode::repeat, map.address_v == AddressMode::repeat}, spacing, 1, 1);
    const auto place = [&](double t, std::uint32_t side) {
        return static_cast<std::uint32_t>(std::llround(std::ldexp(t * side, formats.texture.fraction)));
    };
    std::vector<Corners> triangles;
    for (const auto& vertices : mesh.triangles) {
        Corners& corners = triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec2& texture = mesh.vertices[vertices[k]].texture;
            corners[k] = {place(texture.x, map.width), place(texture.y, map.height)};
        }
    }
    return triangles;
}

/// Noise, steps, a few spikes or slopes, at full scale or a few codes.
inline QuantisedMap random_map(Random& random, std::uint32_t width, std::uint32_t height, AddressMode u,
                               AddressMode v) {
    QuantisedMap map = empty_map(width, height, u, v);
    const auto kind = random.bits() % 4;
    const std::int64_t most = random.coin() ? 65535 : random.integer(1, 300);
    const double slope_u = random.real(0, 1), slope_v = random.real(0, 1);
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const double slope = 0.25 * (2 + std::sin(slope_u * x) + std::sin(slope_v * y));
            const std::int64_t code = kind == 0   ? random.integer(0, most)
                                      : kind == 1 ? (random.chance(3) ? most : 0)
                                      : kind == 2 ? (x * 3 > width ? most : 0)
                                                  : static_cast<std::int64_t>(slope * static_cast<double>(most));
            map.codes[std::size_t{y} * width + x] = static_cast<std::uint16_t>(code);
        }
    }
    return map;
}

/// The west half of Crater Lake in codes of 16 bits, and the metres per code.
struct CraterLake {
    QuantisedMap map;
    double metres = 0;

    CraterLake() {
        HeightMap heights = read_height_map(source_folder() / "testbench/examples/jobs/crater_lake_west.png");
        const auto [low, high] = std::minmax_element(heights.values.begin(), heights.values.end());
        heights.range_low = static_cast<double>(*low);
        heights.range_high = static_cast<double>(*high);
        map = quantise_map(heights, 16, AddressMode::clamp, AddressMode::clamp);
        metres = (heights.range_high - heights.range_low) * heights.source_units / 65535;
    }
};

/// The least threshold whose mesh has at most `triangles` triangles. mesh(threshold): larger thresholds, fewer of them.
template <class Mesh>
std::uint32_t threshold_for(std::size_t triangles, std::uint32_t highest, const Mesh& mesh) {
    std::uint32_t low = 0, high = highest;
    while (low < high) {
        const std::uint32_t between = low + (high - low) / 2;
        if (mesh(between).size() <= triangles)
            high = between;
        else
            low = between + 1;
    }
    return low;
}

}  // namespace tessera::tables_test

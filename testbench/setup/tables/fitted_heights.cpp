#include "testbench/setup/tables/fitted_heights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace tessera {

namespace {

using Weights = std::array<double, 3>;

constexpr int most_rounds = 16;

std::uint32_t within(std::int64_t index, std::uint32_t size, datapath::AddressMode mode) {
    const std::int64_t count = size;
    if (mode == datapath::AddressMode::repeat)
        return static_cast<std::uint32_t>((index % count + count) % count);
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(index, 0, count - 1));
}

/// Heights at texel centres, in codes; NaN where there are none.
struct Heights {
    const datapath::MapGeometry& map;
    std::array<double, 2> texel;
    std::vector<float> codes;

    /// Distance of a point from these heights, joined by straight lines along rows and columns. u, v: from the centre of
    /// the first texel, in texels.
    double distance(double u, double v, double height) const {
        const auto column = static_cast<std::int64_t>(std::floor(u + 0.5)),
                   row = static_cast<std::int64_t>(std::floor(v + 0.5));
        const double smallest = std::min(texel[0], texel[1]);
        double least = std::numeric_limits<double>::infinity();
        for (std::int64_t ring = 0; ring <= farthest; ++ring) {
            const double near = std::max(static_cast<double>(ring) - 1.5, 0.0) * smallest;
            if (near * near >= least)
                break;
            for (std::int64_t y = row - ring; y <= row + ring; ++y) {
                const std::int64_t step = y == row - ring || y == row + ring || ring == 0 ? 1 : 2 * ring;
                for (std::int64_t x = column - ring; x <= column + ring; x += step) {
                    const double above = code(x, y) - height;
                    const double across = (static_cast<double>(x) - u) * texel[0],
                                 along = (static_cast<double>(y) - v) * texel[1];
                    const double to_right = to_line(across, texel[0], above, code(x + 1, y) - height) + along * along,
                                 upwards = to_line(along, texel[1], above, code(x, y + 1) - height) + across * across;
                    least = to_right < least ? to_right : least;  // false for NaN
                    least = upwards < least ? upwards : least;
                }
            }
        }
        return std::sqrt(least);
    }

    double distance(std::size_t at, double height) const {
        const std::size_t row = at / map.width;
        return distance(static_cast<double>(at % map.width), static_cast<double>(row), height);
    }

  private:
    static constexpr std::int64_t farthest = 16;  // texels

    double code(std::int64_t x, std::int64_t y) const {
        return static_cast<double>(
            codes[std::size_t{within(y, map.height, map.address_v)} * map.width + within(x, map.width, map.address_u)]);
    }

    /// Squared distance of the origin from the line from (x, from) to (x + size, to); to (x, from) if `to` is NaN.
    static double to_line(double x, double size, double from, double to) {
        const double rise = std::isnan(to) ? 0 : to - from, length = std::isnan(to) ? 0 : size;
        const double squared = length * length + rise * rise;
        const double part = squared > 0 ? std::clamp(-(x * length + from * rise) / squared, 0.0, 1.0) : 0;
        const double across = x + part * length, above = from + part * rise;
        return across * across + above * above;
    }
};

/// Sums of squares, and the largest distances, over the grid points of a mesh.
struct Errors {
    double vertical = 0, to_surface = 0, to_mesh = 0;
    double largest_to_surface = 0, largest_to_mesh = 0;

    bool exceed(const Errors& other) const {
        return vertical > other.vertical || to_surface > other.to_surface || to_mesh > other.to_mesh ||
               largest_to_surface > other.largest_to_surface || largest_to_mesh > other.largest_to_mesh;
    }
};

class HeightFit {
  public:
    HeightFit(const QuantisedMap& map, const std::vector<TextureTriangle>& mesh, const datapath::Formats& formats,
              const std::array<double, 2>& texel)
        : map_(map),
          mesh_(mesh),
          formats_(formats),
          vertex_of_(map.codes.size(), none),
          surface_{map.geometry, texel, {map.codes.begin(), map.codes.end()}} {
        triangles_.resize(mesh.size());
        for (std::size_t t = 0; t < mesh.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                triangles_[t].vertex[k] = vertex_at(mesh[t][k]);
        std::vector<bool> covered(map.codes.size(), false);
        std::size_t points = 0, again = 0;
        for_each_point([&](Triangle& triangle, std::size_t at, const Weights& weight) {
            ++points;
            if (covered[at])
                ++again;
            covered[at] = true;
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t j = 0; j < 3; ++j)
                    triangle.product[k][j] += weight[k] * weight[j];
                triangle.code[k] += weight[k] * map.codes[at];
            }
        });
        constexpr std::size_t few = 16;  // slivers that rounding turns over cover some texels a second time
        shares_texels_ = again > points / few;
        corners_.resize(vertices_.size());
        for (std::size_t t = 0; t < mesh.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                corners_[triangles_[t].vertex[k]].push_back({t, k});
    }

    Heights own_mesh() { return heights_of_mesh(&Vertex::own); }
    Errors own_errors(const Heights& own_mesh) { return errors_of(own_mesh, &Vertex::own); }

    /// The heights of least squares, held against the distances of the mesh with the map's own heights.
    QuantisedMap fit(const Heights& own_mesh, const Errors& own) {
        relax();
        for (int round = 0; round < most_rounds && hold(own_mesh, own, round); ++round) {
        }
        return fitted();
    }

    /// The map `before` with heights moved back where this mesh, which it gives, would raise a largest distance.
    QuantisedMap held(const QuantisedMap& before, const Heights& own_mesh, const Errors& own, int round) {
        for (Vertex& vertex : vertices_)
            vertex.height = before.codes[vertex.texel];
        hold(own_mesh, own, round);
        return fitted();
    }

    bool exceeds(const Errors& own) { return errors_of(heights_of_mesh(&Vertex::height), &Vertex::height).exceed(own); }

  private:
    QuantisedMap fitted() const {
        QuantisedMap map = map_;
        for (const Vertex& vertex : vertices_)
            map.codes[vertex.texel] = static_cast<std::uint16_t>(vertex.height);
        return map;
    }

    static constexpr std::uint32_t none = 0xffffffff;
    static constexpr int most_sweeps = 1000;
    static constexpr double enough = 1.0 / 16;  // codes
    static constexpr std::int64_t reach = 2;    // texels

    struct Vertex {
        std::size_t texel;
        double own, height, lowest, highest;
    };
    /// Sums over its grid points: w_j w_k and w_k code, of the corners' weights w.
    struct Triangle {
        std::array<std::uint32_t, 3> vertex{};
        std::array<Weights, 3> product{};
        Weights code{};
    };
    struct Corner {
        std::size_t triangle, corner;
    };

    std::uint32_t vertex_at(const datapath::TexCoord& t) {
        const datapath::MapGeometry& g = map_.geometry;
        const std::uint32_t row = datapath::texel_index(datapath::integer_part(t.v, formats_), g.height, g.address_v);
        const std::uint32_t column = datapath::texel_index(datapath::integer_part(t.u, formats_), g.width, g.address_u);
        const std::size_t texel = std::size_t{row} * g.width + column;
        if (vertex_of_[texel] == none) {
            vertex_of_[texel] = static_cast<std::uint32_t>(vertices_.size());
            const double own = map_.codes[texel];
            Vertex vertex{texel, own, own, own, own};
            for (std::int64_t y = -reach; y <= reach; ++y)
                for (std::int64_t x = -reach; x <= reach; ++x) {
                    const double code = map_.code(within(std::int64_t{column} + x, g.width, g.address_u),
                                                  within(std::int64_t{row} + y, g.height, g.address_v));
                    vertex.lowest = std::min(vertex.lowest, code);
                    vertex.highest = std::max(vertex.highest, code);
                }
            vertices_.push_back(vertex);
        }
        return vertex_of_[texel];
    }

    /// visit(triangle, texel, weights of its corners) once for each grid point that the mesh covers; for base triangles
    /// on the same texels, for each of them. Triangles that share a point on their edges agree on its height.
    template <class Visit>
    void for_each_point(Visit&& visit) {
        std::vector<bool> seen(map_.codes.size(), false);  // on edges
        for (std::size_t t = 0; t < mesh_.size(); ++t) {
            const GridPoints points(mesh_[t], map_.geometry, formats_);
            points.for_each([&](const GridPoint& point) {
                const std::size_t texel = std::size_t{point.row} * map_.geometry.width + point.column;
                if (point.is_on_an_edge()) {
                    if (seen[texel])
                        return;
                    seen[texel] = true;
                }
                Weights weight{};
                for (std::size_t k = 0; k < 3; ++k)
                    weight[k] = static_cast<double>(point.part[k]) / static_cast<double>(points.whole());
                visit(triangles_[t], texel, weight);
            });
        }
    }

    /// Least squares, vertex by vertex.
    void relax() {
        double change = enough;
        for (int sweep = 0; sweep < most_sweeps && change >= enough; ++sweep) {
            change = 0;
            for (std::uint32_t v = 0; v < vertices_.size(); ++v)
                change = std::max(change, improve(v));
        }
        for (Vertex& vertex : vertices_)
            vertex.height = std::floor(vertex.height + 0.5);
    }

    double improve(std::uint32_t v) {
        Vertex& vertex = vertices_[v];
        double sum = vertex.own, weight = 1;
        for (const Corner& at : corners_[v]) {
            const Triangle& triangle = triangles_[at.triangle];
            sum += triangle.code[at.corner];
            for (std::size_t k = 0; k < 3; ++k)
                if (triangle.vertex[k] == v)
                    weight += triangle.product[at.corner][k];
                else
                    sum -= triangle.product[at.corner][k] * vertices_[triangle.vertex[k]].height;
        }
        const double before = vertex.height;
        vertex.height = std::clamp(sum / weight, vertex.lowest, vertex.highest);
        return std::abs(vertex.height - before);
    }

    /// visit(triangle, u, v, weights of its corners) at each triangle's corners and at the centroids of its congruent
    /// parts no longer than a texel.
    template <class Visit>
    void for_each_part(Visit&& visit) const {
        const double texel = std::ldexp(1.0, formats_.texture.fraction);
        for (std::size_t t = 0; t < mesh_.size(); ++t) {
            std::array<double, 3> u{}, v{};
            for (std::size_t k = 0; k < 3; ++k) {
                u[k] = mesh_[t][k].u / texel - 0.5;
                v[k] = mesh_[t][k].v / texel - 0.5;
            }
            const auto [left, right] = std::minmax({u[0], u[1], u[2]});
            const auto [low, high] = std::minmax({v[0], v[1], v[2]});
            const int parts = std::max(1, static_cast<int>(std::ceil(std::max(right - left, high - low))));
            const auto at = [&](double a, double b) {
                const Weights weight{a, b, 1 - a - b};
                visit(triangles_[t], a * u[0] + b * u[1] + weight[2] * u[2], a * v[0] + b * v[1] + weight[2] * v[2],
                      weight);
            };
            at(1, 0);
            at(0, 1);
            at(0, 0);
            for (int a = 0; a < parts; ++a)
                for (int b = 0; a + b < parts; ++b) {
                    at((a + 1.0 / 3) / parts, (b + 1.0 / 3) / parts);
                    if (a + b + 1 < parts)
                        at((a + 2.0 / 3) / parts, (b + 2.0 / 3) / parts);
                }
        }
    }

    double height_at(const Triangle& triangle, const Weights& weight, double Vertex::*height) const {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k)
            sum += weight[k] * vertices_[triangle.vertex[k]].*height;
        return sum;
    }

    Heights heights_of_mesh(double Vertex::*height) {
        Heights mesh{map_.geometry, surface_.texel, {}};
        mesh.codes.assign(map_.codes.size(), std::numeric_limits<float>::quiet_NaN());
        for_each_point([&](const Triangle& triangle, std::size_t texel, const Weights& weight) {
            mesh.codes[texel] = static_cast<float>(height_at(triangle, weight, height));
        });
        return mesh;
    }

    double distance_to(const Heights& mesh, std::size_t texel, double code) const {
        return shares_texels_ ? 0 : mesh.distance(texel, code);
    }

    Errors errors_of(const Heights& mesh, double Vertex::*height) {
        Errors errors;
        for_each_point([&](const Triangle& triangle, std::size_t texel, const Weights& weight) {
            const double code = map_.codes[texel], there = height_at(triangle, weight, height);
            const double to_surface = surface_.distance(texel, there), to_mesh = distance_to(mesh, texel, code);
            errors.vertical += (there - code) * (there - code);
            errors.to_surface += to_surface * to_surface;
            errors.to_mesh += to_mesh * to_mesh;
            errors.largest_to_mesh = std::max(errors.largest_to_mesh, to_mesh);
        });
        for_each_part([&](const Triangle& triangle, double u, double v, const Weights& weight) {
            errors.largest_to_surface =
                std::max(errors.largest_to_surface, surface_.distance(u, v, height_at(triangle, weight, height)));
        });
        return errors;
    }

    /// Halves the differences from their own heights of triangles that come nearer to the largest distance; in the last
    /// rounds takes them all. False if there are none.
    bool hold(const Heights& own_mesh, const Errors& own, int round) {
        // The points are samples a texel apart, between which the distance may be larger.
        const auto near = [&](double largest) {
            return largest - std::min(0.6 * std::min(surface_.texel[0], surface_.texel[1]), largest / 2);
        };
        const double near_surface = near(own.largest_to_surface), near_mesh = near(own.largest_to_mesh);
        const Heights mesh = heights_of_mesh(&Vertex::height);
        std::vector<bool> back(vertices_.size(), false);
        bool any = false;
        const auto move_back = [&](const Triangle& triangle) {
            for (const std::uint32_t v : triangle.vertex)
                if (vertices_[v].height != vertices_[v].own)
                    any = back[v] = true;
        };
        for_each_point([&](const Triangle& triangle, std::size_t texel, const Weights&) {
            const double code = map_.codes[texel], to_mesh = distance_to(mesh, texel, code);
            if (to_mesh > near_mesh && to_mesh > distance_to(own_mesh, texel, code))
                move_back(triangle);
        });
        for_each_part([&](const Triangle& triangle, double u, double v, const Weights& weight) {
            const double to_surface = surface_.distance(u, v, height_at(triangle, weight, &Vertex::height));
            if (to_surface > near_surface &&
                to_surface > surface_.distance(u, v, height_at(triangle, weight, &Vertex::own)))
                move_back(triangle);
        });
        for (std::uint32_t v = 0; v < vertices_.size(); ++v)
            if (Vertex& vertex = vertices_[v]; back[v])
                vertex.height = round < 3 ? std::trunc((vertex.height - vertex.own) / 2) + vertex.own : vertex.own;
        return any;
    }

    const QuantisedMap& map_;
    const std::vector<TextureTriangle>& mesh_;
    const datapath::Formats& formats_;
    std::vector<std::uint32_t> vertex_of_;  // by texel
    std::vector<Vertex> vertices_;
    std::vector<Triangle> triangles_;
    std::vector<std::vector<Corner>> corners_;  // of each vertex
    Heights surface_;
    bool shares_texels_ = false;  // several base triangles lie on them: `Heights` has only one of the mesh's heights
};

}  // namespace

QuantisedMap fit_heights(const QuantisedMap& map, const MeshOfMap& mesh_of, const datapath::Formats& formats,
                         const std::array<double, 2>& texel) {
    const std::vector<TextureTriangle> first = mesh_of(map);
    HeightFit fit(map, first, formats, texel);
    const Heights own_mesh = fit.own_mesh();
    const Errors own = fit.own_errors(own_mesh);
    QuantisedMap fitted = fit.fit(own_mesh, own);
    for (int round = 0; round < most_rounds; ++round) {
        const std::vector<TextureTriangle> mesh = mesh_of(fitted);
        HeightFit next(map, mesh, formats, texel);
        QuantisedMap held = next.held(fitted, own_mesh, own, round);
        if (held.codes == fitted.codes)
            return next.exceeds(own) ? map : fitted;
        fitted = std::move(held);
    }
    return map;
}

}  // namespace tessera

#include "testbench/setup/tables/fitted_heights.h"

#include <algorithm>
#include <cmath>

namespace tessera {

namespace {

/// The code at a grid point, and the dependence of the mesh's height there on the codes under its triangle's corners.
struct Observation {
    std::array<std::size_t, 3> texel{};
    std::array<double, 3> weight{};
    double code = 0;
};

std::size_t texel_under(const QuantisedMap& map, const datapath::TexCoord& t, const datapath::Formats& formats) {
    const datapath::MapGeometry& g = map.geometry;
    const std::uint32_t row = datapath::texel_index(datapath::integer_part(t.v, formats), g.height, g.address_v);
    return std::size_t{row} * g.width +
           datapath::texel_index(datapath::integer_part(t.u, formats), g.width, g.address_u);
}

/// One for each grid point that the mesh covers; for base triangles on the same texels, one for each of them. Triangles
/// that share a point on their edges agree on its height.
std::vector<Observation> observe(const QuantisedMap& map, const std::vector<TextureTriangle>& mesh,
                                 const datapath::Formats& formats) {
    std::vector<Observation> observations;
    std::vector<bool> seen(map.codes.size(), false);  // on edges
    for (const TextureTriangle& triangle : mesh) {
        const GridPoints points(triangle, map.geometry, formats);
        Observation observation;
        for (std::size_t k = 0; k < 3; ++k)
            observation.texel[k] = texel_under(map, triangle[k], formats);
        points.for_each([&](const GridPoint& point) {
            const std::size_t texel = std::size_t{point.row} * map.geometry.width + point.column;
            if (point.is_on_an_edge()) {
                if (seen[texel])
                    return;
                seen[texel] = true;
            }
            for (std::size_t k = 0; k < 3; ++k)
                observation.weight[k] = static_cast<double>(point.part[k]) / static_cast<double>(points.whole());
            observation.code = map.codes[texel];
            observations.push_back(observation);
        });
    }
    return observations;
}

using Values = std::vector<double>;  // one per texel; 0 where there is no vertex

double dot(const Values& a, const Values& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        sum += a[k] * b[k];
    return sum;
}

void add(Values& to, double factor, const Values& values) {
    for (std::size_t k = 0; k < to.size(); ++k)
        to[k] += factor * values[k];
}

/// Least squares by conjugate gradients, preconditioned by the diagonal, starting from the map's own codes.
class HeightFit {
  public:
    HeightFit(std::vector<Observation> observations, std::size_t texels)
        : observations_(std::move(observations)), diagonal_(texels, 0) {
        for (const Observation& o : observations_)
            for (std::size_t k = 0; k < 3; ++k)
                diagonal_[o.texel[k]] += o.weight[k] * o.weight[k];
    }

    void improve(Values& heights) const {
        Values gradient = falls_from(heights);
        Values direction = preconditioned(gradient);
        double slope = dot(gradient, direction);
        const double enough = slope * 1e-16;
        for (int step = 0; step < most_steps && slope > enough; ++step) {
            const Values change = normal_product(direction);
            const double length = slope / dot(direction, change);
            add(heights, length, direction);
            add(gradient, -length, change);
            Values next = preconditioned(gradient);
            const double before = slope;
            slope = dot(gradient, next);
            add(next, slope / before, direction);
            direction.swap(next);
        }
    }

  private:
    static constexpr int most_steps = 1000;

    static double height_of(const Observation& o, const Values& heights) {
        return o.weight[0] * heights[o.texel[0]] + o.weight[1] * heights[o.texel[1]] +
               o.weight[2] * heights[o.texel[2]];
    }

    template <class Value>
    Values gathered(const Value& value) const {
        Values sums(diagonal_.size(), 0);
        for (const Observation& o : observations_) {
            const double of = value(o);
            for (std::size_t k = 0; k < 3; ++k)
                sums[o.texel[k]] += o.weight[k] * of;
        }
        return sums;
    }
    Values falls_from(const Values& heights) const {
        return gathered([&](const Observation& o) { return o.code - height_of(o, heights); });
    }
    Values normal_product(const Values& values) const {
        return gathered([&](const Observation& o) { return height_of(o, values); });
    }
    Values preconditioned(Values values) const {
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] = diagonal_[k] > 0 ? values[k] / diagonal_[k] : 0;
        return values;
    }

    std::vector<Observation> observations_;
    Values diagonal_;  // of the normal equations
};

}  // namespace

QuantisedMap fit_heights(const QuantisedMap& map, const std::vector<TextureTriangle>& mesh,
                         const datapath::Formats& formats) {
    Values heights(map.codes.begin(), map.codes.end());
    HeightFit(observe(map, mesh, formats), heights.size()).improve(heights);
    QuantisedMap fitted = map;
    for (std::size_t k = 0; k < heights.size(); ++k) {
        const double code = std::clamp(std::floor(heights[k] + 0.5), 0.0, static_cast<double>(map.highest_code()));
        fitted.codes[k] = static_cast<std::uint16_t>(code);
    }
    return fitted;
}

}  // namespace tessera

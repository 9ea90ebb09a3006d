#include "testbench/setup/tables/split_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <tuple>

#include "modules/datapath/midpoint.h"
#include "modules/datapath/rank.h"
#include "testbench/setup/tables/triangle_fit.h"

namespace tessera {

namespace {

using datapath::TexCoord;

constexpr std::uint32_t nothing = 0xffffffff;
constexpr double weight_of_error = 0.8;

/// A texture coordinate moved to the first period of each repeated axis.
struct Period {
    std::int64_t u, v;  // 0: the axis clamps

    Period(const datapath::MapGeometry& map, const datapath::Formats& formats)
        : u(map.address_u == datapath::AddressMode::repeat ? std::int64_t{map.width} << formats.texture.fraction : 0),
          v(map.address_v == datapath::AddressMode::repeat ? std::int64_t{map.height} << formats.texture.fraction : 0) {
    }

    std::array<std::int64_t, 2> within(const TexCoord& t) const {
        return {u != 0 ? t.u % u : t.u, v != 0 ? t.v % v : t.v};
    }
};

std::array<std::int64_t, 2> step(const TexCoord& from, const TexCoord& to) {
    return {std::int64_t{to.u} - from.u, std::int64_t{to.v} - from.v};
}

/// A name of a triangle that is independent of its corners' order and of whole periods.
std::array<std::array<std::int64_t, 2>, 3> name_of(const TextureTriangle& triangle, const Period& period) {
    std::array<std::array<std::array<std::int64_t, 2>, 3>, 3> names;
    for (std::size_t k = 0; k < 3; ++k) {
        const TexCoord& from = triangle[k];
        const auto one = step(from, triangle[(k + 1) % 3]), other = step(from, triangle[(k + 2) % 3]);
        names[k] = {period.within(from), std::min(one, other), std::max(one, other)};
    }
    return *std::min_element(names.begin(), names.end());
}

bool has_area(const TextureTriangle& triangle) {
    const auto a = step(triangle[0], triangle[1]), b = step(triangle[0], triangle[2]);
    return a[0] * b[1] != a[1] * b[0];
}

/// A triangle of the mesh as refined so far. A side, 3 * triangle + k, is a triangle's edge k; the sides of one edge
/// form a list.
struct MeshTriangle {
    struct End {
        TexCoord at;
        std::uint32_t code = 0;
        int generation = 0;
    };
    TextureTriangle corner{};
    std::array<std::uint16_t, 3> code{};
    std::array<int, 3> generation{};
    std::array<std::uint32_t, 3> edge{};
    std::array<std::uint32_t, 3> next_side{};
    std::array<bool, 3> reversed{};  ///< the edge runs from corner k + 1 to corner k
    std::uint32_t maker = nothing;   ///< the split that created it
    std::array<End, 2> made_of{};    ///< of the edge bisected by that split
    double longest = 0;              ///< square of its longest edge, in LSB of t
    TriangleFit fit;
};

struct MeshEdge {
    std::uint32_t first_side = nothing;
    double merit = -1;  ///< negative: not a candidate
};

struct Candidate {
    double merit;
    std::uint32_t edge;
    bool operator<(const Candidate& other) const { return std::tie(merit, other.edge) < std::tie(other.merit, edge); }
};

double squared_length(const TexCoord& a, const TexCoord& b) {
    const auto [du, dv] = step(a, b);
    return static_cast<double>(du * du + dv * dv);
}

class Refinement {
  public:
    Refinement(const QuantisedMap& map, const datapath::Formats& formats, const SurfaceSteps& steps)
        : map_(map), formats_(formats), steps_(steps), period_(map.geometry, formats) {}

    void set_base(const std::vector<TextureTriangle>& base) {
        std::set<std::array<std::array<std::int64_t, 2>, 3>> known;
        for (const TextureTriangle& corners : base)
            if (has_area(corners) && known.insert(name_of(corners, period_)).second)
                add_base_triangle(corners);
        for (std::uint32_t edge = 0; edge < edges_.size(); ++edge)
            rate(edge);
    }

    SplitHierarchy refine() {
        while (!candidates_.empty()) {
            const Candidate next = candidates_.top();
            candidates_.pop();
            if (edges_[next.edge].merit == next.merit)  // otherwise it has been bisected or rated again
                bisect(next.edge);
        }
        for (const MeshTriangle& triangle : triangles_)
            hierarchy_.least_error = std::max(hierarchy_.least_error, triangle.fit.largest);
        return std::move(hierarchy_);
    }

  private:
    void add_base_triangle(const TextureTriangle& corners) {
        const auto number = static_cast<std::uint32_t>(triangles_.size());
        MeshTriangle& triangle = triangles_.emplace_back();
        triangle.corner = corners;
        for (std::size_t k = 0; k < 3; ++k)
            triangle.code[k] = code_under(map_, corners[k], formats_);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t edge = base_edge(triangle, k);
            link(edge, number, k, triangle.reversed[k]);
        }
        fit(triangle);
    }

    /// The base mesh's edge of a triangle's side; sets whether the side runs against it.
    std::uint32_t base_edge(MeshTriangle& triangle, std::size_t k) {
        TexCoord a = triangle.corner[k], b = triangle.corner[(k + 1) % 3];
        triangle.reversed[k] = step(a, b) < step(b, a);
        if (triangle.reversed[k])
            std::swap(a, b);
        const auto [found, is_new] =
            base_edges_.try_emplace({period_.within(a), step(a, b)}, static_cast<std::uint32_t>(edges_.size()));
        if (is_new)
            edges_.emplace_back();
        return found->second;
    }

    void fit(MeshTriangle& triangle) {
        triangle.fit = fit_triangle(map_, triangle.corner, triangle.code, formats_);
        triangle.longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            triangle.longest =
                std::max(triangle.longest, squared_length(triangle.corner[k], triangle.corner[(k + 1) % 3]));
    }

    void link(std::uint32_t edge, std::uint32_t triangle, std::size_t k, bool reversed) {
        MeshTriangle& t = triangles_[triangle];
        t.edge[k] = edge;
        t.reversed[k] = reversed;
        t.next_side[k] = edges_[edge].first_side;
        edges_[edge].first_side = side_of(triangle, k);
    }

    void unlink(std::uint32_t triangle, std::size_t k) {
        std::uint32_t* place = &edges_[triangles_[triangle].edge[k]].first_side;
        while (*place != side_of(triangle, k))
            place = &next_side(*place);
        *place = next_side(*place);
    }

    static std::uint32_t side_of(std::uint32_t triangle, std::size_t k) {
        return triangle * 3 + static_cast<std::uint32_t>(k);
    }
    std::uint32_t& next_side(std::uint32_t side) { return triangles_[side / 3].next_side[side % 3]; }

    /// Rates the bisection of an edge, and makes it a candidate if it is worthwhile.
    void rate(std::uint32_t edge) {
        const std::uint32_t first = edges_[edge].first_side;
        const MeshTriangle& one = triangles_[first / 3];
        const std::size_t from = first % 3, to = (from + 1) % 3;
        edges_[edge].merit = -1;
        if (!datapath::has_lattice_midpoint(one.corner[from], one.corner[to], formats_))
            return;
        double squared = 0, lean = 0, weight = 0, longest = 0, count = 0;
        for (std::uint32_t side = first; side != nothing; side = next_side(side)) {
            const MeshTriangle& triangle = triangles_[side / 3];
            squared += triangle.fit.squared;
            lean += triangle.fit.lean[side % 3];
            weight += triangle.fit.weight[side % 3];
            longest = std::max(longest, triangle.longest);
            ++count;
        }
        if (squared == 0)
            return;
        const TexCoord middle = datapath::midpoint(one.corner[from], one.corner[to]);
        const double rise = code_under(map_, middle, formats_) - (one.code[from] + one.code[to]) / 2.0;
        const double fall = rise * (2 * lean - rise * weight);
        const double best_fall = weight > 0 ? lean * lean / weight : 0;
        edges_[edge].merit = (std::max(0.0, fall) + best_fall + weight_of_error * squared) *
                             (squared_length(one.corner[from], one.corner[to]) / longest) / count;
        candidates_.push({edges_[edge].merit, edge});
    }

    void bisect(std::uint32_t edge) {
        const auto number = static_cast<std::uint32_t>(hierarchy_.splits.size());
        const auto halves = static_cast<std::uint32_t>(edges_.size());
        edges_.resize(edges_.size() + 2);
        changed_ = {halves, halves + 1};
        EdgeSplit split;
        for (std::uint32_t side = edges_[edge].first_side; side != nothing;) {
            const std::uint32_t next = next_side(side);
            bisect_triangle(side, number, halves, split);
            side = next;
        }
        edges_[edge] = {};
        hierarchy_.splits.push_back(split);
        for (const std::uint32_t other : changed_)
            rate(other);
    }

    /// The children keep their positions among the corners, as in the hardware: one has the midpoint as corner k + 1,
    /// the other, which is new in the list, as corner k.
    void bisect_triangle(std::uint32_t side, std::uint32_t number, std::uint32_t halves, EdgeSplit& split) {
        const std::uint32_t first = side / 3, second = static_cast<std::uint32_t>(triangles_.size());
        const std::size_t k = side % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        const auto bisector = static_cast<std::uint32_t>(edges_.size());
        edges_.emplace_back();
        unlink(first, k1);
        triangles_.push_back(triangles_[first]);
        MeshTriangle &a = triangles_[first], &b = triangles_[second];
        const std::array<MeshTriangle::End, 2> ends{
            {{a.corner[k], a.code[k], a.generation[k]}, {a.corner[k1], a.code[k1], a.generation[k1]}}};
        split.generation = std::max(ends[0].generation, ends[1].generation) + 1;
        if (a.maker != nothing)
            hierarchy_.dependencies.push_back({number, a.maker, apart(ends, a.made_of)});
        split.reach = std::max(split.reach, reach(ends, a));
        a.made_of = b.made_of = ends;
        const TexCoord middle = datapath::midpoint(a.corner[k], a.corner[k1]);
        const TriangleFit before = a.fit;
        a.maker = b.maker = number;
        a.corner[k1] = b.corner[k] = middle;
        a.code[k1] = b.code[k] = code_under(map_, middle, formats_);
        a.generation[k1] = b.generation[k] = split.generation;
        const std::uint32_t reversed = a.reversed[k] ? 1 : 0;
        link(halves + reversed, first, k, a.reversed[k]);
        link(bisector, first, k1, false);
        link(halves + 1 - reversed, second, k, a.reversed[k]);
        link(b.edge[k1], second, k1, b.reversed[k1]);
        link(bisector, second, k2, true);
        fit(a);
        fit(b);
        changed_.insert(changed_.end(), {a.edge[k2], b.edge[k1], bisector});
        record(before, a.fit.squared + b.fit.squared, middle, split);
    }

    double distance(const MeshTriangle::End& a, const MeshTriangle::End& b) const {
        const auto [du, dv] = step(a.at, b.at);
        const double texels = std::ldexp(1.0, -formats_.texture.fraction);
        return std::hypot(static_cast<double>(du) * texels * steps_.u, static_cast<double>(dv) * texels * steps_.v,
                          (static_cast<double>(a.code) - b.code) * steps_.code);
    }

    double apart(const std::array<MeshTriangle::End, 2>& a, const std::array<MeshTriangle::End, 2>& b) const {
        return std::min(distance(a[0], b[0]) + distance(a[1], b[1]), distance(a[0], b[1]) + distance(a[1], b[0]));
    }

    /// A sum of distances is greatest at a corner of the prism that contains the surface.
    double reach(const std::array<MeshTriangle::End, 2>& ends, const MeshTriangle& triangle) const {
        double farthest = 0;
        for (const TexCoord& corner : triangle.corner) {
            for (const std::uint32_t code : {triangle.fit.lowest, triangle.fit.highest}) {
                const MeshTriangle::End point{corner, code};
                farthest = std::max(farthest, distance(ends[0], point) + distance(ends[1], point));
            }
        }
        return farthest;
    }

    void record(const TriangleFit& before, double squared_after, const TexCoord& middle, EdgeSplit& split) const {
        const auto texel = period_.within(middle);
        split.midpoint = {static_cast<std::uint32_t>(texel[0]), static_cast<std::uint32_t>(texel[1])};
        split.column = split.midpoint.u >> formats_.texture.fraction;
        split.row = split.midpoint.v >> formats_.texture.fraction;
        split.squared_fall += before.squared - squared_after;
        split.largest = std::max(split.largest, before.largest);
        ++split.triangles;
    }

    const QuantisedMap& map_;
    const datapath::Formats& formats_;
    const SurfaceSteps steps_;
    Period period_;
    std::map<std::array<std::array<std::int64_t, 2>, 2>, std::uint32_t> base_edges_;
    std::vector<MeshTriangle> triangles_;
    std::vector<MeshEdge> edges_;
    std::vector<std::uint32_t> changed_;  // edges to be rated after a split
    std::priority_queue<Candidate> candidates_;
    SplitHierarchy hierarchy_;
};

}  // namespace

SplitHierarchy make_split_hierarchy(const QuantisedMap& map, const std::vector<TextureTriangle>& base,
                                    const datapath::Formats& formats, const SurfaceSteps& steps) {
    Refinement refinement(map, formats, steps);
    refinement.set_base(base);
    return refinement.refine();
}

}  // namespace tessera

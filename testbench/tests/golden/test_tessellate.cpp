// Triangles cut along their split edges, once and until no edge splits.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "golden/golden_model.h"
#include "testbench/tests/golden/golden_cases.h"

using namespace tessera::golden;
using namespace tessera::golden::testing;

namespace {

// Half a torus lying on the square [-1, 1]^2, code 65535 for height `tube`.
constexpr int donut_size = 256;
Map half_donut(double ring, double tube) {
    std::vector<double> codes;
    for (int y = 0; y < donut_size; ++y) {
        for (int x = 0; x < donut_size; ++x) {
            const double px = (2 * x + 1.0) / donut_size - 1, py = (2 * y + 1.0) / donut_size - 1;
            const double off_ring = std::hypot(px, py) - ring;
            const double square = tube * tube - off_ring * off_ring;
            codes.push_back(square > 0 ? std::round(65535 * std::sqrt(square) / tube) : 0);
        }
    }
    Map map(donut_size, donut_size, AddressMode::clamp, AddressMode::clamp, codes);
    map.derive_normals(tube / 65535, {2.0 / donut_size, 2.0 / donut_size});
    return map;
}

double to_grid(double texels) {
    return std::round(texels * 4096) / 4096;
}

// A vertex of the plane that half_donut() displaces.
Vertex plane_vertex(double u, double v) {
    Vertex vertex;
    vertex.position = {2 * u / donut_size - 1, 2 * v / donut_size - 1, 0};
    vertex.normal = {0, 0, 1};
    vertex.tangent = {1, 0, 0};
    vertex.texture = {u, v};
    return vertex;
}

std::vector<std::array<Vertex, 3>> plane_18() {
    const std::array<double, 4> g{0, to_grid(donut_size / 3.0), to_grid(donut_size * 2 / 3.0), donut_size};
    std::vector<std::array<Vertex, 3>> base;
    for (std::size_t y = 0; y < 3; ++y) {
        for (std::size_t x = 0; x < 3; ++x) {
            const Vertex a = plane_vertex(g[x], g[y]), b = plane_vertex(g[x + 1], g[y]);
            const Vertex c = plane_vertex(g[x + 1], g[y + 1]), d = plane_vertex(g[x], g[y + 1]);
            base.push_back({a, b, c});
            base.push_back({a, c, d});
        }
    }
    return base;
}

double texture_area(const std::array<Vertex, 3>& t) {
    const glm::dvec2 a = t[1].texture - t[0].texture, b = t[2].texture - t[0].texture;
    return (a.x * b.y - a.y * b.x) / 2;
}

// Directed edges of a mesh, by a key for each vertex; `add` returns false if the edge exists already.
template <class Key>
class DirectedEdges {
  public:
    bool add(const Key& from, const Key& to) { return edges_.insert({from, to}).second; }
    template <class IsBorder>
    std::size_t without_partner(IsBorder is_border) const {
        return static_cast<std::size_t>(std::count_if(edges_.begin(), edges_.end(), [&](const auto& edge) {
            return edges_.count({edge.second, edge.first}) == 0 && !is_border(edge.first, edge.second);
        }));
    }

  private:
    std::set<std::pair<Key, Key>> edges_;
};

}  // namespace

TEST_CASE("subdivision: every pattern tiles the triangle and keeps its winding") {
    std::array<Vertex, 6> v{plane_vertex(10, 10), plane_vertex(50, 20), plane_vertex(20, 60)};
    for (std::size_t e = 0; e < 3; ++e)
        v[3 + e].texture = (v[e].texture + v[(e + 1) % 3].texture) / 2.0;
    for (const Diagonal diagonal : {Diagonal::shorter, Diagonal::first, Diagonal::second}) {
        for (unsigned pattern = 0; pattern < 8; ++pattern) {
            const std::array<bool, 3> split{(pattern & 1) != 0, (pattern & 2) != 0, (pattern & 4) != 0};
            const Subdivision s = subdivide(split, v, diagonal);
            CHECK(s.count == 1 + int{split[0]} + int{split[1]} + int{split[2]});
            double area = 0;
            DirectedEdges<int> edges;
            for (int c = 0; c < s.count; ++c) {
                const auto& child = s.children[static_cast<std::size_t>(c)];
                const auto at = [&](int k) { return v[static_cast<std::size_t>(child[static_cast<std::size_t>(k)])]; };
                const double child_area = texture_area({at(0), at(1), at(2)});
                CHECK(child_area > 0);
                area += child_area;
                for (std::size_t k = 0; k < 3; ++k)
                    CHECK(edges.add(child[k], child[(k + 1) % 3]));
            }
            CHECK(area == Approx(texture_area({v[0], v[1], v[2]})));
            // The rest of the boundary: 3 edges, or 2 halves where split.
            const std::size_t boundary = 3 + std::size_t{split[0]} + std::size_t{split[1]} + std::size_t{split[2]};
            CHECK(edges.without_partner([](int, int) { return false; }) == boundary);
        }
    }
}

TEST_CASE("subdivision: with two split edges there are three choices of diagonal") {
    using Children = std::array<std::array<int, 3>, 4>;
    // For each unsplit edge: corner, then both cuts of the quadrilateral.
    const std::array<Children, 3> cut_first{{{{{5, 4, 2}, {0, 1, 4}, {0, 4, 5}}},
                                             {{{0, 3, 5}, {3, 1, 2}, {3, 2, 5}}},
                                             {{{3, 1, 4}, {0, 3, 4}, {0, 4, 2}}}}};
    const std::array<Children, 3> cut_second{{{{{5, 4, 2}, {0, 1, 5}, {1, 4, 5}}},
                                              {{{0, 3, 5}, {3, 1, 5}, {1, 2, 5}}},
                                              {{{3, 1, 4}, {0, 3, 2}, {3, 4, 2}}}}};
    const std::array<std::array<std::size_t, 4>, 3> quadrilateral{{{0, 1, 4, 5}, {3, 1, 2, 5}, {0, 3, 4, 2}}};
    for (std::size_t unsplit = 0; unsplit < 3; ++unsplit) {
        std::array<bool, 3> split{true, true, true};
        split[unsplit] = false;
        const auto& q = quadrilateral[unsplit];
        std::array<Vertex, 6> v{};
        const auto place = [&](double first_diagonal, double second_diagonal) {
            v[q[2]].position = {100, 0, 0};  // base positions must not matter
            v[q[0]].displaced_position = {0, 0, 0};
            v[q[2]].displaced_position = {first_diagonal / 2, first_diagonal / 4, -first_diagonal / 4};
            v[q[1]].displaced_position = {0, 1, 0};
            v[q[3]].displaced_position = {second_diagonal, 1, 0};
        };
        place(4, 4.5);
        CHECK(subdivide(split, v, Diagonal::shorter).children == cut_first[unsplit]);
        CHECK(subdivide(split, v, Diagonal::second).children == cut_second[unsplit]);
        place(4, 3.5);  // by Euclidean length the first would be shorter, at 2.45
        CHECK(subdivide(split, v, Diagonal::shorter).children == cut_second[unsplit]);
        CHECK(subdivide(split, v, Diagonal::first).children == cut_first[unsplit]);
        place(4, 4);
        CHECK(subdivide(split, v, Diagonal::shorter).children == cut_first[unsplit]);
        place(4, 4 * 63 / 64.0);  // the margin
        CHECK(subdivide(split, v, Diagonal::shorter).children == cut_first[unsplit]);
        place(4, 4 * 62.9 / 64);
        CHECK(subdivide(split, v, Diagonal::shorter).children == cut_second[unsplit]);
    }
}

TEST_CASE("half donut on the plane of 18: it ends, without T-vertices, with the same area") {
    Map map = half_donut(0.55, 0.25);
    set_summed_height(map, 5000);
    const std::vector<std::array<Vertex, 3>> base = plane_18();
    for (const Diagonal diagonal : {Diagonal::shorter, Diagonal::first, Diagonal::second}) {
        Parameters p;
        p.scale = 0.25 / 65535;
        p.normal_threshold = 0.2;
        p.enabled.view = false;
        p.diagonal = diagonal;
        using Key = std::pair<double, double>;
        DirectedEdges<Key> edges;
        double area = 0;
        std::size_t repeated_edges = 0, turned_over = 0;
        std::vector<double> area_of_base(base.size(), 0);
        const Tessellation result = tessellate(base, map, p, 1'000'000, [&](const Triangle& t) {
            const double a = texture_area(t.vertices);
            turned_over += a <= 0;
            area += a;
            area_of_base[t.base_index] += a;
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::dvec2 from = t.vertices[k].texture, to = t.vertices[(k + 1) % 3].texture;
                repeated_edges += !edges.add({from.x, from.y}, {to.x, to.y});
            }
        });
        CHECK_FALSE(result.bound_hit);
        CHECK(result.triangles_emitted > 5000);
        CHECK(result.largest_generation == 12);
        CHECK(turned_over == 0);
        CHECK(repeated_edges == 0);
        const double end = donut_size;
        CHECK(edges.without_partner([&](const Key& a, const Key& b) {
            return (a.first == b.first && (a.first == 0 || a.first == end)) ||
                   (a.second == b.second && (a.second == 0 || a.second == end));
        }) == 0);
        CHECK(area == Approx(end * end).epsilon(1e-12));
        for (std::size_t k = 0; k < base.size(); ++k)
            CHECK(area_of_base[k] == Approx(texture_area(base[k])).epsilon(1e-12));
    }
}

TEST_CASE("the printed algorithm's endless case ends with the Generation Test") {
    // ALGORITHM.md 4.5: the long edge never splits; the third vertex alternates between points one third along it.
    Map map = half_donut(0.6, 0.25);
    set_summed_height(map, 200);
    Parameters p;
    p.scale = 0.25 / 65535;
    p.normal_threshold = 0.1;
    p.enabled.view = false;
    const std::array<Vertex, 3> triangle{plane_vertex(to_grid(78.667), 36),
                                         plane_vertex(to_grid(82.667), to_grid(34.667)), plane_vertex(80, 37)};
    CHECK_FALSE(
        evaluate_edge(complete_base_vertex(triangle[0], map, p), complete_base_vertex(triangle[1], map, p), map, p)
            .split);
    const auto run = [&](std::uint64_t bound) { return tessellate({triangle}, map, p, bound, [](const Triangle&) {}); };
    const std::array<std::uint64_t, 3> with_generation_test{40, 46, 64};
    for (const Diagonal diagonal : {Diagonal::shorter, Diagonal::first, Diagonal::second}) {
        p.diagonal = diagonal;
        p.enabled.generation = true;
        const Tessellation ended = run(1000);
        CHECK_FALSE(ended.bound_hit);
        CHECK(ended.largest_generation == 12);
        CHECK(ended.triangles_emitted == with_generation_test[static_cast<std::size_t>(diagonal)]);

        // A triangle of three texels' area: the run reaches a hundred thousand triangles and would continue.
        p.enabled.generation = false;
        const Tessellation endless = run(100'000);
        CHECK(endless.bound_hit);
        CHECK(endless.largest_generation > 10'000);
    }
}

TEST_CASE("tessellate: the bound is exact, no triangle is lost, base triangles keep their order") {
    Map map = half_donut(0.55, 0.25);
    set_summed_height(map, 1e6);
    Parameters p;
    p.normal_threshold = 0.3;
    p.enabled.view = false;
    std::vector<std::size_t> order;
    const auto note = [&](const Triangle& t) { order.push_back(t.base_index); };
    const Tessellation complete = tessellate(plane_18(), map, p, 1'000'000, note);
    CHECK(order.size() == complete.triangles_emitted);
    CHECK(std::is_sorted(order.begin(), order.end()));
    CHECK(order.front() == 0);
    CHECK(order.back() == 17);
    CHECK_FALSE(tessellate(plane_18(), map, p, complete.triangles_emitted, note).bound_hit);
    CHECK(tessellate(plane_18(), map, p, complete.triangles_emitted - 1, note).bound_hit);
    CHECK(tessellate({}, map, p, 0, note).triangles_emitted == 0);
}

TEST_CASE("cylinder: the seam is closed in repeat and open in clamp") {
    Random random;
    const int around = 8, up = 3, width = 64, height = 48;
    std::vector<std::array<Vertex, 3>> base;
    const auto vertex = [&](int x, int y) {
        const double angle = 2 * std::acos(-1.0) * (x % around) / around;  // the seam's copies share the frame
        Vertex v;
        v.normal = {std::cos(angle), std::sin(angle), 0};
        v.tangent = {-std::sin(angle), std::cos(angle), 0};
        v.position = v.normal * 2.0 + glm::dvec3(0, 0, y);
        v.texture = {double(width) / around * x, double(height) / up * y};
        return v;
    };
    for (int y = 0; y < up; ++y) {
        for (int x = 0; x < around; ++x) {
            base.push_back({vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1)});
            base.push_back({vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1)});
        }
    }
    const std::vector<double> codes = random_codes(width, height, random);
    for (const AddressMode mode : both_modes) {
        Map map(width, height, mode, AddressMode::clamp, codes);
        set_summed_height(map, 20000);
        Parameters p;
        p.scale = 0.2 / 65535;
        p.normal_threshold = 0.3;
        p.enabled.view = false;
        p.generation_limit = 6;
        map.derive_normals(p.scale, {4 * std::acos(-1.0) / width, double(up) / height});
        using Key = std::tuple<double, double, double>;
        const auto key = [](const glm::dvec3& d) { return Key{d.x, d.y, d.z}; };
        DirectedEdges<Key> edges;
        std::map<Key, double> row;
        const Tessellation result = tessellate(base, map, p, 1'000'000, [&](const Triangle& t) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Vertex &a = t.vertices[k], &b = t.vertices[(k + 1) % 3];
                edges.add(key(a.displaced_position), key(b.displaced_position));
                row[key(a.displaced_position)] = a.texture.y;
            }
        });
        CHECK(result.triangles_emitted > 1000);
        const std::size_t open = edges.without_partner(
            [&](const Key& a, const Key& b) { return row[a] == row[b] && (row[a] == 0 || row[a] == height); });
        if (mode == AddressMode::repeat)
            CHECK(open == 0);
        else
            CHECK(open > 0);
    }
}

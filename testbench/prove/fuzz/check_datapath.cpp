#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/pack_triangle.h"
#include "modules/datapath/triangulate.h"
#include "testbench/prove/fuzz/datapath_case.h"
#include "testbench/prove/fuzz/edge_account.h"
#include "testbench/prove/fuzz/fuzz_target.h"

namespace tessera::fuzz {

namespace {

using namespace datapath;

bool holds(const Format& format, std::int64_t value) {
    return value >= format.lowest && value <= format.highest;
}

template <class Vector>
bool holds_vector(const Format& format, const Vector& v) {
    return holds(format, v.x) && holds(format, v.y) && holds(format, v.z);
}

/// Every field of a vertex fits its format.
void promise_fits(const Vertex& v, const Registers& registers) {
    const Formats& formats = registers.formats;
    promise(holds_vector(formats.position, v.position) && holds_vector(formats.position, v.displaced),
            "a position does not fit its format");
    promise(holds_vector(formats.normal, v.normal) && holds_vector(formats.normal, v.tangent) &&
                holds_vector(formats.normal, v.displaced_normal),
            "a normal does not fit its format");
    promise(holds(formats.screen, v.screen.x) && holds(formats.screen, v.screen.y) &&
                holds(formats.view_distance, v.screen.w),
            "a screen position does not fit its format");
    const std::int64_t border = std::int64_t{1} << (formats.texture.bits - 1);
    promise(v.texture.u <= border && v.texture.v <= border, "a texture coordinate does not fit its format");
    promise(v.generation <= registers.tests.generation_limit, "a generation is beyond its limit");
}

void promise_midpoint(std::int64_t a, std::int64_t b, std::int64_t ab, std::int64_t ba) {
    promise(ab == ba, "a midpoint depends on its operands' order");
    promise(std::min(a, b) <= ab && ab <= std::max(a, b), "a midpoint is not between its operands");
    const std::int64_t off = a + b - 2 * ab;  // in half LSB
    promise(off == 0 || off == 1, "a midpoint is not rounded towards minus infinity");
}

void check_midpoints(const Vertex& a, const Vertex& b) {
    const Position p = midpoint(a.position, b.position), q = midpoint(b.position, a.position);
    promise_midpoint(a.position.x, b.position.x, p.x, q.x);
    promise_midpoint(a.position.y, b.position.y, p.y, q.y);
    promise_midpoint(a.position.z, b.position.z, p.z, q.z);
    const TexCoord t = midpoint(a.texture, b.texture), s = midpoint(b.texture, a.texture);
    promise_midpoint(a.texture.u, b.texture.u, t.u, s.u);
    promise_midpoint(a.texture.v, b.texture.v, t.v, s.v);
}

/// normalise.h: zero stays zero; else each component within 1/2 + 2^(fraction - 28) LSB.
void check_normalise(std::int64_t x, std::int64_t y, std::int64_t z, const Formats& formats) {
    Saturations saturations;
    const Direction unit = normalise(x, y, z, formats, saturations);
    promise(holds_vector(formats.normal, unit), "a unit vector does not fit its format");
    promise(saturations.normal == 0, "a unit vector saturates");
    const bool zero = x == 0 && y == 0 && z == 0;
    promise((saturations.degenerate_normal == 1) == zero, "a zero vector is not counted, or another vector is");
    if (zero) {
        promise(unit == Direction{}, "a zero vector does not stay zero");
        return;
    }
    constexpr double rounding = 1e-9;  // of this check's doubles
    const double length =
        std::sqrt(static_cast<double>(x * x) + static_cast<double>(y * y) + static_cast<double>(z * z));
    const double bound = 0.5 + std::ldexp(1.0, formats.normal.fraction - 28) + rounding;
    const auto close = [&](std::int64_t component, std::int32_t result) {
        const double exact = std::ldexp(static_cast<double>(component), formats.normal.fraction) / length;
        return std::abs(exact - result) <= bound;
    };
    promise(close(x, unit.x) && close(y, unit.y) && close(z, unit.z), "normalise exceeds its error bound");
}

std::int64_t doubled_area(const TexCoord& a, const TexCoord& b, const TexCoord& c) {
    const auto difference = [](std::uint32_t p, std::uint32_t q) { return std::int64_t{p} - std::int64_t{q}; };
    return difference(b.u, a.u) * difference(c.v, a.v) - difference(b.v, a.v) * difference(c.u, a.u);
}

/// For all patterns of split edges, the children cover the triangle's outline with its midpoints, with its winding.
void check_triangulate(const Triangle& triangle) {
    const auto& v = triangle.vertices;
    const std::array<TexCoord, 6> points{v[0].texture,
                                         v[1].texture,
                                         v[2].texture,
                                         midpoint(v[0].texture, v[1].texture),
                                         midpoint(v[1].texture, v[2].texture),
                                         midpoint(v[2].texture, v[0].texture)};
    for (unsigned split = 0; split < 8; ++split) {
        std::vector<TexCoord> outline;
        for (unsigned k = 0; k < 3; ++k) {
            outline.push_back(points[k]);
            if ((split >> k & 1) != 0)
                outline.push_back(points[3 + k]);
        }
        std::int64_t enclosed = 0;
        for (std::size_t k = 1; k + 1 < outline.size(); ++k)
            enclosed += doubled_area(outline[0], outline[k], outline[k + 1]);
        for (const bool second : {false, true}) {
            const ChildIndices children = triangulate(split, second);
            promise(children.count == static_cast<int>(outline.size()) - 2, "a wrong number of children");
            std::int64_t covered = 0;
            for (std::size_t k = 0; k < static_cast<std::size_t>(children.count); ++k) {
                const auto& child = children.children[k];
                for (const std::uint8_t corner : child)
                    promise(corner < 3 || (split >> (corner - 3) & 1) != 0,
                            "a child has a vertex that was not inserted");
                covered += doubled_area(points[child[0]], points[child[1]], points[child[2]]);
            }
            promise(covered == enclosed, "the children do not cover their parent");
        }
    }
}

class Checker {
  public:
    explicit Checker(DatapathCase&& made)
        : case_(std::move(made)), machine_(case_.registers, std::move(case_.tables)) {}

    void check() {
        check_normalise(case_.vector[0], case_.vector[1], case_.vector[2], formats());
        for (Vertex& corner : case_.corners)
            machine_.complete(corner);
        for (std::size_t i = 0; i < case_.corners.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                check_edge(case_.corners[i], case_.corners[j]);
        for (const Triangle& triangle : case_.base) {
            check_triangulate(triangle);
            // The table's width is chosen for these rectangles; the sums of others may not fit.
            for (std::size_t k = 0; k < 3; ++k)
                check_sums(triangle.vertices[k].texture, triangle.vertices[(k + 1) % 3].texture);
        }
        check_recursion();
    }

  private:
    const Formats& formats() const { return case_.registers.formats; }

    /// Decision and inserted vertex of an edge are the same from both ends.
    void check_edge(const Vertex& i, const Vertex& j) {
        promise_fits(i, case_.registers);
        check_midpoints(i, j);
        check_normalise(std::int64_t{i.normal.x} + j.normal.x, std::int64_t{i.normal.y} + j.normal.y,
                        std::int64_t{i.normal.z} + j.normal.z, formats());
        TrianglePass pass;
        pass.triangle.vertices = {i, j, i};
        machine_.evaluate_edge(pass, 0);
        machine_.evaluate_edge(pass, 1);
        promise(pass.edges[0].tests == pass.edges[1].tests, "an edge's tests depend on the order of its ends");
        promise(testing::same_bits(inserted_vertex(pass, 0), inserted_vertex(pass, 1)),
                "an inserted vertex depends on the order of its edge's ends");
    }

    /// The Summed Height Table gives the sum of the map's texels; a constant map never splits.
    void check_sums(const TexCoord& i, const TexCoord& j) {
        const MapGeometry& map = case_.registers.map;
        const RectangleSize size = rectangle_size(i, j, map, formats());
        for (const TexCoord& centre : {i, j, midpoint(i, j)}) {
            const Rectangle r = centred_rectangle(centre, size, map, formats());
            promise(r.last_column - r.first_column == size.width && r.last_row - r.first_row == size.height,
                    "a rectangle was cut");
            promise(map.address_u == AddressMode::repeat || r.last_column <= map.width,
                    "a rectangle leaves the map in u");
            promise(map.address_v == AddressMode::repeat || r.last_row <= map.height,
                    "a rectangle leaves the map in v");
            std::uint64_t sum = 0;
            for (std::uint32_t y = r.first_row; y < r.last_row; ++y)
                for (std::uint32_t x = r.first_column; x < r.last_column; ++x)
                    sum += case_.codes[std::size_t{y % map.height} * map.width + x % map.width];
            promise(machine_.sum_around(centre, size) == sum, "the Summed Height Table's sum differs from the map's");
        }
        const bool constant = std::all_of(case_.codes.begin(), case_.codes.end(),
                                          [&](std::uint32_t code) { return code == case_.codes.front(); });
        promise(!constant || !machine_.summed_height(i, j), "a constant map passes the Summed Height Test");
    }

    /// The completely tessellated patch is as closed as the base: its unpaired edges are the base's borders, each split
    /// as decided by the edge alone.
    void check_recursion() {
        EdgeAccount account;
        std::vector<Waiting> work;
        for (Triangle triangle : case_.base) {
            for (Vertex& vertex : triangle.vertices)
                machine_.complete(vertex);
            work.push_back({triangle, 0});
            for (int k = 0; k < 3; ++k)
                take_away_chain(triangle.vertices[static_cast<std::size_t>(k)],
                                triangle.vertices[static_cast<std::size_t>(k + 1) % 3], 0, account);
        }
        // A child replaces a vertex by one of a greater generation, so the sum of its three generations is greater.
        const int deepest = 3 * static_cast<int>(case_.registers.tests.generation_limit);
        while (!work.empty()) {
            const Waiting waiting = work.back();
            work.pop_back();
            promise(waiting.depth <= deepest, "the generation limit does not bound the recursion");
            const TrianglePass pass = machine_.evaluate(waiting.triangle);
            if (pass.split == 0) {
                account.add(waiting.triangle);
                check_packing(waiting.triangle);
                continue;
            }
            tessellate(pass, case_.registers.triangulation, case_.registers.formats, saturations_,
                       [&](const Triangle& child) {
                           for (const Vertex& vertex : child.vertices)
                               promise_fits(vertex, case_.registers);
                           work.push_back({child, waiting.depth + 1});
                       });
        }
        promise(account.balanced(), "the tessellated patch has a crack");
    }

    /// Removes a base edge from the account, split by its own decisions.
    void take_away_chain(const Vertex& from, const Vertex& to, unsigned depth, EdgeAccount& account) {
        promise(depth <= case_.registers.tests.generation_limit, "the generation limit does not bound an edge");
        TrianglePass pass;
        pass.triangle.vertices = {from, to, from};
        machine_.evaluate_edge(pass, 0);
        if ((pass.split & 1) == 0) {
            account.remove(from, to);
            return;
        }
        const Vertex middle = inserted_vertex(pass, 0);
        take_away_chain(from, middle, depth + 1, account);
        take_away_chain(middle, to, depth + 1, account);
    }

    /// Packs a triangle for off-chip memory and unpacks it.
    void check_packing(const Triangle& triangle) {
        std::vector<unsigned char> bytes(packed_triangle_bytes(formats()) + packed_triangle_tag_bytes);
        promise(pack_triangle(triangle, formats(), bytes.data()), "a triangle does not fit its queue entry");
        const Triangle back = unpack_triangle(bytes.data(), formats());
        for (std::size_t k = 0; k < 3; ++k)
            promise(testing::same_bits(back.vertices[k], triangle.vertices[k]), "a vertex changes in the queue");
        promise(back.base == triangle.base && back.split_by == triangle.split_by &&
                    back.stopped_by == triangle.stopped_by && back.finished == triangle.finished,
                "a triangle changes in the queue");
    }

    struct Waiting {
        Triangle triangle;
        int depth;
    };

    DatapathCase case_;
    testing::Machine machine_;
    Saturations saturations_;
};

}  // namespace

void check_datapath(std::string_view bytes) {
    Checker(make_datapath_case(bytes)).check();
}

}  // namespace tessera::fuzz

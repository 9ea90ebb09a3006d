#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>

#include "testbench/check/mesh/invariants.h"
#include "testbench/tests/support/emitted_mesh_maker.h"

namespace tessera {
namespace {

using datapath::TexCoord;
using datapath::Triangle;
using datapath::Vertex;

constexpr std::uint32_t map_side = 64;

/// Some unsmooth height, the same for all t of a texel, periodic in 64 texels.
std::int32_t height_at(const TexCoord& t) {
    const std::uint32_t u = (t.u >> 12) % map_side, v = (t.v >> 12) % map_side;
    return static_cast<std::int32_t>((u * 7919 + v * 104729) % 1511);
}

/// Splits what is longer than its middle's distance from texel (16, 40) allows: finer there, by edge alone.
bool near_a_place(const Vertex& i, const Vertex& j) {
    const auto texel = [](std::uint32_t a, std::uint32_t b) {
        return std::fmod((a + double(b)) / 8192, map_side);
    };
    const double du = (double(i.texture.u) - j.texture.u) / 4096,
                 dv = (double(i.texture.v) - j.texture.v) / 4096;
    const double distance =
        std::hypot(texel(i.texture.u, j.texture.u) - 16, texel(i.texture.v, j.texture.v) - 40);
    return std::hypot(du, dv) > 1.5 + distance / 4;
}

MeshMaker usual_maker() {
    return {near_a_place, height_at, 12};
}

/// The plane over the whole map, 2 x 2 quads, and what is emitted of it.
struct Plane {
    datapath::Registers registers = registers_for(map_side, map_side);
    std::vector<Triangle> base = make_grid(2, 2, [](int i, int j) {
        return flat_vertex(static_cast<std::uint32_t>(32 * i), static_cast<std::uint32_t>(32 * j));
    });
    EmittedMesh mesh = usual_maker().make(base);

    InvariantResult check() const { return check_invariants(mesh, base, registers); }

    /// A triangle all of whose vertices lie inside base triangle 5.
    EmittedTriangle& inner_triangle() {
        const auto inside = [](const EmittedTriangle& t) {
            return t.base == 5 && std::all_of(t.corners.begin(), t.corners.end(), [](const auto& c) {
                       const std::uint32_t u = c.texture.u, v = c.texture.v - (32u << 12);
                       return u > 0 && v > u && v < (32u << 12);
                   });
        };
        return *std::find_if(mesh.triangles.begin(), mesh.triangles.end(), inside);
    }
};

/// Everything that must be zero but for the names given with their values.
void require_only(const InvariantResult& result,
                  std::initializer_list<std::pair<const char*, std::uint64_t>> expected) {
    INFO(result.first_violation);
    for (const InvariantFigure& figure : invariant_figures(result)) {
        if (figure.kind == InvariantFigure::Kind::fact)
            continue;
        const auto found = std::find_if(expected.begin(), expected.end(),
                                        [&](const auto& e) { return std::string(e.first) == figure.name; });
        INFO(figure.name);
        CHECK(figure.value == (found == expected.end() ? 0 : found->second));
    }
    CHECK(result.first_violation.empty() == result.passed());
}

/// Columns round a prism, one row; u from 0 to the map's width.
std::vector<Triangle> make_prism(int columns, std::uint32_t last_u) {
    return make_grid(columns, 1, [=](int i, int j) {
        const double angle = 2 * 3.14159265358979323846 * (i % columns) / columns;
        Vertex v;
        v.position = {static_cast<std::int32_t>(std::lround(100000 * std::cos(angle))),
                      static_cast<std::int32_t>(std::lround(100000 * std::sin(angle))), 200000 * j};
        v.normal = {static_cast<std::int32_t>(std::lround(16384 * std::cos(angle))),
                    static_cast<std::int32_t>(std::lround(16384 * std::sin(angle))), 0};
        v.texture = {
            i == columns ? last_u : (map_side << 12) / static_cast<std::uint32_t>(columns) * unsigned(i),
            (map_side << 12) * unsigned(j)};
        return v;
    });
}

}  // namespace

TEST_CASE("a good mesh passes") {
    Plane plane;
    const InvariantResult result = plane.check();
    require_only(result, {});
    CHECK(result.passed());
    CHECK(result.triangles > 300);
    CHECK(result.base_triangles == 8);
    CHECK(result.base_edges == 16);
    CHECK(result.border_base_edges == 8);
    CHECK(result.non_manifold_base_edges == 0);
    CHECK(result.texture_seams == 0);
    REQUIRE(std::any_of(plane.mesh.triangles.begin(), plane.mesh.triangles.end(),
                        [](const auto& t) { return t.corners[0].generation > 4; }));

    SECTION("in any order, and from any first corner") {
        std::mt19937 random(7);
        std::shuffle(plane.mesh.triangles.begin(), plane.mesh.triangles.end(), random);
        for (auto& t : plane.mesh.triangles)
            std::rotate(t.corners.begin(), t.corners.begin() + random() % 3, t.corners.end());
        require_only(plane.check(), {});
    }
    SECTION("culled triangles count") {
        for (auto& t : plane.mesh.triangles)
            t.culled = true;
        require_only(plane.check(), {});
    }
    SECTION("mirrored in texture space") {
        for (auto& t : plane.base)
            for (auto& v : t.vertices)
                v.texture.u = (map_side << 12) - v.texture.u;
        plane.mesh = usual_maker().make(plane.base);
        require_only(plane.check(), {});
    }
}

TEST_CASE("missing triangles are cracks and lost area") {
    Plane plane;
    SECTION("inside a base triangle") {
        plane.mesh.triangles.erase(plane.mesh.triangles.begin() +
                                   (&plane.inner_triangle() - plane.mesh.triangles.data()));
        const InvariantResult result = plane.check();
        require_only(result, {{"cracks", 3}, {"area_mismatches", 1}});
        CHECK(result.first_violation.find("base triangle 5: the edge P (") == 0);
        CHECK(result.first_violation.find("= texel (") != std::string::npos);
    }
    SECTION("any one") {
        for (std::size_t i = 0; i < plane.mesh.triangles.size(); ++i) {
            Plane other;
            other.mesh.triangles.erase(other.mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i));
            require_only(other.check(), {{"cracks", 3}, {"area_mismatches", 1}});
        }
    }
    SECTION("all of one base triangle") {
        auto& t = plane.mesh.triangles;
        t.erase(std::remove_if(t.begin(), t.end(), [](const auto& e) { return e.base == 3; }), t.end());
        require_only(plane.check(), {{"cracks", 3}, {"area_mismatches", 1}});
    }
    SECTION("all") {
        plane.mesh.triangles.clear();
        require_only(plane.check(), {{"cracks", 24}, {"area_mismatches", 8}});
    }
}

TEST_CASE("a triangle emitted twice") {
    Plane plane;
    for (std::size_t i = 0; i < plane.mesh.triangles.size(); ++i) {
        Plane other;
        EmittedTriangle again = other.mesh.triangles[i];
        std::rotate(again.corners.begin(), again.corners.begin() + 1, again.corners.end());
        other.mesh.triangles.push_back(again);
        require_only(other.check(), {{"cracks", 3}, {"area_mismatches", 1}, {"duplicate_triangles", 1}});
    }
    SECTION("together with its reverse: no edge and no area tells") {
        const EmittedTriangle triangle = plane.inner_triangle();
        plane.mesh.triangles.push_back(triangle);
        plane.mesh.triangles.push_back(triangle);
        std::swap(plane.mesh.triangles.back().corners[0], plane.mesh.triangles.back().corners[1]);
        require_only(plane.check(), {{"duplicate_triangles", 1},
                                     {"turned_over", 1},
                                     {"turned_over_unexplained", 1},
                                     {"coincident_edges", 3}});
    }
    SECTION("the whole mesh") {
        const auto once = plane.mesh.triangles;
        plane.mesh.triangles.insert(plane.mesh.triangles.end(), once.begin(), once.end());
        const InvariantResult result = plane.check();
        CHECK(result.duplicate_triangles == once.size());
        CHECK(result.area_mismatches == 8);
        CHECK(result.cracks > 24);
    }
}

namespace {

/// Splits edge k of a triangle on its own, as a unit would that decides by triangle.
void split_alone(EmittedMesh& mesh, std::size_t index, std::size_t k) {
    EmittedTriangle first = mesh.triangles[index], second = first;
    const auto &a = first.corners[k], &b = first.corners[(k + 1) % 3];
    EmittedTriangle::Corner middle = a;
    middle.position = datapath::midpoint(a.position, b.position);
    middle.texture = datapath::midpoint(a.texture, b.texture);
    middle.displaced = datapath::midpoint(a.displaced, b.displaced);
    middle.generation = static_cast<std::uint8_t>(std::max(a.generation, b.generation) + 1);
    first.corners[(k + 1) % 3] = middle;
    second.corners[k] = middle;
    mesh.triangles[index] = first;
    mesh.triangles.push_back(second);
}

}  // namespace

TEST_CASE("an edge split from one side only is a T-vertex") {
    Plane plane;
    SECTION("inside a base triangle") {
        split_alone(plane.mesh,
                    static_cast<std::size_t>(&plane.inner_triangle() - plane.mesh.triangles.data()), 1);
        const InvariantResult result = plane.check();
        require_only(result, {{"t_vertices", 1}});
        CHECK(result.first_violation.find("base triangle 5: T-vertex: the edge P (") == 0);
    }
    SECTION("any edge of any triangle, but for the mesh's border") {
        std::size_t on_border = 0, inside = 0;
        for (std::size_t i = 0; i < plane.mesh.triangles.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                Plane other;
                const TexCoord a = other.mesh.triangles[i].corners[k].texture,
                               b = other.mesh.triangles[i].corners[(k + 1) % 3].texture;
                const bool border = (a.u == b.u && a.u % (map_side << 12) == 0) ||
                                    (a.v == b.v && a.v % (map_side << 12) == 0);
                split_alone(other.mesh, i, k);
                require_only(other.check(), {{"t_vertices", border ? 0 : 1}});
                ++(border ? on_border : inside);
            }
        CHECK(on_border > 20);
        CHECK(inside > 500);
    }
    SECTION("twice over, within the halves") {
        Plane other;
        const std::size_t index =
            static_cast<std::size_t>(&other.inner_triangle() - other.mesh.triangles.data());
        split_alone(other.mesh, index, 0);
        split_alone(other.mesh, index, 0);
        require_only(other.check(), {{"t_vertices", 2}});
    }
    SECTION("a vertex that is no midpoint is a crack") {
        const std::size_t index =
            static_cast<std::size_t>(&plane.inner_triangle() - plane.mesh.triangles.data());
        split_alone(plane.mesh, index, 0);
        EmittedTriangle &first = plane.mesh.triangles[index], &second = plane.mesh.triangles.back();
        second.corners[0].texture.u += 2;
        first.corners[1].texture.u += 2;
        require_only(plane.check(), {{"cracks", 3}, {"area_mismatches", 1}});
    }
    SECTION("a limit by triangle, not by edge, leaves them between base triangles") {
        MeshMaker maker = usual_maker();
        EmittedMesh mesh;
        for (const Triangle& base : plane.base) {
            maker.generation_limit = base.base % 2 == 0 ? 3 : 12;
            Triangle alone = base;
            const EmittedMesh part = maker.make({alone});
            mesh.triangles.insert(mesh.triangles.end(), part.triangles.begin(), part.triangles.end());
        }
        const InvariantResult result = check_invariants(mesh, plane.base, plane.registers);
        CHECK(result.t_vertices > 4);
        CHECK(result.area_mismatches == 0);
        CHECK(result.first_violation.find("T-vertex: a piece of their common edge") != std::string::npos);
    }
}

TEST_CASE("a displaced position that differs by one on one side is a crack") {
    Plane plane;
    SECTION("inside a base triangle: both edges of the moved corner") {
        plane.inner_triangle().corners[1].displaced.z += 1;
        const InvariantResult result = plane.check();
        require_only(result, {{"cracks", 2}, {"inconsistent_vertices", 1}});
        CHECK(result.first_violation.find("base triangle 5: one vertex has different P'") == 0);
    }
    SECTION("between base triangles: a whole patch moved") {
        for (auto& t : plane.mesh.triangles)
            if (t.base == 2)
                for (auto& c : t.corners)
                    c.displaced.x += 1;
        const InvariantResult result = plane.check();
        CHECK(result.cracks > 3);
        CHECK(result.inconsistent_vertices > 3);
        CHECK(result.t_vertices == 0);
        CHECK(result.area_mismatches == 0);
    }
    SECTION("one vertex between base triangles, moved alike in one of them") {
        const TexCoord place{48u << 12, 16u << 12};  // on the diagonal of the second quad
        bool moved = false;
        for (auto& t : plane.mesh.triangles)
            for (auto& c : t.corners)
                if (t.base == 2 && c.texture == place) {
                    c.displaced.y -= 1;
                    moved = true;
                }
        REQUIRE(moved);
        require_only(plane.check(), {{"cracks", 2}, {"inconsistent_vertices", 1}});
    }
    SECTION("a base vertex") {
        for (auto& t : plane.mesh.triangles)
            for (auto& c : t.corners)
                if (t.base == 7 && c.texture == TexCoord{64u << 12, 64u << 12})
                    c.displaced.y -= 1;
        // it has one neighbour there, which shares the diagonal
        require_only(plane.check(), {{"cracks", 1}, {"inconsistent_vertices", 1}});
    }
}

TEST_CASE("normals and generations must agree too") {
    Plane plane;
    SECTION("normal") {
        plane.inner_triangle().corners[0].displaced_normal.x += 1;
        require_only(plane.check(), {{"inconsistent_vertices", 1}});
    }
    SECTION("generation") {
        plane.inner_triangle().corners[0].generation ^= 1;
        require_only(plane.check(), {{"inconsistent_vertices", 1}});
    }
    SECTION("between base triangles, alike in one of them") {
        const auto at = [&](unsigned base, unsigned u, unsigned v, auto change) {
            Plane other = plane;
            for (auto& t : other.mesh.triangles)
                for (auto& c : t.corners)
                    if (t.base == base && c.texture == TexCoord{u << 12, v << 12})
                        change(c);
            require_only(other.check(), {{"inconsistent_vertices", 1}});
        };
        for (const unsigned side : {48U, 64U}) {  // on the second quad's diagonal; a base vertex
            const unsigned base = side == 48 ? 2 : 7, v = side == 48 ? 16 : 64;
            at(base, side, v, [](auto& c) { c.displaced_normal.x += 1; });
            at(base, side, v, [](auto& c) { c.generation ^= 1; });
        }
    }
    SECTION("generation beyond the limit") {
        plane.registers.tests.generation_limit = 4;
        const InvariantResult result = plane.check();
        CHECK(result.generation_violations > 0);
        CHECK(result.violations() == result.generation_violations);
        plane.registers.tests.generation_test = false;
        require_only(plane.check(), {});
    }
}

TEST_CASE("folds in texture space alone excuse nothing") {
    // t in steps of a quarter texel: triangles collapse and turn over there, but not in P
    Plane plane;
    plane.registers.formats.texture.fraction = 2;
    for (auto& t : plane.base)
        for (auto& v : t.vertices)
            v.texture = {v.texture.u >> 10, v.texture.v >> 10};
    MeshMaker maker = usual_maker();
    maker.split = [](const Vertex& i, const Vertex& j) {
        const std::int32_t x = (i.position.x + j.position.x) / 2, y = (i.position.y + j.position.y) / 2;
        return std::hypot(i.position.x - j.position.x, i.position.y - j.position.y) >
               150 + std::hypot(x - 16000, y - 40000) / 4;
    };
    plane.mesh = maker.make(plane.base);
    const InvariantResult good = plane.check();
    INFO(good.first_violation);
    CHECK(good.passed());
    CHECK(good.collapsed > 20);
    CHECK(good.coincident_vertices == 0);
    CHECK(good.coincident_edges == 0);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < plane.mesh.triangles.size(); i += 7) {
        Plane other = plane;
        other.mesh.triangles[i].corners[2].displaced.x += 1;
        const InvariantResult result = other.check();
        CHECK(result.cracks <= 2);
        CHECK(result.coincident_vertices == 0);
        CHECK(result.coincident_edges == 0);
        moved += result.inconsistent_vertices == 1;

        other = plane;
        other.mesh.triangles.push_back(other.mesh.triangles[i]);
        const InvariantResult twice = other.check();
        CHECK(twice.cracks == 3);
        CHECK(twice.duplicate_triangles == 1);
    }
    CHECK(moved > 50);
}

TEST_CASE("a triangle of the wrong winding") {
    Plane plane;
    for (std::size_t i = 0; i < plane.mesh.triangles.size(); ++i) {
        Plane other;
        std::swap(other.mesh.triangles[i].corners[0], other.mesh.triangles[i].corners[2]);
        require_only(
            other.check(),
            {{"cracks", 3}, {"area_mismatches", 1}, {"turned_over", 1}, {"turned_over_unexplained", 1}});
    }
}

TEST_CASE("a triangle of a base triangle that does not exist, or of another") {
    Plane plane;
    SECTION("of none") {
        plane.inner_triangle().base = 8;
        const InvariantResult result = plane.check();
        require_only(result, {{"foreign_triangles", 1}, {"cracks", 3}, {"area_mismatches", 1}});
    }
    SECTION("of another") {
        plane.inner_triangle().base = 1;
        const InvariantResult result = plane.check();
        CHECK(result.cracks == 6);
        CHECK(result.area_mismatches == 2);
    }
}

TEST_CASE("collapsed and turned over triangles, and what explains them") {
    Plane plane;
    SECTION("collapsed without reason") {
        // the whole star of a vertex is flattened: every corner at its place moved to a neighbour's
        EmittedTriangle& t = plane.inner_triangle();
        const auto from = t.corners[0], to = t.corners[1];
        for (auto& e : plane.mesh.triangles)
            for (auto& c : e.corners)
                if (c.position == from.position)
                    c = to;
        const InvariantResult result = plane.check();
        CHECK(result.collapsed == 2);
        CHECK(result.collapsed_explained == 0);
        CHECK(result.displaced_collapsed == 2);
        CHECK(result.area_mismatches == 0);
        CHECK(result.cracks == 0);
        CHECK_FALSE(result.passed());
        CHECK(result.first_violation.find("collapsed in texture space") != std::string::npos);
    }
    SECTION("a base triangle without texture area explains all that comes of it") {
        std::vector<Triangle> base(1);
        base[0].vertices = {flat_vertex(0, 0), flat_vertex(32, 0), flat_vertex(10, 32)};
        base[0].vertices[2].texture = {10u << 12, 0};
        const EmittedMesh mesh = usual_maker().make(base);
        REQUIRE(mesh.triangles.size() > 4);
        const InvariantResult result = check_invariants(mesh, base, plane.registers);
        require_only(result,
                     {{"collapsed", mesh.triangles.size()}, {"collapsed_explained", mesh.triangles.size()}});
    }
    SECTION("thin base triangles: whatever rounding does, it is explained and closed") {
        std::mt19937 random(11);
        const auto below = [&](unsigned n) { return static_cast<std::uint32_t>(random() % n); };
        std::uint64_t collapsed = 0, turned_over = 0, folded = 0, triangles = 0;
        for (int n = 0; n < 300; ++n) {
            // a quad a few LSB high in t, and nearly as flat in P
            const std::uint32_t tilt = below(20000);
            std::array<std::array<Vertex, 2>, 2> corners;
            for (std::uint32_t i = 0; i < 2; ++i)
                for (std::uint32_t j = 0; j < 2; ++j) {
                    Vertex v = flat_vertex(30 * i, 0);
                    v.position.y = static_cast<std::int32_t>(4 * j + below(4));
                    v.texture = {i * 120000 + below(6), 5000 + i * tilt + 3 * j + below(4)};
                    corners[i][j] = v;
                }
            const std::vector<Triangle> base =
                make_grid(1, 1, [&](int i, int j) { return corners[std::size_t(i)][std::size_t(j)]; });
            MeshMaker maker{[&](const Vertex& a, const Vertex& b) {
                                const std::uint32_t mix = (a.texture.u + b.texture.u) * 2654435761u ^
                                                          (a.texture.v + b.texture.v) * 40503u;
                                return std::abs(a.position.x - b.position.x) > 400 && (mix >> 20) % 3 != 0;
                            },
                            height_at, 12};
            const EmittedMesh mesh = maker.make(base);
            const InvariantResult result = check_invariants(mesh, base, plane.registers);
            INFO(n << ": " << result.first_violation);
            REQUIRE(result.passed());
            collapsed += result.collapsed;
            turned_over += result.turned_over;
            folded += result.coincident_edges;
            triangles += result.triangles;
        }
        INFO(triangles << " triangles");
        CHECK(collapsed > 1000);
        CHECK(turned_over > 1000);
        CHECK(folded > 0);
    }
}

TEST_CASE("a border that is not cut at midpoints") {
    // closed within, but on no datapath::midpoint. (areas_beyond_rounding guards that function itself, and cannot be
    // provoked from outside.)
    Plane plane;
    plane.base.resize(1);
    plane.mesh = usual_maker().make(plane.base);
    for (auto& t : plane.mesh.triangles)
        for (auto& c : t.corners)
            if (c.texture.v == 0 && c.texture.u != 0 && c.texture.u != 32u << 12)
                c.texture.v += 5;
    const InvariantResult result = plane.check();
    CHECK(result.cracks > 0);
    CHECK(result.area_mismatches == 1);
}

TEST_CASE("a cylinder's seam") {
    datapath::Registers registers = registers_for(map_side, map_side);
    const std::vector<Triangle> base = make_prism(6, map_side << 12);
    const EmittedMesh mesh = usual_maker().make(base);
    REQUIRE(mesh.triangles.size() > 100);

    SECTION("closes in repeat") {
        registers.map.address_u = datapath::AddressMode::repeat;
        const InvariantResult result = check_invariants(mesh, base, registers);
        require_only(result, {});
        CHECK(result.base_edges == 24);
        CHECK(result.border_base_edges == 12);
        CHECK(result.texture_seams == 0);

        SECTION("and is checked there") {
            EmittedMesh torn = mesh;
            for (auto& t : torn.triangles)
                for (auto& c : t.corners)
                    if (c.texture.u == map_side << 12)
                        c.displaced.x += 1;
            const InvariantResult open = check_invariants(torn, base, registers);
            CHECK(open.cracks > 2);
            CHECK(open.inconsistent_vertices > 2);
            CHECK(open.open_texture_seam_edges == 0);
        }
        SECTION("a T-vertex on it is found") {
            MeshMaker maker = usual_maker();
            maker.split = [](const Vertex& i, const Vertex& j) {
                // splits the seam from its last column only
                return near_a_place(i, j) || (i.texture.u == map_side << 12 && j.texture.u == i.texture.u &&
                                              i.generation + j.generation < 6);
            };
            const InvariantResult open = check_invariants(maker.make(base), base, registers);
            CHECK(open.t_vertices > 0);
            CHECK(open.cracks == 0);
            CHECK(open.open_texture_seam_edges == 0);
        }
    }
    SECTION("in clamp, what is open there is the map's doing") {
        const InvariantResult result = check_invariants(mesh, base, registers);
        CHECK(result.texture_seams == 1);
        require_only(result, {});  // this map's sides happen to agree

        MeshMaker maker = usual_maker();
        maker.height = [](const TexCoord& t) { return static_cast<std::int32_t>(t.u >> 8); };
        const InvariantResult open = check_invariants(maker.make(base), base, registers);
        CHECK(open.open_texture_seam_edges > 2);
        require_only(open, {{"open_texture_seam_edges", open.open_texture_seam_edges}});
        CHECK(open.passed());
    }
    SECTION("texture coordinates off by part of a period do not join in repeat") {
        registers.map.address_u = datapath::AddressMode::repeat;
        const std::vector<Triangle> off = make_prism(6, (map_side << 12) - 3000);
        const InvariantResult result = check_invariants(usual_maker().make(off), off, registers);
        CHECK(result.texture_seams == 1);
        CHECK(result.open_texture_seam_edges > 2);
        CHECK(result.passed());
        CHECK(result.cracks == 0);
        CHECK(result.t_vertices == 0);
    }
    SECTION("real faults elsewhere stay faults") {
        EmittedMesh torn = mesh;
        torn.triangles.erase(torn.triangles.begin() + 40);
        const InvariantResult result = check_invariants(torn, base, registers);
        CHECK(result.cracks == 3);
        CHECK_FALSE(result.passed());
    }
}

TEST_CASE("a crease of the base mesh is the input's") {
    Plane plane;
    for (std::size_t b = 4; b < 8; ++b)
        for (auto& v : plane.base[b].vertices)
            v.normal = {0, 11585, 11585};
    plane.mesh = usual_maker().make(plane.base);
    const InvariantResult result = plane.check();
    CHECK(result.creases == 2);
    CHECK(result.open_crease_edges > 4);
    require_only(result, {{"open_crease_edges", result.open_crease_edges}});
    CHECK(result.passed());
}

TEST_CASE("base edges of more than two triangles") {
    Plane plane;
    // a second copy of the base mesh, wound the other way
    const std::size_t once = plane.base.size();
    for (std::size_t b = 0; b < once; ++b) {
        Triangle other = plane.base[b];
        std::swap(other.vertices[0], other.vertices[1]);
        other.base = static_cast<std::uint32_t>(once + b);
        plane.base.push_back(other);
    }
    plane.mesh = usual_maker().make(plane.base);
    const InvariantResult result = plane.check();
    require_only(result, {});
    CHECK(result.base_edges == 16);
    CHECK(result.border_base_edges == 0);
    CHECK(result.non_manifold_base_edges == 8);

    for (auto& t : plane.mesh.triangles)
        for (auto& c : t.corners)
            if (t.base == once + 3)
                c.displaced.x += 1;
    CHECK(plane.check().cracks > 3);
}

}  // namespace tessera

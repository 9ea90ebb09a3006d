#include "testbench/check/mesh/invariants.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "modules/datapath/midpoint.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/inputs.h"
#include "testbench/tests/support/edited_mesh.h"
#include "testbench/tests/support/job_setup.h"

/// The emitted mesh against the expected one. test_lineage.cpp tests that the datapath's own mesh is closed.
namespace tessera {
namespace {

using Corner = EmittedTriangle::Corner;
using Expected = std::vector<std::pair<std::string, std::uint64_t>>;

/// Requires that every figure is zero except those given with their values; facts are ignored.
void require_only(const InvariantResult& result, const Expected& expected) {
    INFO(result.first_violation);
    for (const InvariantFigure& figure : invariant_figures(result)) {
        if (figure.kind == InvariantFigure::Kind::fact)
            continue;
        const auto found =
            std::find_if(expected.begin(), expected.end(), [&](const auto& e) { return e.first == figure.name; });
        INFO(figure.name);
        CHECK(figure.value == (found == expected.end() ? 0 : found->second));
    }
    CHECK(result.first_violation.empty() == result.passed());
}

/// A plane of 2 x 2 quads of base triangles over the whole map, and its mesh from the datapath.
struct Plane {
    MachineSetup setup = testing::setup_of(testing::noise_job());
    std::vector<EmittedTriangle> triangles;
    Plane() {
        EmittedMesh mesh;
        BareRecursion(setup).run(mesh);
        triangles = list_of(mesh);
    }

    InvariantResult check() const { return check_invariants({triangles}, setup); }

    /// The first triangle of base triangle 5.
    EmittedTriangle& some_triangle() {
        return *std::find_if(triangles.begin(), triangles.end(), [](const EmittedTriangle& t) { return t.base == 5; });
    }
};

}  // namespace

TEST_CASE("the datapath's own mesh passes, in any order") {
    Plane plane;
    const InvariantResult result = plane.check();
    require_only(result, {});
    CHECK(result.triangles == plane.triangles.size());
    CHECK(result.triangles > 100);
    CHECK(result.edges > 3 * result.triangles);
    CHECK(result.base_triangles == 8);
    CHECK(result.base_edges == 16);
    CHECK(result.border_base_edges == 8);
    CHECK(result.non_manifold_base_edges == 0);
    CHECK(result.texture_seams + result.creases == 0);
    std::shuffle(plane.triangles.begin(), plane.triangles.end(), std::mt19937(7));
    require_only(plane.check(), {});
}

TEST_CASE("missing and extra triangles are counted, and the first is shown") {
    const Plane plane;
    const std::size_t all = plane.triangles.size();
    SECTION("one missing, one twice") {
        for (std::size_t i = 0; i < all; i += 5) {
            Plane other = plane;
            other.triangles.erase(other.triangles.begin() + static_cast<std::ptrdiff_t>(i));
            require_only(other.check(), {{"missing_triangles", 1}});
            other = plane;
            other.triangles.push_back(other.triangles[i]);
            require_only(other.check(), {{"extra_triangles", 1}});
        }
    }
    SECTION("all of one base triangle, all of the mesh") {
        Plane other = plane;
        auto& t = other.triangles;
        t.erase(std::remove_if(t.begin(), t.end(), [](const auto& e) { return e.base == 3; }), t.end());
        REQUIRE(t.size() < all);
        require_only(other.check(), {{"missing_triangles", all - t.size()}});
        t.clear();
        require_only(other.check(), {{"missing_triangles", all}});
    }
    SECTION("the whole mesh twice, one triangle three times") {
        Plane other = plane;
        auto& t = other.triangles;
        t.insert(t.end(), plane.triangles.begin(), plane.triangles.end());
        require_only(other.check(), {{"extra_triangles", all}});
        other = plane;
        t.insert(t.end(), 2, plane.triangles.front());
        require_only(other.check(), {{"extra_triangles", 2}});
    }
    SECTION("together with its reverse, so that each edge has equally many triangles on both sides") {
        Plane other = plane;
        EmittedTriangle triangle = other.some_triangle();
        other.triangles.push_back(triangle);
        std::swap(triangle.corners[0], triangle.corners[1]);
        other.triangles.push_back(triangle);
        require_only(other.check(), {{"extra_triangles", 2}, {"turned_over", 1}});
    }
    SECTION("of a base triangle that does not exist, or of another") {
        Plane other = plane;
        other.some_triangle().base = 8;
        InvariantResult result = other.check();
        require_only(result, {{"missing_triangles", 1}, {"extra_triangles", 1}});
        CHECK(result.first_violation.find(
                  "base triangle 8: a triangle from a base triangle that does not exist: P (") == 0);
        other = plane;
        other.some_triangle().base = 3;
        require_only(other.check(), {{"missing_triangles", 1}, {"extra_triangles", 1}});
    }
    SECTION("the first is described") {
        Plane other = plane;
        const EmittedTriangle triangle = other.some_triangle();
        other.triangles.push_back(triangle);
        CHECK(other.check().first_violation.find("base triangle 5: an extra triangle: P (") == 0);
        other = plane;
        other.triangles.erase(other.triangles.begin() + (&other.some_triangle() - other.triangles.data()));
        const std::string text = other.check().first_violation;
        CHECK(text.find("base triangle 5: a triangle is missing: P (") == 0);
        CHECK(text.find(" = texel (") != std::string::npos);
        CHECK(text.find("; split by ") != std::string::npos);
    }
}

TEST_CASE("a triangle that differs in any field is found") {
    const Plane plane;
    const auto check_with = [&](const std::function<void(EmittedTriangle&)>& change) {
        Plane other = plane;
        change(other.some_triangle());
        return other.check();
    };
    SECTION("in a field other than its three places: it counts as differing") {
        const std::vector<std::function<void(EmittedTriangle&)>> changes{
            [](auto& t) { t.corners[0].displaced.x += 1; },
            [](auto& t) { t.corners[1].displaced.y -= 1; },
            [](auto& t) { t.corners[2].displaced.z += 1; },
            [](auto& t) { t.corners[2].displaced_normal.x += 1; },
            [](auto& t) { t.corners[1].displaced_normal.y += 1; },
            [](auto& t) { t.corners[0].displaced_normal.z -= 1; },
            [](auto& t) { --t.corners[0].generation; },
            [](auto& t) { t.split_by ^= datapath::summed_height_bit; },
            [](auto& t) { t.stopped_by ^= datapath::view_bit; },
            [](auto& t) { t.culled = !t.culled; },
            [](auto& t) { std::rotate(t.corners.begin(), t.corners.begin() + 1, t.corners.end()); }};
        for (const auto& change : changes) {
            require_only(check_with(change), {{"differing_triangles", 1}});
            EmittedTriangle changed = plane.triangles.front();
            change(changed);
            CHECK_FALSE(changed == plane.triangles.front());
        }
        const std::string text = check_with(changes[0]).first_violation;
        CHECK(text.find("base triangle 5: a triangle differs: P (") == 0);
        CHECK(text.find("; expected P (") != std::string::npos);
    }
    SECTION("in one of its places: it counts as missing and extra") {
        const std::vector<std::function<void(Corner&)>> changes{
            [](Corner& c) { c.position.x += 1; }, [](Corner& c) { c.position.y += 1; },
            [](Corner& c) { c.position.z += 1; }, [](Corner& c) { c.texture.u ^= 1; },
            [](Corner& c) { c.texture.v ^= 1; }};
        for (const auto& change : changes)
            require_only(check_with([&](EmittedTriangle& t) { change(t.corners[1]); }),
                         {{"missing_triangles", 1}, {"extra_triangles", 1}});
    }
    SECTION("turned over") {
        require_only(check_with([](auto& t) { std::swap(t.corners[0], t.corners[2]); }),
                     {{"differing_triangles", 1}, {"turned_over", 1}});
    }
    SECTION("a whole patch moved as one, without a crack") {
        Plane other = plane;
        std::uint64_t moved = 0;
        for (EmittedTriangle& t : other.triangles)
            if (t.base == 2) {
                ++moved;
                for (Corner& c : t.corners)
                    c.displaced.x += 1;
            }
        require_only(other.check(), {{"differing_triangles", moved}});
    }
    SECTION("split on one edge only, as by a unit that decides per triangle") {
        for (std::size_t k = 0; k < 3; ++k) {
            Plane other = plane;
            EmittedTriangle &first = other.some_triangle(), second = first;
            Corner middle = first.corners[k];
            const Corner& end = first.corners[(k + 1) % 3];
            middle.position = datapath::midpoint(middle.position, end.position);
            middle.texture = datapath::midpoint(middle.texture, end.texture);
            middle.displaced = datapath::midpoint(middle.displaced, end.displaced);
            first.corners[(k + 1) % 3] = second.corners[k] = middle;
            other.triangles.push_back(second);
            require_only(other.check(), {{"missing_triangles", 1}, {"extra_triangles", 2}});
        }
    }
}

TEST_CASE("the check ends even if the datapath's recursion does not") {
    Plane plane;
    datapath::TestParameters& tests = plane.setup.registers.tests;
    tests.generation_test = tests.tex_coord_test = false;
    tests.normal_threshold = 0;  // every edge that crosses a border of the noise's texels splits
    const InvariantResult result = plane.check();
    CHECK(result.edges > 3'000'000);
    CHECK(result.edges <= 24 * result.triangles + 3'000'003);
    CHECK(result.cracks == 0);  // not determined
    CHECK(result.unfinished == 1);
    CHECK(result.violations() == 1 + result.wrong_triangles() + result.generation_violations);
    CHECK(result.missing_triangles > 0);
    CHECK_FALSE(result.first_violation.empty());
}

TEST_CASE("single triangles are counted in their figures") {
    const Plane plane;
    SECTION("collapsed, in t and in P'") {
        Plane other = plane;
        auto& c = other.some_triangle().corners;
        c[1].texture = c[0].texture;
        require_only(other.check(), {{"missing_triangles", 1}, {"extra_triangles", 1}, {"collapsed", 1}});
        other = plane;
        auto& d = other.some_triangle().corners;
        d[2].displaced = d[0].displaced;
        require_only(other.check(), {{"differing_triangles", 1}, {"displaced_collapsed", 1}});
    }
    SECTION("beyond the generation limit, if there is one") {
        Plane other = plane;
        other.some_triangle().corners[2].generation = 5;
        require_only(other.check(), {{"differing_triangles", 1}, {"generation_violations", 1}});
        other.some_triangle().corners[2].generation = 4;
        CHECK(other.check().generation_violations == 0);
        other.some_triangle().corners[2].generation = 5;
        other.setup.registers.tests.summed_height_test = other.setup.registers.tests.normal_test = false;
        other.setup.registers.tests.generation_test = false;
        CHECK(other.check().generation_violations == 0);
    }
    SECTION("base triangles without texture area or with opposite winding count nothing as turned over") {
        MachineSetup setup = plane.setup;
        auto& flat = setup.base_triangles[0].vertices;
        flat[2].texture = datapath::midpoint(flat[0].texture, flat[1].texture);
        std::swap(setup.base_triangles[1].vertices[0], setup.base_triangles[1].vertices[1]);
        EmittedMesh mesh;
        BareRecursion(setup).run(mesh);
        std::uint64_t of_0 = 0;
        for (const EmittedTriangle& triangle : mesh.triangles)
            of_0 += triangle.base == 0 ? 1u : 0u;
        REQUIRE(of_0 > 1);
        const InvariantResult result = check_invariants(mesh, setup);
        CHECK(result.collapsed == of_0);
        CHECK(result.turned_over == 0);
        CHECK(result.missing_triangles + result.extra_triangles + result.differing_triangles == 0);
    }
}

TEST_CASE("each violation counts, effects of rounding and of the input do not, the figures are complete") {
    InvariantResult result;
    CHECK_FALSE(result.passed());  // nothing was checked
    result.triangles = result.edges = 1;
    result.collapsed = result.turned_over = result.displaced_collapsed = 5;
    result.open_texture_seam_edges = result.open_crease_edges = 2;
    CHECK(result.passed());
    for (std::uint64_t InvariantResult::*const violation :
         {&InvariantResult::t_vertices, &InvariantResult::cracks, &InvariantResult::inconsistent_vertices,
          &InvariantResult::missing_triangles, &InvariantResult::extra_triangles, &InvariantResult::differing_triangles,
          &InvariantResult::generation_violations, &InvariantResult::unfinished}) {
        InvariantResult one = result;
        one.*violation = 3;
        CHECK(one.violations() == 3);
        CHECK_FALSE(one.passed());
        std::uint64_t named = 0;
        std::set<std::string> names;
        for (const InvariantFigure& figure : invariant_figures(one)) {
            CHECK(names.insert(figure.name).second);
            named += figure.kind == InvariantFigure::Kind::violation ? figure.value : 0;
        }
        CHECK(named == 3);
    }
}

}  // namespace tessera

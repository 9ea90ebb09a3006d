#include <algorithm>
#include <catch2/catch.hpp>
#include <tuple>
#include <vector>

#include "testbench/check/mesh/invariants.h"
#include "testbench/input/map/built_in_maps.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/setup/mesh/whole_periods.h"
#include "testbench/tests/support/refusals.h"

// Texture coordinates that tile: reduced by whole periods, without a change to the resulting mesh.

using namespace tessera;
using Catch::Contains;

namespace {

Job tiling_job() {
    Job job;
    job.mode = Mode::functional;
    job.map.address_u = job.map.address_v = Addressing::repeat;
    job.tests.view_threshold = 20;
    return job;
}

struct Run {
    MachineSetup setup;
    EmittedMesh mesh;

    Run(const Job& job, const BaseMesh& base, const HeightMap& map)
        : setup(make_setup(resolve_job(job, base, map).job, base, map)) {
        BareRecursion(setup).run(mesh);
        mesh.sort();
    }

    /// Base triangle, P' and N' of every triangle, in an order that does not depend on texture coordinates.
    auto surface() const {
        using Corner = std::array<std::int32_t, 6>;
        std::vector<std::tuple<std::uint32_t, Corner, Corner, Corner>> result;
        for (const EmittedTriangle& t : mesh.triangles) {
            std::array<Corner, 3> c;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& p = t.corners[k].displaced;
                const auto& n = t.corners[k].displaced_normal;
                c[k] = {p.x, p.y, p.z, n.x, n.y, n.z};
            }
            std::sort(c.begin(), c.end());
            result.emplace_back(t.base, c[0], c[1], c[2]);
        }
        std::sort(result.begin(), result.end());
        return result;
    }

    bool holds() const { return check_invariants(mesh, setup).passed(); }
};

BaseMesh shifted(BaseMesh mesh, const glm::dvec2& shift) {
    for (BaseVertex& vertex : mesh.vertices)
        vertex.texture += shift;
    return mesh;
}

BaseMesh stretched(BaseMesh mesh, const glm::dvec2& factor) {
    for (BaseVertex& vertex : mesh.vertices)
        vertex.texture *= factor;
    return mesh;
}

}  // namespace

TEST_CASE("a chart is shifted by a whole number of periods on the repeating axes") {
    BaseMesh mesh = make_plane(1, 1, 2, 2);  // u, v: 0..1
    const BaseMesh low = bring_down_texture(shifted(mesh, {1234, -7}), {true, true}, {16, 16});
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        CHECK(low.vertices[v].texture == mesh.vertices[v].texture);
    const BaseMesh half = bring_down_texture(shifted(mesh, {1234.75, -7.5}), {true, false}, {16, 16});
    CHECK(half.vertices[0].texture.x == Approx(mesh.vertices[0].texture.x + 0.75));
    CHECK(half.vertices[0].texture.y == mesh.vertices[0].texture.y - 7.5);
    CHECK(half.triangles == mesh.triangles);
}

TEST_CASE("each chart is shifted separately, and vertices of equal position and texture belong to one chart") {
    const auto triangle = [](double u, std::uint32_t first) {
        BaseMesh mesh;
        for (const glm::dvec2 t : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1)}) {
            BaseVertex vertex;
            vertex.position = {t.x + u, t.y, 0};
            vertex.texture = {t.x + u, t.y};
            mesh.vertices.push_back(vertex);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
        return mesh;
    };
    const auto both = [&](double u) {
        BaseMesh mesh = triangle(3, 0), other = triangle(u, 3);
        mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
        mesh.triangles.push_back(other.triangles.front());
        return bring_down_texture(mesh, {true, true}, {16, 16});
    };
    CHECK(both(9).vertices[0].texture.x == 0);
    CHECK(both(9).vertices[3].texture.x == 0);
    CHECK(both(4).vertices[0].texture.x == 0);  // they share the point (4, 0) and its texture coordinate
    CHECK(both(4).vertices[3].texture.x == 1);
}

TEST_CASE("a chart wider than the format is shifted triangle by triangle") {
    const BaseMesh mesh = stretched(make_plane(40, 1, 2, 2), {40, 1});
    const BaseMesh low = bring_down_texture(mesh, {true, false}, {4, 1});
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const BaseVertex &was = mesh.vertices[mesh.triangles[t][k]], &is = low.vertices[low.triangles[t][k]];
            CHECK(is.position == was.position);
            CHECK((is.texture.x >= 0 && is.texture.x <= 1.0001));
            const double periods = was.texture.x - is.texture.x;
            CHECK(periods == Approx(std::nearbyint(periods)).margin(1e-9));
        }
    for (const BaseVertex& vertex : low.vertices)
        CHECK(vertex.texture.x <= 2);
}

TEST_CASE("a mesh with coordinates thousands of periods away gives the same result") {
    const HeightMap map = noise_map(64, 64, 3);
    const BaseMesh cylinder = make_cylinder(12, 4, 1, 2);
    const Run here(tiling_job(), cylinder, map), far(tiling_job(), shifted(cylinder, {5000, -3000}), map);
    CHECK(here.mesh.triangles.size() > 1000);
    CHECK(here.surface() == far.surface());
    for (std::size_t k = 0; k < here.mesh.triangles.size(); ++k)
        CHECK(here.mesh.triangles[k].corners[0].texture == far.mesh.triangles[k].corners[0].texture);
}

TEST_CASE("triangles shifted separately decide as those of one chart, and no seam opens") {
    const HeightMap map = noise_map(32, 32, 5);
    const BaseMesh base = stretched(make_plane(9, 7, 2, 2), {10.25, 9.5});  // edges cross periods anywhere
    Job one = tiling_job(), each = tiling_job();
    each.formats.texture_integer = 7;  // 128 texels, four periods; one chart has 328
    const Run whole(one, base, map), split(each, base, map);
    CHECK(whole.mesh.triangles.size() > 1000);
    CHECK(split.holds());
    CHECK(whole.surface() == split.surface());
    const InvariantResult seams = check_invariants(split.mesh, split.setup);
    CHECK(seams.open_texture_seam_edges == 0);
}

namespace {

std::string refusal(const Job& job, const BaseMesh& base, const HeightMap& map) {
    return testing::input_error_of([&] { make_setup(resolve_job(job, base, map).job, base, map); });
}

}  // namespace

TEST_CASE("a triangle of more periods than the format holds is refused") {
    const BaseMesh base = stretched(make_plane(1, 1, 2, 2), {100, 1});
    CHECK_THAT(refusal(tiling_job(), base, noise_map(64, 64, 1)),
               Contains("beyond the 0..4096") &&
                   Contains("use a map of at most 40 texels a side, or triangles that repeat it less often"));
}

TEST_CASE("a lattice that extends beyond the format is refused, and a smaller spacing is suggested") {
    const HeightMap map = noise_map(3000, 4, 1);
    const auto refused = [&](std::int64_t spacing) {
        return refusal({}, make_lattice({3000, 4}, {false, false}, spacing, 2, 2), map);
    };
    CHECK_THAT(refused(2048), Contains("beyond the 0..4096") && Contains("smaller mesh.spacing"));
    CHECK(refused(1024).empty());
}

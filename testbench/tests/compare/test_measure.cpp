#include <catch2/catch.hpp>
#include <numeric>

#include "testbench/common/error.h"
#include "testbench/common/parallel.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/tests/compare/measure_cases.h"

using namespace tessera;

namespace {

const std::array<Sampling, 2> both{Sampling::interpolated, Sampling::nearest_texel};

DisplacementOf heights(double scale, double bias = 0, Addressing mode = Addressing::clamp) {
    return {scale, bias, mode, mode};
}

SurfaceError measured(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                      const RecordedMesh& mesh, Sampling sampling = Sampling::interpolated) {
    return measure_surface_error(base, map, displacement, mesh, sampling);
}

void require_constant(const DirectedError& error, double distance) {
    CHECK(error.max == Approx(distance).epsilon(1e-12).margin(1e-13));
    CHECK(error.rms == Approx(distance).epsilon(1e-12).margin(1e-13));
    CHECK(error.samples > 0);
    REQUIRE(error.worst);
}

}  // namespace

TEST_CASE("a plane displaced by a constant is at that distance from its base, for any map and position") {
    for (const int size : {1, 2, 7}) {
        const HeightMap map = make_map(size, size + 1, [](int, int) { return 0.5; });
        for (const double offset : {0.0, 1e6}) {
            BaseMesh base = make_plane(2, 3, 2, 2);
            for (BaseVertex& v : base.vertices)
                v.position += offset;
            for (const Sampling sampling : both) {
                INFO(size << " texels, offset " << offset);
                const SurfaceError error = measured(base, map, heights(0.5, 0.125), emitted(base), sampling);
                const double tolerance = offset * 1e-15;
                CHECK(error.reference_to_mesh.max == Approx(0.375).margin(tolerance));
                CHECK(error.reference_to_mesh.rms == Approx(0.375).margin(tolerance));
                CHECK(error.mesh_to_reference.max == Approx(0.375).margin(tolerance));
                CHECK(error.mesh_to_reference.rms == Approx(0.375).margin(tolerance));
            }
        }
    }
}

TEST_CASE("a mesh equal to the surface has no error, and one shifted by d has the error d") {
    const BaseMesh base = make_plane(3, 3, 3, 2);
    const HeightMap map = make_map(6, 4, [](int, int) { return 1; });
    for (const double d : {0.0, 1e-9, 0.25, -3.0, 1e3}) {
        INFO(d);
        const RecordedMesh mesh =
            emitted(base, [&](const BaseVertex& v) { return v.position + glm::dvec3(0, 0, 2 + d); });
        const SurfaceError error = measured(base, map, heights(2), mesh);
        CHECK(error.reference_to_mesh.max == Approx(std::abs(d)).epsilon(1e-6).margin(1e-14));
        CHECK(error.mesh_to_reference.rms == Approx(std::abs(d)).epsilon(1e-6).margin(1e-14));
        for (const double vertex : error.vertices)
            CHECK(vertex == Approx(std::abs(d)).epsilon(1e-6).margin(1e-14));
        for (const TriangleError& t : error.triangles) {
            CHECK(static_cast<double>(t.max) == Approx(std::abs(d)).epsilon(1e-6).margin(1e-14));
            CHECK(static_cast<double>(t.rms) == Approx(std::abs(d)).epsilon(1e-6).margin(1e-14));
            if (std::abs(d) < 1)
                CHECK(static_cast<double>(t.reference_max) == Approx(std::abs(d)).epsilon(1e-6).margin(1e-14));
        }
    }
    // After a shift sideways only the parts outside the other's outline have a distance.
    const RecordedMesh aside = emitted(base, [](const BaseVertex& v) { return v.position + glm::dvec3(0.25, 0, 2); });
    const SurfaceError error = measured(base, map, heights(2), aside);
    CHECK(error.reference_to_mesh.max == Approx(0.25));
    CHECK(error.mesh_to_reference.max == Approx(0.25));
    CHECK(error.reference_to_mesh.worst->position.x == Approx(-1.5));
    CHECK(error.mesh_to_reference.worst->position.x == Approx(1.75));
    CHECK(error.hausdorff() == Approx(0.25));
}

TEST_CASE("a tent over its undisplaced base has the error of the closed form") {
    // Nine texels of one model unit: 0 at the first centre, 1 at the fifth, 0 at the ninth; level beyond these.
    const BaseMesh base = make_plane(2, 1, 9, 1);
    const HeightMap map = make_map(9, 1, [](int x, int) { return 1 - std::abs(x - 4) / 4.0; });
    const double top = 3;
    const SurfaceError error = measured(base, map, heights(top), emitted(base));
    CHECK(error.reference_to_mesh.max == Approx(top));
    CHECK(error.reference_to_mesh.worst->position.z == Approx(top));
    CHECK(error.reference_to_mesh.worst->texture.x == Approx(0.5));
    // The integral of its square is 2 * 4 * top^2 / 3, over a length of 9.
    CHECK(error.reference_to_mesh.rms == Approx(top * std::sqrt(8.0 / 27)).epsilon(2e-3));
    // Below the ridge the nearest point lies on the slope, perpendicular to it; the base has a vertex there.
    CHECK(error.mesh_to_reference.max == Approx(4 * top / 5));
    CHECK(error.mesh_to_reference.worst->position.x == Approx(0).margin(1e-12));
    // As the hardware reads the map, the ridge is one texel wide.
    const SurfaceError steps = measured(base, map, heights(top), emitted(base), Sampling::nearest_texel);
    CHECK(steps.reference_to_mesh.max == Approx(top));
    double squares = 0;
    for (const float value : map.values)
        squares += static_cast<double>(value) * static_cast<double>(value) / 9;
    CHECK(steps.reference_to_mesh.rms == Approx(top * std::sqrt(squares)).epsilon(0.02));
}

TEST_CASE("the map is read between texels, interpolated and as the hardware reads it") {
    const HeightMap map = make_map(3, 2, [](int x, int y) { return x + 10 * y; });
    const BaseMesh base = make_plane(1, 1, 1, 1);
    const auto value = [&](double u, double v, Sampling sampling, Addressing mode) {
        return DisplacedSurface(base, map, heights(1, 0, mode), LocalFrame{}).value({u, v}, sampling);
    };
    using S = Sampling;
    using A = Addressing;
    for (const A mode : {A::clamp, A::repeat})
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x)
                for (const S sampling : both)
                    CHECK(value(x + 0.5, y + 0.5, sampling, mode) == x + 10 * y);
    CHECK(value(1, 0.5, S::interpolated, A::clamp) == Approx(0.5));
    CHECK(value(1, 1, S::interpolated, A::clamp) == Approx(5.5));
    CHECK(value(1, 0.5, S::nearest_texel, A::clamp) == 1);
    CHECK(value(0, 0, S::interpolated, A::clamp) == 0);
    CHECK(value(3, 2, S::interpolated, A::clamp) == 12);
    CHECK(value(3, 2, S::nearest_texel, A::clamp) == 12);
    CHECK(value(3, 2, S::nearest_texel, A::repeat) == 0);  // golden/ALGORITHM.md 2
    CHECK(value(0, 0.5, S::interpolated, A::repeat) == Approx(1));
    CHECK(value(3, 0.5, S::interpolated, A::repeat) == Approx(1));
    CHECK(value(-2.5, -1.5, S::interpolated, A::repeat) == Approx(0));
    CHECK(value(7.5, 1.5, S::nearest_texel, A::repeat) == 11);
    // on an edge except for rounding
    CHECK(value(2 - 1e-13, 0.5, S::nearest_texel, A::clamp) == 2);
}

TEST_CASE("a point of a curved base is displaced along the renormalised interpolated normal") {
    const BaseMesh base = make_cylinder(4, 1, 2, 3);
    const HeightMap map = make_map(1, 1, [](int, int) { return 0.5; });
    const DisplacedSurface surface(base, map, heights(2, 1), LocalFrame{});
    for (std::size_t k = 0; k < surface.triangles(); ++k) {
        const auto corners = surface.corners(k);
        const glm::dvec3 b(0.2, 0.3, 0.5);
        const glm::dvec3 p = surface.point(corners, b, Sampling::interpolated);
        glm::dvec3 middle(0), normal(0);
        for (int c = 0; c < 3; ++c) {
            const BaseVertex& v = base.vertices[base.triangles[k][static_cast<std::size_t>(c)]];
            middle += b[c] * v.position;
            normal += b[c] * v.normal;
        }
        CHECK(glm::length(p - (middle + 2.0 * glm::normalize(normal))) < 1e-12);
    }
}

TEST_CASE("figures equal those of an exhaustive comparison") {
    std::mt19937 random(7);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int round = 0; round < 12; ++round) {
        INFO("round " << round);
        const Addressing mode = round % 2 == 0 ? Addressing::clamp : Addressing::repeat;
        BaseMesh base = round % 3 == 0   ? make_plane(2, 1, 2, 1)
                        : round % 3 == 1 ? make_cylinder(3, 1, 1, 2)
                                         : make_plane(1, 1, 1, 3);
        const HeightMap map = make_map(1 + round % 5, 1 + round / 3, [&](int, int) { return uniform(0, 1); });
        // Triangles of several sizes, anywhere near the surface; some are degenerate.
        RecordedMesh mesh;
        const int count = 1 + 7 * round;
        for (int k = 0; k < count; ++k) {
            const glm::dvec3 centre(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
            const double size = std::pow(10, uniform(-3, 0));
            RecordedMesh::Triangle t;
            t.base = static_cast<std::uint32_t>(k) % static_cast<std::uint32_t>(base.triangles.size());
            for (std::uint32_t c = 0; c < 3; ++c) {
                t.vertices[c] = static_cast<std::uint32_t>(mesh.positions.size());
                mesh.positions.push_back(centre + size * glm::dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
                mesh.normals.emplace_back(0, 0, 1);
                mesh.textures.emplace_back(uniform(0, 1), uniform(0, 1));
            }
            if (k % 5 == 4)
                mesh.positions[t.vertices[2]] = mesh.positions[t.vertices[1]];
            mesh.triangles.push_back(t);
        }
        for (const Sampling sampling : both) {
            const DisplacementOf displacement = heights(uniform(0.1, 3), uniform(-1, 1), mode);
            const SurfaceError error = measured(base, map, displacement, mesh, sampling);
            const BruteForce wanted = brute_force(base, map, displacement, mesh, sampling);
            CHECK(error.reference_to_mesh.max == Approx(wanted.reference_max).epsilon(1e-10));
            CHECK(error.reference_to_mesh.rms == Approx(wanted.reference_rms).epsilon(1e-10));
            CHECK(error.mesh_to_reference.max == Approx(wanted.mesh_max).epsilon(1e-10));
            CHECK(error.mesh_to_reference.rms == Approx(wanted.mesh_rms).epsilon(1e-10));
        }
    }
}

TEST_CASE("many tiles and a fine mesh give the figures of an exhaustive comparison") {
    std::mt19937 random(11);
    const BaseMesh base = make_plane(1, 1, 2, 2);
    const HeightMap map =
        make_map(13, 9, [&](int, int) { return std::uniform_real_distribution<double>(0, 1)(random); });
    const BaseMesh fine = make_plane(9, 11, 2, 2);
    for (const double scale : {0.05, 5.0}) {  // smooth on the scale of a texel, and with needles
        const DisplacedSurface surface(fine, map, heights(scale), LocalFrame{});
        RecordedMesh mesh = emitted(fine, [&](const BaseVertex& v) {
            const double value = surface.value(v.texture * glm::dvec2(13, 9), Sampling::nearest_texel);
            return v.position + scale * value * v.normal;
        });
        for (RecordedMesh::Triangle& t : mesh.triangles)
            t.base = 0;
        for (const Sampling sampling : both) {
            const SurfaceError error = measured(base, map, heights(scale), mesh, sampling);
            const BruteForce wanted = brute_force(base, map, heights(scale), mesh, sampling);
            CHECK(error.reference_to_mesh.max == Approx(wanted.reference_max).epsilon(1e-10));
            CHECK(error.reference_to_mesh.rms == Approx(wanted.reference_rms).epsilon(1e-10));
            CHECK(error.mesh_to_reference.max == Approx(wanted.mesh_max).epsilon(1e-10));
            CHECK(error.mesh_to_reference.rms == Approx(wanted.mesh_rms).epsilon(1e-10));
            float largest = 0, seen = 0;
            for (const TriangleError& t : error.triangles) {
                largest = std::max(largest, t.max);
                seen = std::max(seen, t.reference_max);
                CHECK(t.rms <= t.max);
            }
            CHECK(static_cast<double>(largest) == Approx(wanted.mesh_max).epsilon(1e-6));
            CHECK(static_cast<double>(seen) == Approx(wanted.reference_max).epsilon(1e-6));
        }
    }
}

TEST_CASE("mirroring, rotating corners and reordering triangles change no figure") {
    const BaseMesh base = make_plane(2, 2, 2, 2);
    const auto value = [](int x, int y) { return (x * 7 + y * 3) % 5 / 4.0; };
    const HeightMap map = make_map(8, 8, value);
    const RecordedMesh mesh = emitted(
        base, [](const BaseVertex& v) { return v.position + glm::dvec3(0, 0, 0.3 * v.texture.x + 0.1 * v.texture.y); });
    const Sampling sampling = GENERATE(Sampling::interpolated, Sampling::nearest_texel);
    const SurfaceError error = measured(base, map, heights(0.5), mesh, sampling);
    const auto same = [&](const SurfaceError& other) {
        CHECK(other.reference_to_mesh.max == Approx(error.reference_to_mesh.max).epsilon(1e-12));
        CHECK(other.reference_to_mesh.rms == Approx(error.reference_to_mesh.rms).epsilon(1e-12));
        CHECK(other.mesh_to_reference.max == Approx(error.mesh_to_reference.max).epsilon(1e-12));
        CHECK(other.mesh_to_reference.rms == Approx(error.mesh_to_reference.rms).epsilon(1e-12));
    };
    RecordedMesh turned = mesh;
    std::rotate(turned.triangles.begin(), turned.triangles.begin() + 3, turned.triangles.end());
    for (RecordedMesh::Triangle& t : turned.triangles)
        std::rotate(t.vertices.begin(), t.vertices.begin() + 1, t.vertices.end());
    same(measured(base, map, heights(0.5), turned, sampling));

    BaseMesh mirrored_base = base;
    for (BaseVertex& v : mirrored_base.vertices) {
        v.position.x = -v.position.x;
        v.texture.x = 1 - v.texture.x;
    }
    RecordedMesh mirrored = mesh;
    for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
        mirrored.positions[k].x = -mirrored.positions[k].x;
        mirrored.textures[k].x = 1 - mirrored.textures[k].x;
    }
    same(measured(mirrored_base, make_map(8, 8, [&](int x, int y) { return value(7 - x, y); }), heights(0.5), mirrored,
                  sampling));
    // Repeating the measurement gives the same bits.
    const SurfaceError again = measured(base, map, heights(0.5), mesh, sampling);
    CHECK(again.reference_to_mesh.rms == error.reference_to_mesh.rms);
    CHECK(again.mesh_to_reference.rms == error.mesh_to_reference.rms);
    CHECK(again.vertices == error.vertices);
}

TEST_CASE("an empty mesh, one triangle, a collapsed triangle and one point are measured") {
    const BaseMesh base = make_plane(1, 1, 2, 2);
    const HeightMap map = make_map(2, 2, [](int, int) { return 1; });
    for (const Sampling sampling : both) {
        const SurfaceError none = measured(base, map, heights(1), RecordedMesh{}, sampling);
        CHECK(std::isinf(none.reference_to_mesh.max));
        CHECK(std::isinf(none.reference_to_mesh.rms));
        CHECK_FALSE(none.reference_to_mesh.worst);
        CHECK(none.mesh_to_reference.samples == 0);
        CHECK(none.mesh_to_reference.max == 0);
        CHECK_FALSE(none.mesh_to_reference.worst);

        RecordedMesh one;
        one.positions = {{-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}};
        one.normals.resize(3);
        one.textures = {{0, 0}, {1, 0}, {0, 1}};
        one.triangles.resize(1);
        one.triangles[0].vertices = {0, 1, 2};
        const SurfaceError half = measured(base, map, heights(1), one, sampling);
        require_constant(half.mesh_to_reference, 0);
        CHECK(half.reference_to_mesh.max == Approx(std::sqrt(2)));
        CHECK(half.reference_to_mesh.worst->triangle == 0);

        RecordedMesh segment = one;
        segment.positions[2] = segment.positions[1];
        CHECK(measured(base, map, heights(1), segment, sampling).reference_to_mesh.max == Approx(2));
        CHECK(measured(base, map, heights(1), segment, sampling).mesh_to_reference.max == Approx(0).margin(1e-13));
        RecordedMesh point = one;
        point.positions = {{0, 0, 5}, {0, 0, 5}, {0, 0, 5}};
        const SurfaceError far = measured(base, map, heights(1), point, sampling);
        CHECK(far.reference_to_mesh.max == Approx(std::sqrt(18)));
        require_constant(far.mesh_to_reference, 4);
    }
}

TEST_CASE("the worst spot reports its triangle's generation and the tests that stopped it") {
    const BaseMesh base = make_plane(1, 1, 2, 2);
    const HeightMap map = make_map(2, 2, [](int, int) { return 0; });
    RecordedMesh mesh = emitted(base, [](const BaseVertex& v) {
        return v.position + glm::dvec3(0, 0, v.texture == glm::dvec2(1, 0) ? 0.5 : 0);
    });
    const auto corner_of = [&](const RecordedMesh::Triangle& t) {
        for (const std::uint32_t v : t.vertices)
            if (mesh.positions[v].z > 0)
                return true;
        return false;
    };
    for (RecordedMesh::Triangle& t : mesh.triangles) {
        t.generation = corner_of(t) ? 7 : 3;
        t.stopped_by = corner_of(t) ? 20 : 8;
    }
    const SurfaceError error = measured(base, map, heights(1), mesh);
    REQUIRE(error.mesh_to_reference.worst);
    const WorstSpot& spot = *error.mesh_to_reference.worst;
    CHECK(spot.generation == 7);
    CHECK(spot.stopped_by == 20);
    CHECK(spot.base == mesh.triangles[spot.triangle].base);
    CHECK(spot.texture == glm::dvec2(1, 0));
    CHECK(spot.position == glm::dvec3(1, -1, 0.5));
}

TEST_CASE("a surface that closes in u is measured across its seam") {
    const BaseMesh base = make_cylinder(16, 2, 1, 1);
    const HeightMap map = make_map(16, 4, [](int x, int) { return x == 0 || x == 15 ? 1 : 0; });
    // Interpolated across the seam the two texels of height 1 form one ridge; clamped too, but level at the end.
    const DisplacementOf displacement{0.5, 0, Addressing::repeat, Addressing::clamp};
    const DisplacedSurface surface(base, map, displacement, LocalFrame{});
    CHECK(surface.value({0, 2}, Sampling::interpolated) == 1);
    CHECK(surface.value({16, 2}, Sampling::interpolated) == 1);
    BaseMesh shifted = base;  // shifted by whole periods: the same surface
    for (BaseVertex& v : shifted.vertices)
        v.texture.x += 3;
    const SurfaceError one = measured(base, map, displacement, emitted(base));
    const SurfaceError other = measured(shifted, map, displacement, emitted(shifted));
    CHECK(one.reference_to_mesh.max == Approx(0.5).epsilon(0.05));
    CHECK(other.reference_to_mesh.max == Approx(one.reference_to_mesh.max).epsilon(1e-9));
    CHECK(other.reference_to_mesh.rms == Approx(one.reference_to_mesh.rms).epsilon(1e-9));
    CHECK(other.mesh_to_reference.rms == Approx(one.mesh_to_reference.rms).epsilon(1e-9));
}

TEST_CASE("limits lower the density to one facet per base triangle at least, and are reported") {
    const BaseMesh base = make_plane(2, 2, 2, 2);
    const HeightMap map = make_map(64, 64, [](int x, int y) { return (x + y) % 2; });
    const DisplacedSurface surface(base, map, heights(1), LocalFrame{});
    const ReferenceLattice full(surface, 1u << 26);
    CHECK(full.density() == 4);
    CHECK(full.samples() == 8u * 129 * 130 / 2);
    const ReferenceLattice coarse(surface, 10000);
    CHECK(coarse.samples() <= 10000);
    CHECK(coarse.samples() > 8000);
    CHECK(coarse.density() == Approx(4 * std::sqrt(10000.0 / (8 * 129 * 130 / 2))).epsilon(0.05));
    // Three points for each of eight triangles, whose longest edges span 32 texels along an axis.
    const ReferenceLattice least(surface, 23);
    CHECK(least.samples() == 24);
    CHECK(least.density() == 1.0 / 32);
    const RecordedMesh mesh = emitted(base);
    MeasureLimits limits;
    limits.reference_samples = 10000;
    limits.mesh_samples = 100;
    const MeshError error = measure_error(base, map, heights(1), mesh, limits);
    CHECK(error.reference_density < 4);
    CHECK(error.mesh_density < 1);
    CHECK(error.interpolated.mesh_to_reference.samples <= 100 + mesh.positions.size() + mesh.triangles.size());
    CHECK(error.interpolated.reference_to_mesh.samples <= 10000);
}

TEST_CASE("the error is the same on any number of threads, and progress ends at 1") {
    const BaseMesh base = make_cylinder(12, 4, 1, 2);
    const HeightMap map = make_map(40, 40, [](int x, int y) { return (x * 7 + y * 5) % 11 / 11.0; });
    const RecordedMesh mesh = emitted(base);
    const auto measure = [&](std::size_t threads) {
        const OnThreads on(threads);
        return measure_error(base, map, heights(0.2), mesh);
    };
    const MeshError one = measure(1);
    for (const std::size_t threads : {2U, 3U}) {
        const MeshError other = measure(threads);
        for (const auto error : {&MeshError::interpolated, &MeshError::nearest_texel}) {
            const SurfaceError &a = one.*error, &b = other.*error;
            for (const auto direction : {&SurfaceError::reference_to_mesh, &SurfaceError::mesh_to_reference}) {
                CHECK((a.*direction).max == (b.*direction).max);
                CHECK((a.*direction).rms == (b.*direction).rms);
                CHECK((a.*direction).samples == (b.*direction).samples);
                CHECK((a.*direction).worst->position == (b.*direction).worst->position);
                CHECK((a.*direction).worst->triangle == (b.*direction).worst->triangle);
            }
            CHECK(a.vertices == b.vertices);
        }
    }
    MeasureLimits limits;
    double last = 0;
    limits.progress = [&](double part) {
        CHECK(part >= last);
        last = part;
    };
    const OnThreads on(1);
    measure_error(base, map, heights(0.2), mesh, limits);
    CHECK(last == 1);
}

TEST_CASE("a mesh of another base mesh is refused") {
    const BaseMesh base = make_plane(1, 1, 2, 2);
    const HeightMap map = make_map(1, 1, [](int, int) { return 0; });
    RecordedMesh mesh = emitted(base);
    mesh.triangles[1].base = 2;
    CHECK_THROWS_WITH(measure_error(base, map, heights(1), mesh), Catch::Contains("base triangle 2"));
}

// A lattice over 50 texels, 64 long; its mesh rises beyond the map only.
TEST_CASE("what lies beyond a map that clamps does not count") {
    const DisplacementOf clamped = heights(1);
    const BaseMesh base = make_lattice({50, 50}, {false, false}, 32, 50, 50);
    const HeightMap map = make_map(50, 50, [](int, int) { return 0; });
    const bool along_u = GENERATE(true, false);
    RecordedMesh mesh = emitted(make_plane(64, 64, 64, 64), [&](const BaseVertex& v) {
        const glm::dvec3 p = v.position + glm::dvec3(7.5, 7.5, 0);  // from -24.5, the first texel's centre
        return glm::dvec3(p.x, p.y, (along_u ? p.x : p.y) > 26 ? 3 : 0.5);
    });
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        mesh.textures[v] = (glm::dvec2(mesh.positions[v]) + 25.0) / 50.0;
    for (RecordedMesh::Triangle& t : mesh.triangles)
        t.base = 0;
    const MeshError error = measure_error(base, map, clamped, mesh);
    require_constant(error.interpolated.reference_to_mesh, 0.5);
    require_constant(error.interpolated.mesh_to_reference, 0.5);
    require_constant(error.nearest_texel.reference_to_mesh, 0.5);
    require_constant(error.nearest_texel.mesh_to_reference, 0.5);
    const float beyond = std::max_element(error.interpolated.triangles.begin(), error.interpolated.triangles.end(),
                                          [](const TriangleError& a, const TriangleError& b) { return a.max < b.max; })
                             ->max;
    CHECK(beyond == 3);  // pictures show it
    // Points of the reference: 8 triangles of 32 texels, a quarter of a texel apart; on the map 0.5 to 50 of each axis.
    CHECK(error.beyond_map + error.interpolated.reference_to_mesh.samples == 8u * 129 * 130 / 2);
    CHECK(error.interpolated.reference_to_mesh.samples > 199u * 199);  // 0.5, 0.75, ... 50
    CHECK(error.interpolated.reference_to_mesh.samples < 199u * 199 + 8 * 129);

    INFO("where the map repeats it is everywhere");
    DisplacementOf repeating = clamped;
    (along_u ? repeating.address_u : repeating.address_v) = Addressing::repeat;
    CHECK(measure_error(base, map, repeating, mesh).interpolated.mesh_to_reference.max == 3);
}

// A step of the map in the middle of four texels, under a flat mesh: distances are the heights.
TEST_CASE("a step's error with either sampling method") {
    const BaseMesh base = make_plane(1, 1, 4, 4);
    const HeightMap map = make_map(4, 4, [](int x, int) { return x < 2 ? 0 : 1; });
    const RecordedMesh mesh = emitted(base);
    const MeshError error = measure_error(base, map, heights(0.125), mesh);
    // 16 quarters of a texel along u, so 17 columns of samples, the outer ones with half the weight.
    CHECK(error.interpolated.reference_to_mesh.samples == 2u * 17 * 18 / 2);
    CHECK(error.reference_density == 4);
    CHECK(error.nearest_texel.reference_to_mesh.max == Approx(0.125));
    CHECK(error.nearest_texel.reference_to_mesh.rms == Approx(0.125 * std::sqrt(0.5)));
    CHECK(error.interpolated.reference_to_mesh.max == Approx(0.125));
    // 1/4, 1/2, 3/4 in columns 7, 8, 9; then 1 in six and a half
    CHECK(error.interpolated.reference_to_mesh.rms == Approx(0.125 * std::sqrt((0.0625 + 0.25 + 0.5625 + 6.5) / 16)));
    // An edge of 5.7 texels in space is cut into six, a triangle into 36; its centroid is a corner of a part.
    CHECK(error.mesh_density == 1);
    CHECK(error.interpolated.mesh_to_reference.samples == 2u * 36 + 2 + 4);
    CHECK(error.nearest_texel.mesh_to_reference.samples == 2u * 36 + 2 + 4);
    CHECK(error.texel == 1);
}

// A step down of a whole unit; the mesh leans against it and meets its foot.
TEST_CASE("a texel reaches to its edges on both sides of a step, and the step is a wall") {
    const bool along_u = GENERATE(true, false), falls = GENERATE(true, false);
    const BaseMesh base = make_plane(1, 1, 4, 4);
    const HeightMap map = make_map(4, 4, [&](int x, int y) { return ((along_u ? x : y) < 2) == falls ? 1 : 0; });
    const RecordedMesh leaning = emitted(base, [&](const BaseVertex& v) {
        const double along = (along_u ? v.position.x : v.position.y) * (falls ? 1 : -1);
        return v.position + glm::dvec3(0, 0, -along / 4);
    });
    const SurfaceError error = measured(base, map, heights(1), leaning, Sampling::nearest_texel);
    CHECK(error.reference_to_mesh.max == Approx(1 / std::hypot(1, 0.25)));
    CHECK(error.reference_to_mesh.worst->position.z == Approx(1));
    // Half way up the wall, at no distance from it.
    RecordedMesh point = leaning;
    point.positions.assign(point.positions.size(), {0, 0, 0.5});
    require_constant(measured(base, map, heights(1), point, Sampling::nearest_texel).mesh_to_reference, 0);
}

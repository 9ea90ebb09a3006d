#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "testbench/check/conformance/end_to_end.h"
#include "testbench/common/parallel.h"
#include "testbench/geometry/surface_distance.h"
#include "testbench/input/map/built_in_maps.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/tests/check/conformance/scoreboard_cases.h"
#include "testbench/tests/check/conformance/setup_run.h"
#include "testbench/tests/support/edited_mesh.h"

using namespace tessera;
using namespace tessera::testing;

namespace {

std::array<glm::dvec3, 3> random_triangle(Random& random, double size) {
    const glm::dvec3 at(real(random, -10, 10), real(random, -10, 10), real(random, -10, 10));
    return {at, at + size * unit_vector(random), at + size * unit_vector(random)};
}

EmittedMesh hardware_mesh(Case& c) {
    EmittedMesh mesh;
    WorkList work(c.machine, c.setup.base_triangles);
    work.run(1000000, [&](const datapath::Triangle& t) { mesh.triangles.push_back(EmittedTriangle::from(t, false)); });
    return mesh;
}

Case donut(const Job& job, int texels) {
    const BaseMesh mesh = make_plane(3, 3, 2, 2);
    const HeightMap map = half_donut_map(texels, texels);
    return Case(make_setup(resolve_job(job, mesh, map).job, mesh, map), Manner::tame);
}

}  // namespace

TEST_CASE("the closest point of a triangle is correct in each region") {
    const std::array<glm::dvec3, 3> t = {glm::dvec3(0, 0, 0), glm::dvec3(4, 0, 0), glm::dvec3(0, 4, 0)};
    const auto same = [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-12; };
    CHECK(same(closest_point(t, {1, 1, 3}), {1, 1, 0}));
    CHECK(same(closest_point(t, {-1, -2, 3}), {0, 0, 0}));
    CHECK(same(closest_point(t, {9, -1, 3}), {4, 0, 0}));
    CHECK(same(closest_point(t, {-1, 9, 3}), {0, 4, 0}));
    CHECK(same(closest_point(t, {2, -5, 3}), {2, 0, 0}));
    CHECK(same(closest_point(t, {-5, 3, 3}), {0, 3, 0}));
    CHECK(same(closest_point(t, {4, 4, 1}), {2, 2, 0}));
    // Collapsed to a segment, in each way, and to a point.
    const glm::dvec3 a(0, 0, 0), b(2, 0, 0);
    for (const auto& segment : {std::array<glm::dvec3, 3>{a, b, b}, {a, a, b}, {a, b, a}, {a, glm::dvec3(1, 0, 0), b}})
        CHECK(same(closest_point(segment, {1.5, 1, 0}), {1.5, 0, 0}));
    CHECK(same(closest_point({b, b, b}, {5, 5, 5}), b));
}

TEST_CASE("the closest point of a needle triangle equals that found by a search along it") {
    Random random(23);
    // The distance to the segment across at t is convex in t, so ternary search finds the minimum.
    const auto search = [](const std::array<glm::dvec3, 3>& t, const glm::dvec3& p) {
        const auto distance = [&](double at) {
            const glm::dvec3 from = glm::mix(t[0], t[1], at), side = glm::mix(t[0], t[2], at) - from;
            const double squared = glm::dot(side, side);
            const double part = squared > 0 ? std::clamp(glm::dot(p - from, side) / squared, 0.0, 1.0) : 0.0;
            return glm::length(from + part * side - p);
        };
        double low = 0, high = 1;
        for (int k = 0; k < 150; ++k) {
            const double third = (high - low) / 3;
            if (distance(low + third) < distance(high - third))
                high -= third;
            else
                low += third;
        }
        return distance((low + high) / 2);
    };
    for (int exponent = 0; exponent <= 14; ++exponent) {
        double worst = 0;
        for (int k = 0; k < 2000; ++k) {
            const glm::dvec3 at(real(random, -1, 1), real(random, -1, 1), real(random, -1, 1));
            const glm::dvec3 along = unit_vector(random);
            const glm::dvec3 across = unit_vector(random);
            const double width = std::pow(10.0, -exponent);
            std::array<glm::dvec3, 3> t = {at, at + along, at + real(random, -0.1, 1.1) * along + width * across};
            const glm::dvec3 p = at + real(random, -0.5, 1.5) * along +
                                 real(random, -1, 1) * (k % 2 == 0 ? width : 1.0) * across +
                                 std::pow(10.0, -real(random, 0, 12)) * unit_vector(random);
            const double searched = search(t, p);
            std::rotate(t.begin(), t.begin() + k % 3, t.end());
            worst = std::max(worst, std::abs(glm::length(closest_point(t, p) - p) - searched));
        }
        CAPTURE(exponent, worst);
        CHECK(worst < 2e-8);
    }
}

TEST_CASE("distances through the tree of boxes equal those of a search through all triangles") {
    Random random(21);
    // A large offset costs single precision; the distances must not change.
    for (const double offset : {0.0, 1e4, 1e6}) {
        std::vector<TriangleSoup::Corners> from, to;
        for (int k = 0; k < 200; ++k) {
            from.push_back(random_triangle(random, 0.5));
            to.push_back(random_triangle(random, k % 10 == 0 ? 0.0 : 1.0));
        }
        for (auto* soup : {&from, &to})
            for (auto& t : *soup)
                for (glm::dvec3& p : t)
                    p += offset;
        double largest = 0, squares = 0;
        const auto search = [&](const glm::dvec3& p) {
            double nearest = 1e300;
            for (const auto& t : to)
                nearest = std::min(nearest, glm::length(closest_point(t, p) - p));
            largest = std::max(largest, nearest);
            squares += nearest * nearest;
        };
        for (const auto& t : from) {
            for (const glm::dvec3& p : t)
                search(p);
            search((t[0] + t[1] + t[2]) / 3.0);
        }
        const SurfaceDistance found = distance_between(from, to);
        CHECK(found.points == 800);
        CHECK(found.max == Approx(largest).epsilon(1e-12));
        CHECK(found.rms == Approx(std::sqrt(squares / 800)).epsilon(1e-12));
        CHECK(distance_between(from, from).max == Approx(0).margin(1e-9));
    }
    CHECK(distance_between({}, {}).points == 0);
    CHECK(std::isinf(distance_between(std::vector{random_triangle(random, 1)}, {}).max));
}

TEST_CASE("adjacent triangles share stored vertices, in order of first use") {
    const glm::dvec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0);
    const std::vector<TriangleSoup::Corners> triangles{{c, a, b}, {c, b, d}};
    const TriangleSoup soup(triangles);
    REQUIRE(soup.size() == 2);
    CHECK(soup[0] == triangles[0]);
    CHECK(soup[1] == triangles[1]);
    CHECK(soup.vertices() == std::vector<glm::dvec3>{c, a, b, d});
    CHECK(distance_between(soup, soup).points == 6);
}

TEST_CASE("the tree of boxes visits each box within the radius once, and no empty box") {
    Random random(24);
    for (const std::size_t count : {0U, 1U, 4U, 5U, 16U, 17U, 1000U})
        for (const double size : {1.0, 1e-6, 0.0})
            for (const double offset : {0.0, 1e5}) {
                std::vector<BoxHierarchy::Box> boxes(count);
                for (std::size_t k = 0; k < count; ++k)
                    if (k % 7 != 3)
                        for (int corner = 0; corner < 2; ++corner)
                            boxes[k].add(size * random_triangle(random, 1)[0] + offset);
                const auto all = BoxHierarchy::Box::about(boxes);
                const BoxHierarchy hierarchy(count, all, [&](std::size_t k) { return boxes[k]; });
                for (int n = 0; n < 20; ++n) {
                    const glm::dvec3 p = size * random_triangle(random, 1)[0] + offset;
                    const double radius = size * real(random, 0, 10);
                    std::vector<int> visits(count, 0);
                    hierarchy.visit_near(p, radius, [&](std::size_t k) {
                        ++visits[k];
                        return radius;
                    });
                    double nearest = INFINITY, found = INFINITY;
                    for (std::size_t k = 0; k < count; ++k) {
                        const double squared = boxes[k].squared_distance(p);
                        nearest = std::min(nearest, squared);
                        if (squared <= radius * radius)
                            REQUIRE(visits[k] == 1);
                        REQUIRE(visits[k] <= (boxes[k].is_empty() ? 0 : 1));
                    }
                    hierarchy.visit_near(p, INFINITY, [&](std::size_t k) {
                        found = std::min(found, boxes[k].squared_distance(p));
                        return std::sqrt(found);
                    });
                    REQUIRE(found == nearest);
                }
            }
}

TEST_CASE("distances to long thin triangles and to triangles without area equal those of a search through all") {
    Random random(22);
    const auto needle = [&](double width) {
        const glm::dvec3 at(real(random, -1, 1), real(random, -1, 1), real(random, -1, 1));
        const glm::dvec3 along = unit_vector(random);
        return std::array<glm::dvec3, 3>{at, at + along, at + 0.6 * along + width * unit_vector(random)};
    };
    for (const double width : {1e-3, 0.0}) {
        std::vector<TriangleSoup::Corners> from, to;
        for (int k = 0; k < 300; ++k) {
            from.push_back(random_triangle(random, 0.1));
            to.push_back(needle(width));
        }
        double largest = 0;
        for (const auto& t : from)
            for (const glm::dvec3& p : {t[0], t[1], t[2], (t[0] + t[1] + t[2]) / 3.0}) {
                double nearest = 1e300;
                for (const auto& other : to)
                    nearest = std::min(nearest, glm::length(closest_point(other, p) - p));
                largest = std::max(largest, nearest);
            }
        CHECK(distance_between(from, to).max == Approx(largest).epsilon(1e-12));
        const TriangleSoup soup(to);
        const NearestTriangle search(soup);
        std::vector<NearestTriangle::Found> within;
        for (const std::size_t most : {300U, 100'000U}) {
            REQUIRE(search.within({0, 0, 0}, 10, most, within));
            CHECK(within.size() == 300);  // each triangle once, whether searched in one or several parts
        }
        CHECK_FALSE(search.within({0, 0, 0}, 10, 299, within));
    }
}

TEST_CASE("a sample of the points reports its size and bounds the part not measured") {
    // Two points miss a fraction q with probability (1 - q)^2, which is 1/4 for q = 1/2.
    CHECK(SurfaceDistance{10, 2, 0, 0}.unseen(0.75) == Approx(0.5));
    CHECK(SurfaceDistance{10'000'000, 6904, 0, 0}.unseen(0.999) == Approx(0.0010000).epsilon(1e-4));
    CHECK(SurfaceDistance{10, 10, 0, 0}.unseen(0.999) == 0);

    Random random(23);
    std::vector<TriangleSoup::Corners> from, to;
    for (int k = 0; k < 3000; ++k) {
        from.push_back(random_triangle(random, 0.5));
        to.push_back(random_triangle(random, 0.5));
    }
    const SurfaceDistance all = distance_between(from, to);
    CHECK(all.points == 12000);
    CHECK(all.measured == 12000);
    const SurfaceDistance some = distance_between(from, to, 120'000);
    CHECK(some.points == 12000);
    CHECK(some.measured == 2048);  // of some 3,000 that a budget of 120,000 looks allows
    CHECK(some.max <= all.max);
    CHECK(some.rms == Approx(all.rms).epsilon(0.1));
    CHECK(some.unseen(0.999) == Approx(0.00337).epsilon(0.01));
    for (const std::size_t threads : {1U, 2U, 3U}) {
        const OnThreads on(threads);
        for (const std::uint64_t most : {most_looks, std::uint64_t{120'000}}) {
            const SurfaceDistance again = distance_between(from, to, most), first = most == most_looks ? all : some;
            CHECK(again.max == first.max);
            CHECK(again.rms == first.rms);
        }
    }
}

TEST_CASE("a surface shifted by a known distance is measured at that distance") {
    Case c = donut(Job{}, 64);
    const EmittedMesh mesh = hardware_mesh(c);
    std::vector<TriangleSoup::Corners> one, other;
    const Dequantise dequantise(c.setup.registers.formats);
    for (const EmittedTriangle& t : mesh.triangles) {
        one.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            one.back()[k] = dequantise.position(t.corners[k].displaced);
            one.back()[k].z = 0;
        }
        other.push_back(one.back());
        for (glm::dvec3& p : other.back())
            p.z = std::ldexp(5.0, -16);  // far below single precision's resolution at this size
    }
    const SurfaceDistance d = distance_between(one, other);
    CHECK(std::ldexp(d.max, 16) == Approx(5));
    CHECK(std::ldexp(d.rms, 16) == Approx(5));
    CHECK(d.farther == d.points);
    CHECK(distance_between(one, other, most_looks, std::ldexp(5.01, -16)).farther == 0);
    other.resize(other.size() / 2);
    const SurfaceDistance half = distance_between(one, other, most_looks, std::ldexp(5.01, -16));
    CHECK(half.farther_percent() > 40);
    CHECK(half.farther_percent() < 50);  // vertices along the border are near the other half
}

TEST_CASE("hardware and golden model produce nearly the same surface") {
    Job job;
    job.tests.normal_threshold = 0.2;
    // 96 texels in three columns: base texture coordinates are whole, so midpoints are exact in both models for twelve
    // generations. Apart from flips of NT, the two meshes differ only in the rounding of positions.
    Case c = donut(job, 96);
    const EmittedMesh mesh = hardware_mesh(c);
    const EndToEndResult result = compare_end_to_end(c.setup, c.inputs, mesh);
    CHECK(result.hardware_triangles == mesh.triangles.size());
    CHECK(result.hardware_triangles > 500);
    CHECK_FALSE(result.bound_hit);
    CHECK(std::abs(static_cast<double>(result.golden_triangles) / static_cast<double>(result.hardware_triangles) - 1) <
          0.01);
    CHECK(result.golden_largest_generation <= 12);
    for (const auto& d : {result.hardware_to_golden, result.golden_to_hardware}) {
        CHECK(d.points > result.hardware_triangles);
        CHECK(d.rms_model < 1e-3);
        CHECK(d.max_model == Approx(d.max_world / c.setup.model_scale.scale));
        CHECK(d.max_position_lsb == Approx(std::ldexp(d.max_world, 16)));
    }
    const EndToEndResult again = compare_end_to_end(c.setup, c.inputs, mesh);
    CHECK(again.hardware_to_golden.rms_world == result.hardware_to_golden.rms_world);
    CHECK(again.golden_to_hardware.rms_world == result.golden_to_hardware.rms_world);
}

TEST_CASE("a displacement wrong by one part in a thousand is visible in the distance") {
    Job job;
    Case c = donut(job, 96);
    const EmittedMesh right = hardware_mesh(c);
    Case wrong = c;
    wrong.machine.registers.displacement.scale += wrong.machine.registers.displacement.scale / 1000;
    const auto off = compare_end_to_end(c.setup, c.inputs, hardware_mesh(wrong));
    const auto fine = compare_end_to_end(c.setup, c.inputs, right);
    CHECK(off.hardware_to_golden.rms_world > 4 * fine.hardware_to_golden.rms_world);
}

TEST_CASE("a golden run that grows far beyond the hardware's is abandoned") {
    Case c = donut(Job{}, 96);
    const EndToEndResult result = compare_end_to_end(c.setup, c.inputs, first_of(hardware_mesh(c), 10));
    CHECK(result.bound == 1040);
    CHECK(result.bound_hit);
    CHECK(result.hardware_to_golden.points == 0);
}

TEST_CASE("the golden run passes within the allowed differences in either direction") {
    EndToEndResult result;
    result.hardware_triangles = 1000;
    result.golden_triangles = 1000;
    result.allowed = {1, 0.5, 0};
    CHECK_FALSE(result.passed());  // nothing was measured
    result.hardware_to_golden.measured = result.golden_to_hardware.measured = 1;
    CHECK(result.passed());
    for (const std::uint64_t golden : {990U, 1010U}) {
        result.golden_triangles = golden;
        CHECK(std::abs(result.more_triangles()) == Approx(1));
        result.allowed.triangles = 1.001;
        CHECK(result.passed());
        result.allowed.triangles = 0.999;
        CHECK_FALSE(result.passed());
    }
    result.golden_triangles = 1000;
    result.allowed.triangles = 1;
    for (EndToEndResult::Distance EndToEndResult::*const way :
         {&EndToEndResult::hardware_to_golden, &EndToEndResult::golden_to_hardware}) {
        (result.*way).rms_model = 0.5;
        CHECK(result.passed());
        (result.*way).rms_model = 0.51;
        CHECK_FALSE(result.passed());
        // One percent of the points may lie 3 away, which adds 0.3 to the allowed RMS.
        result.allowed.triangles = 1;
        result.allowed.displacement = 3;
        (result.*way).farther = 1;
        (result.*way).rms_model = 0.79;
        CHECK(result.allowed_rms_model() == Approx(0.8));
        CHECK(result.passed());
        (result.*way).rms_model = 0.81;
        CHECK_FALSE(result.passed());
        (result.*way).rms_model = 0;
        (result.*way).farther = 3;
        CHECK(result.passed());
        (result.*way).farther = 3.01;
        CHECK_FALSE(result.passed());
        (result.*way).farther = 0;
    }
    result.bound_hit = true;
    CHECK_FALSE(result.passed());
}

TEST_CASE("on a cylinder the allowed distance includes the rounding and turning of normals") {
    Job job;
    job.mesh.source = MeshSource::cylinder;
    job.mesh.columns = 8;
    job.tests.generation_limit = 4;
    job.displacement.scale = 0.5;
    job.displacement.bias = -0.2;
    SetupRun run{job};
    const SetupResult checked = run.check();
    const EndToEndResult result =
        GoldenRun(run.golden, checked.base_triangles).compare(run.setup, run.simulation.monitor.mesh, 1);
    CHECK(result.passed());
    REQUIRE(result.golden_largest_generation == 4);
    CHECK(result.allowed.rounding == Approx(std::sqrt(3.0) * (4 * std::ldexp(1.0, -16) / run.setup.model_scale.scale +
                                                              10 * std::ldexp(1.0, -14) * 0.3)));
    // Neighbouring normals are 45 degrees apart: 2 sin 22.5.
    CHECK(result.allowed.displacement == Approx(0.5 + 0.3 * 0.765366865));
}

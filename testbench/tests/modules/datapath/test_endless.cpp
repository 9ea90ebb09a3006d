#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "testbench/prove/random_edges/datapath_edge.h"
#include "testbench/tests/modules/datapath/datapath_donut.h"

/// golden/ALGORITHM.md 4.5: as printed, without the generation test, the recursion does not always end.
using namespace tessera::datapath;
using namespace tessera::testing;

namespace {

constexpr double normal_threshold = 0.2;
constexpr double summed_height_threshold = 5000;

/// The long edge, from the first vertex to the second, never splits. Nor does its median's, from (80.667, 35.667) to
/// (82.667, 34.667), along which ever thinner triangles split their two other edges in turn, until rounding turns them
/// over and the cycle repeats.
Triangle endless_triangle() {
    return triangle_of(plane_vertex(78.667, 36.0), plane_vertex(82.667, 34.667), plane_vertex(82.667, 35.333));
}

bool same_bits(const std::deque<Triangle>& a, const std::deque<Triangle>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Triangle& p, const Triangle& q) {
        return std::equal(p.vertices.begin(), p.vertices.end(), q.vertices.begin(),
                          [](const Vertex& i, const Vertex& j) { return tessera::testing::same_bits(i, j); });
    });
}

std::int64_t doubled_area(const Triangle& t) {
    const auto& v = t.vertices;
    const auto difference = [](std::uint32_t a, std::uint32_t b) { return std::int64_t{a} - std::int64_t{b}; };
    return difference(v[1].texture.u, v[0].texture.u) * difference(v[2].texture.v, v[0].texture.v) -
           difference(v[1].texture.v, v[0].texture.v) * difference(v[2].texture.u, v[0].texture.u);
}

}  // namespace

TEST_CASE("endless case: the Generation Test ends the splits along the triangle's long edge") {
    EdgeMachine machine = half_donut_machine(normal_threshold, summed_height_threshold);
    const Triangle triangle = endless_triangle();
    WorkList work(machine, {triangle});
    CHECK((machine.evaluate(work.waiting.front()).split & 1) == 0);
    std::int64_t area = 0;
    work.run(1000, [&](const Triangle& t) { area += doubled_area(t); });
    CHECK(work.waiting.empty());
    CHECK(work.finished == 23);
    CHECK(work.largest_generation == 12);
    CHECK(area == doubled_area(triangle));
}

TEST_CASE("endless case: without the Generation Test it never ends, since the machine's state repeats") {
    EdgeMachine machine = half_donut_machine(normal_threshold, summed_height_threshold);
    machine.registers.tests.generation_test = false;
    machine.registers.formats.generation_bits = 8;
    WorkList work(machine, {endless_triangle()});
    work.run(1000);
    const std::deque<Triangle> state = work.waiting;
    const std::uint64_t finished = work.finished;
    constexpr int period = 8;
    for (int k = 0; k < period; ++k)
        work.step([](const Triangle&) {});
    // Triangles are processed in sequence, and the future depends on the waiting triangles only: once a state recurs,
    // it recurs for ever.
    CHECK(same_bits(work.waiting, state));
    CHECK(work.finished > finished);

    work.run(200'000);
    CHECK(work.finished == 200'000);
    CHECK(!work.waiting.empty());
    CHECK(work.largest_generation == 255);  // saturated; the triangles in the queue have been split far more often

    // four bits, the default: the same triangles with saturated generations
    machine.registers.formats.generation_bits = 4;
    machine.saturations = {};
    WorkList narrow(machine, {endless_triangle()});
    narrow.run(200'000);
    CHECK(narrow.finished == work.finished);
    CHECK(narrow.waiting.size() == work.waiting.size());
    CHECK(narrow.largest_generation == 15);
    CHECK(machine.saturations.generation > 100'000);
}

TEST_CASE("endless case: the plane of 18 triangles, with the Generation Test and without") {
    EdgeMachine machine = half_donut_machine(normal_threshold, summed_height_threshold);
    const std::vector<Triangle> base = plane_of_18();
    std::int64_t base_area = 0;
    for (const Triangle& t : base)
        base_area += doubled_area(t);
    CHECK(base_area == 2 * (std::int64_t{256} << 12) * (std::int64_t{256} << 12));

    WorkList work(machine, base);
    std::int64_t area = 0;
    std::uint64_t not_positive = 0;
    work.run(100'000, [&](const Triangle& t) {
        area += doubled_area(t);
        not_positive += doubled_area(t) <= 0 ? 1u : 0u;
    });
    CHECK(work.waiting.empty());
    CHECK(work.finished == 13'144);
    CHECK(work.largest_generation == 12);
    CHECK(area == base_area);
    CHECK(not_positive == 0);

    machine.registers.tests.generation_test = false;
    machine.registers.formats.generation_bits = 8;
    WorkList endless(machine, base);
    endless.run(200'000);
    CHECK(endless.finished == 200'000);
    CHECK(!endless.waiting.empty());
    CHECK(endless.largest_generation > 50);  // breadth first: no branch is deep yet
}

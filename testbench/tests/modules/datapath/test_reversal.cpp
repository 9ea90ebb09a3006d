#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <utility>
#include <vector>

#include "testbench/common/random.h"
#include "testbench/prove/random_edges/datapath_edge.h"
#include "testbench/prove/random_edges/direct_edge.h"
#include "testbench/prove/random_edges/edge_trial.h"

/// Edges from either end: all edges of formats narrow enough to enumerate (modules/datapath/CRACK_FREEDOM.md). The
/// results are compared with the definitions, too, since a test that always says no is symmetric as well.
using namespace tessera;
using namespace tessera::datapath;

namespace {

constexpr std::array<AddressMode, 2> clamp_and_repeat{AddressMode::clamp, AddressMode::repeat};

Registers narrow_registers(AddressMode u, AddressMode v) {
    Registers registers;
    Formats& formats = registers.formats;
    formats.position = Format::make_signed(5, 1);
    formats.view_distance = Format::make_signed(5, 1);
    formats.normal = Format::make_signed(6, 4);
    formats.texture = Format::make_unsigned(2 + 1 + 1, 1);
    formats.displacement = Format::make_unsigned(2, 2);
    formats.summed_height = Format::make_unsigned(8, 0);
    formats.screen = Format::make_signed(8, 1);
    registers.map = {3, 2, u, v};
    registers.displacement = {9, -3};
    registers.transform.row_x = {15000000, 3000000, -4000000, std::int64_t{3} << 24};
    registers.transform.row_y = {-2000000, 15000000, 5000000, -(std::int64_t{2} << 24)};
    registers.transform.row_w = {3000000, -4000000, -12000000, std::int64_t{5} << 24};
    registers.transform.exponent = 4;
    registers.transform.near_plane = std::int64_t{1} << 24;
    return registers;
}

/// A noise map that contains both extremes, and normals in all octants of the upper half.
struct NarrowMap {
    std::vector<std::uint32_t> codes;
    std::vector<Direction> normals;

    NarrowMap(Random& random, const Registers& registers) {
        Saturations unused;
        for (std::uint32_t k = 0; k < registers.map.width * registers.map.height; ++k) {
            codes.push_back(k == 0 ? 0 : k == 1 ? 3 : random.natural(0, 3));
            normals.push_back(
                normalise(Direction{random.integer32(-9, 9), random.integer32(-9, 9), 8}, registers.formats, unused));
        }
    }
};

/// Vertices with a few positions, every texture coordinate of the map and, if it repeats, of a second period, a few
/// frames, and both handednesses.
std::vector<Vertex> all_vertices(EdgeMachine& machine) {
    const MapGeometry& map = machine.registers.map;
    const std::array<Direction, 4> normals{{{0, 0, 16}, {-16, 0, 0}, {9, 9, -9}, {0, 0, -16}}};
    const std::array<Direction, 2> tangents{{{16, 0, 0}, {0, -11, 11}}};
    std::vector<Vertex> vertices;
    const auto last = [](std::uint32_t size, AddressMode mode) {
        return mode == AddressMode::repeat && size <= 2 ? 4 * size : 2 * size;
    };
    for (std::uint32_t u = 0; u <= last(map.width, map.address_u); ++u)
        for (std::uint32_t v = 0; v <= last(map.height, map.address_v); ++v)
            for (const Position& p : {Position{-7, 3, 0}, Position{6, -1, 5}})
                for (const Direction& n : normals)
                    for (const Direction& t : tangents)
                        for (const std::int8_t handedness : {std::int8_t{1}, std::int8_t{-1}}) {
                            Vertex vertex;
                            vertex.texture = {u, v};
                            vertex.position = p;
                            vertex.normal = n;
                            vertex.tangent = t;
                            vertex.handedness = handedness;
                            vertex.generation = static_cast<std::uint8_t>(vertices.size() % 4);
                            machine.complete(vertex);
                            vertices.push_back(vertex);
                        }
    return vertices;
}

}  // namespace

TEST_CASE("reversal: every edge of narrow vertices, six tests, decision, inserted vertex, every address mode") {
    std::array<std::uint64_t, 6> yes{};
    std::uint64_t edges = 0, splits = 0;
    for (const AddressMode u : clamp_and_repeat) {
        for (const AddressMode v : clamp_and_repeat) {
            Random random(61);
            Registers registers = narrow_registers(u, v);
            const NarrowMap map(random, registers);
            Tables tables = make_tables(registers, map.codes, map.normals);
            TestParameters& tests = registers.tests;
            tests.normal_threshold = 12;
            tests.height_thresholds[0] = 2;
            tests.view_threshold = 40;
            tests.generation_limit = 3;
            tests.highlight_test = true;
            tests.half_vector = {4, 0, 15};
            tests.highlight_cosine = 150;
            tests.highlight_normal_threshold = 6;
            EdgeMachine machine(registers, std::move(tables));
            const DirectMap direct_map(registers.map, map.codes, map.normals);
            const DirectEdge direct(machine.registers, direct_map);
            const std::vector<Vertex> vertices = all_vertices(machine);
            for (std::size_t a = 0; a < vertices.size(); ++a) {
                for (std::size_t b = a; b < vertices.size(); ++b) {
                    const Vertex &i = vertices[a], &j = vertices[b];
                    TrianglePass pass;
                    pass.triangle.vertices = {i, j, i};
                    machine.evaluate_edge(pass, 0);
                    machine.evaluate_edge(pass, 1);
                    const Vertex inserted = inserted_vertex(pass, 0);
                    const std::uint8_t decided = pass.edges[0].tests;
                    if (decided != pass.edges[1].tests || (pass.split & 1) != (pass.split >> 1 & 1) ||
                        !same_bits(inserted, inserted_vertex(pass, 1)))
                        FAIL("vertices " << a << " and " << b << ": unlike from the other end");
                    const char* const fault = direct.fault_of_vertex(i, j, inserted);
                    if (fault != nullptr || decided != direct.tests(i, j, inserted, direct.measure(i, j, inserted)))
                        FAIL("vertices " << a << " and " << b << ": not as defined, "
                                         << (fault != nullptr ? fault : "tests"));
                    ++edges;
                    splits += pass.split & 1;
                    for (std::size_t bit = 0; bit < yes.size(); ++bit)
                        yes[bit] += decided >> bit & 1;
                }
            }
        }
    }
    CHECK(edges > 2'000'000);
    for (const std::uint64_t times : yes) {
        CHECK(times > edges / 50);
        CHECK(times < edges - edges / 50);
    }
    CHECK(splits > edges / 100);
}

TEST_CASE("reversal: Summed Height Test, every edge on maps of 1 to 4 texels a side, both units, every threshold") {
    Random random(62);
    std::uint64_t yes = 0, edges = 0;
    for (std::uint32_t shape = 0; shape < 64; ++shape) {
        const std::uint32_t width = 1 + (shape & 3), height = 1 + (shape >> 2 & 3);
        Registers registers;
        Formats& formats = registers.formats;
        formats.texture = Format::make_unsigned(3 + 1 + 1, 1);
        formats.displacement = Format::make_unsigned(2, 2);
        formats.summed_height = Format::make_unsigned(6, 0);  // 16 texels of 2 bits: the table itself wraps
        registers.map = {width, height, clamp_and_repeat[shape >> 4 & 1], clamp_and_repeat[shape >> 5]};
        std::vector<std::uint32_t> codes;
        for (std::uint32_t k = 0; k < width * height; ++k)
            codes.push_back(random.coin() ? 3 * random.natural(0, 1) : random.natural(0, 3));
        const std::vector<Direction> normals(codes.size(), Direction{0, 0, 16384});
        Tables tables = make_tables(registers, codes, normals);
        EdgeMachine machine(registers, std::move(tables));
        const DirectMap direct_map(registers.map, codes, normals);
        const DirectEdge direct(machine.registers, direct_map);
        const auto last = [](std::uint32_t size, AddressMode mode) {
            return mode == AddressMode::repeat ? 4 * size : 2 * size;  // two periods
        };
        const std::uint32_t columns = last(width, registers.map.address_u) + 1;
        const std::uint32_t points = columns * (last(height, registers.map.address_v) + 1);
        TestParameters& tests = machine.registers.tests;
        for (std::uint32_t a = 0; a < points; ++a) {
            for (std::uint32_t b = a; b < points; ++b) {
                Vertex i, j, middle;
                i.texture = {a % columns, a / columns};
                j.texture = {b % columns, b / columns};
                middle.texture = midpoint(i.texture, j.texture);
                const EdgeMeasures measures = direct.measure(i, j, middle);
                for (const SummedHeightUnit unit : {SummedHeightUnit::sum, SummedHeightUnit::area}) {
                    tests.summed_height_unit = unit;
                    const std::uint64_t area = unit == SummedHeightUnit::area ? measures.rectangle_area : 1;
                    // these represent all thresholds: below the measure the test says yes, from it on no
                    const std::uint64_t most = measures.summed_height / area;
                    for (const std::uint64_t threshold :
                         {std::uint64_t{0}, most > 0 ? most - 1 : most, most, most + 1}) {
                        tests.height_thresholds[0] = static_cast<std::int64_t>(threshold);
                        const bool asks = machine.summed_height(i.texture, j.texture);
                        if (asks != machine.summed_height(j.texture, i.texture) ||
                            asks != (measures.summed_height > threshold * area))
                            FAIL(width << " x " << height << " map, " << i.texture.u << ", " << i.texture.v << " to "
                                       << j.texture.u << ", " << j.texture.v << ", threshold " << threshold);
                        yes += asks ? 1 : 0;
                        ++edges;
                    }
                }
            }
        }
    }
    CHECK(edges > 2'000'000);
    CHECK(yes > edges / 20);
}

TEST_CASE("random edges: the same seed gives the same results, and every kind of threshold is met exactly") {
    const EdgeTrial trial = try_random_edges(7, 40'000), again = try_random_edges(7, 40'000);
    INFO(trial.first_fault);
    CHECK(trial.faults() == 0);
    CHECK(trial.edges == 40'000);
    CHECK(trial.machines == 8);
    CHECK(trial.splits == again.splits);
    CHECK(trial.yes == again.yes);
    CHECK(trial.at_limit == again.at_limit);
    for (const std::uint64_t times : trial.at_limit)
        CHECK(times > trial.edges / 8);
    CHECK(trial.moved > trial.edges / 50);
    CHECK(trial.behind > trial.edges / 50);
}

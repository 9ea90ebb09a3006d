#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "testbench/prove/random_edges/datapath_edge.h"
#include "testbench/prove/random_edges/datapath_random.h"

/// Crack freedom: an edge is decided from its two ends, identically from either side.
using namespace tessera::datapath;
using namespace tessera::testing;

namespace {

constexpr std::array<AddressMode, 2> both_modes{AddressMode::clamp, AddressMode::repeat};

Direction unit(Random& random, const Formats& formats) {
    Saturations unused;
    const Direction any{random.integer32(-999, 999), random.integer32(-999, 999), random.integer32(1, 999)};
    const int sign = random.coin() ? 1 : -1;
    return normalise(any.x, any.y, sign * any.z, formats, unused);
}

Machine random_machine(std::uint32_t width, std::uint32_t height, AddressMode u, AddressMode v, Random& random) {
    Registers registers;
    registers.map = {width, height, u, v};
    std::vector<std::uint32_t> codes;
    std::vector<Direction> normals;
    for (std::uint32_t k = 0; k < width * height; ++k) {
        codes.push_back(random.natural(0, 65535));
        normals.push_back(unit(random, registers.formats));
    }
    Tables tables = make_tables(registers, codes, normals);
    registers.tests.normal_threshold = 12000;
    registers.tests.height_thresholds[0] = 120000;
    registers.tests.view_threshold = 40 << 8;
    registers.tests.generation_limit = 9;
    registers.displacement = {1 << 15, -9000};
    registers.transform.row_x = {14000000, 300000, -2000000, std::int64_t{1} << 41};
    registers.transform.row_y = {-500000, 15000000, 1000000, -(std::int64_t{1} << 40)};
    registers.transform.row_w = {1000000, -2000000, -16000000, std::int64_t{1} << 41};
    registers.transform.exponent = 8;
    registers.transform.near_plane = std::int64_t{1} << 36;
    return Machine(registers, std::move(tables));
}

/// A base vertex anywhere on the map, including its borders and (for a repeated map) other periods, or close to `near`:
/// on short edges rounding matters most.
Vertex any_vertex(Random& random, Machine& machine, const Vertex* near) {
    const MapGeometry& map = machine.registers.map;
    const auto coordinate = [&](std::uint32_t size, AddressMode mode, std::uint32_t other) {
        const std::uint32_t border = (mode == AddressMode::repeat ? 3 * size : size) << 12;
        const auto choice = random.integer(0, 15);
        if (choice == 0)
            return border;
        if (choice == 1)
            return std::uint32_t{0};
        if (near == nullptr || choice == 2)
            return random.natural(0, border);
        return static_cast<std::uint32_t>(
            std::clamp<std::int64_t>(std::int64_t{other} + random.any_size(6 << 12), 0, border));
    };
    Vertex v;
    v.texture = {coordinate(map.width, map.address_u, near != nullptr ? near->texture.u : 0),
                 coordinate(map.height, map.address_v, near != nullptr ? near->texture.v : 0)};
    const auto position = [&] { return random.integer32(-200000, 200000); };
    v.position = {position(), position(), position()};
    v.normal = unit(random, machine.registers.formats);
    v.tangent = unit(random, machine.registers.formats);
    v.handedness = random.coin() ? std::int8_t{1} : std::int8_t{-1};
    v.generation = static_cast<std::uint8_t>(random.integer(0, 10));
    machine.complete(v);
    return v;
}

/// A pass with edge 0 = (i, j) and edge 1 = (j, i).
TrianglePass both_ways(Machine& machine, const Vertex& i, const Vertex& j) {
    TrianglePass pass;
    pass.triangle.vertices = {i, j, i};
    machine.evaluate_edge(pass, 0);
    machine.evaluate_edge(pass, 1);
    return pass;
}

bool symmetric(const TrianglePass& pass) {
    return pass.edges[0].tests == pass.edges[1].tests && (pass.split & 1) == (pass.split >> 1 & 1) &&
           same_bits(inserted_vertex(pass, 0), inserted_vertex(pass, 1));
}

}  // namespace

TEST_CASE("symmetry: five tests, decision and inserted vertex, a million random edges per address mode") {
    constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 4> sizes{{{64, 48}, {1, 6}, {7, 1}, {19, 12}}};
    for (const AddressMode u : both_modes) {
        for (const AddressMode v : both_modes) {
            Random random(27u + (u == AddressMode::repeat ? 1u : 0u) + (v == AddressMode::repeat ? 2u : 0u));
            std::array<int, 5> seen{};
            int splits = 0, edges = 0;
            for (const auto& [width, height] : sizes) {
                Machine machine = random_machine(width, height, u, v, random);
                Vertex i = any_vertex(random, machine, nullptr);
                for (int k = 0; k < 250'000; ++k) {
                    const Vertex j = any_vertex(random, machine, &i);
                    const TrianglePass pass = both_ways(machine, i, j);
                    if (!symmetric(pass))
                        FAIL(width << " x " << height << " map, edge " << i.texture.u << ", " << i.texture.v << " to "
                                   << j.texture.u << ", " << j.texture.v << ": tests " << int{pass.edges[0].tests}
                                   << " one way, " << int{pass.edges[1].tests} << " the other");
                    ++edges;
                    splits += pass.split & 1;
                    for (std::size_t bit = 0; bit < 5; ++bit)
                        seen[bit] += pass.edges[0].tests >> bit & 1;
                    // continue from here, so that inserted vertices become ends too
                    i = random.coin() ? inserted_vertex(pass, 0) : j;
                    if (i.generation > 10)
                        i.generation = 0;
                }
            }
            // the agreement is significant only if every test says both yes and no
            for (const int times : seen) {
                CHECK(times > edges / 50);
                CHECK(times < edges - edges / 50);
            }
            CHECK(splits > edges / 50);
        }
    }
}

TEST_CASE(
    "symmetry: Summed Height Test and Tex Coord Test, every edge of 3 + 2 bits on 8 x 8, every address "
    "mode") {
    Random random(31);
    for (const AddressMode u : both_modes) {
        for (const AddressMode v : both_modes) {
            Machine machine = random_machine(8, 8, u, v, random);
            machine.registers.formats.texture = Format::make_unsigned(6, 2);
            machine.registers.tests.height_thresholds[0] = 60000;
            constexpr std::uint32_t side = 33;
            for (std::uint32_t a = 0; a < side * side; ++a) {
                for (std::uint32_t b = a; b < side * side; ++b) {
                    const TexCoord i{a % side, a / side}, j{b % side, b / side};
                    const Formats& formats = machine.registers.formats;
                    if (machine.summed_height(i, j) != machine.summed_height(j, i) ||
                        tex_coord_test(i, j, midpoint(i, j), formats) != tex_coord_test(j, i, midpoint(j, i), formats))
                        FAIL(i.u << ", " << i.v << " and " << j.u << ", " << j.v);
                }
            }
        }
    }
}

TEST_CASE("symmetry: mean normal and Normal Test, every pair of 4-bit normals") {
    Formats formats;
    formats.normal = Format::make_signed(4, 2);
    const auto direction = [](int code) {
        return Direction{(code & 15) - 8, (code >> 4 & 15) - 8, (code >> 8 & 15) - 8};
    };
    TestParameters parameters;
    parameters.normal_threshold = 2;
    Saturations saturations;
    for (int a = 0; a < 4096; ++a) {
        const Direction i = direction(a);
        for (int b = a; b < 4096; ++b) {
            const Direction j = direction(b);
            const Direction ij = normalise(midpoint(i, j), formats, saturations);
            if (!(ij == normalise(midpoint(j, i), formats, saturations)) ||
                normal_test(i, j, ij, parameters) != normal_test(j, i, ij, parameters))
                FAIL(a << ", " << b);
        }
    }
}

TEST_CASE("symmetry: View Test, every pair of 5-bit screen positions, in front and behind") {
    TestParameters parameters;
    for (const std::uint32_t threshold : {0u, 9u, 40u}) {
        parameters.view_threshold = threshold;
        for (std::int32_t a = 0; a < 2048; ++a) {
            const ScreenPosition i{(a & 31) - 16, (a >> 5 & 31) - 16, a, (a >> 10) != 0};
            for (std::int32_t b = a; b < 2048; ++b) {
                const ScreenPosition j{(b & 31) - 16, (b >> 5 & 31) - 16, b, (b >> 10) != 0};
                if (view_test(i, j, parameters) != view_test(j, i, parameters))
                    FAIL(a << ", " << b);
            }
        }
    }
}

TEST_CASE("seam: an edge moved by whole periods of a repeated map decides alike") {
    constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 3> sizes{{{64, 48}, {5, 7}, {1, 6}}};
    Random random(32);
    for (const auto& size : sizes) {
        const std::uint32_t width = size.first, height = size.second;
        Machine machine = random_machine(width, height, AddressMode::repeat, AddressMode::repeat, random);
        for (int k = 0; k < 60'000; ++k) {
            const auto at = [&] { return TexCoord{random.natural(0, width << 12), random.natural(0, height << 12)}; };
            Vertex i = any_vertex(random, machine, nullptr), j = i;
            j.generation = 3;
            i.texture = at();
            j.texture = at();
            if (random.coin())
                i.texture.u = j.texture.u = 0;  // the seam itself: u = 0 against u = width
            machine.complete(i);
            machine.complete(j);
            Vertex moved_i = i, moved_j = j;
            const std::uint32_t du = random.natural(0, 2) * width << 12, dv = random.natural(0, 2) * height << 12;
            for (Vertex* v : {&moved_i, &moved_j}) {
                v->texture.u += du;
                v->texture.v += dv;
                machine.complete(*v);
            }
            const TrianglePass here = both_ways(machine, i, j), there = both_ways(machine, moved_i, moved_j);
            Vertex back = inserted_vertex(there, 1);
            back.texture.u -= du;
            back.texture.v -= dv;
            if (here.edges[0].tests != there.edges[1].tests || !same_bits(inserted_vertex(here, 0), back))
                FAIL(width << " x " << height << ", edge " << i.texture.u << ", " << i.texture.v << " to "
                           << j.texture.u << ", " << j.texture.v << " moved by " << du << ", " << dv);
        }
    }
}

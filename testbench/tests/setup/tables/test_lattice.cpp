#include <catch2/catch.hpp>

#include "testbench/input/mesh/built_in.h"
#include "testbench/setup/tables/rank_table.h"
#include "testbench/tests/setup/tables/refined_mesh.h"

using namespace tessera;
using namespace tessera::tables_test;

TEST_CASE("A lattice covers each grid point, with vertices at texel centres, and all its edges may split") {
    Random random(1);
    const datapath::Formats formats;
    const std::uint32_t texel = 1u << formats.texture.fraction;
    for (int trial = 0; trial < 50; ++trial) {
        const std::uint32_t spacing = std::uint32_t{1} << random.natural(1, 6);
        const AddressMode u = random.coin() ? AddressMode::repeat : AddressMode::clamp;
        const std::uint32_t width = u == AddressMode::repeat ? spacing * random.natural(1, 3) : random.natural(1, 100);
        const QuantisedMap map = empty_map(width, random.natural(1, 100), u, AddressMode::clamp);
        const auto triangles = lattice_triangles(map.geometry, spacing, formats);
        CHECK(count_whole_base_edges(triangles, formats) == 0);
        CHECK(count_cracks(triangles, map.geometry, formats) == 0);
        std::uint64_t outside_a_centre = 0, clockwise = 0;
        std::vector<bool> covered(map.codes.size(), false);
        for (const Corners& t : triangles) {
            for (const TexCoord& corner : t)
                outside_a_centre += corner.u % texel != texel / 2 || corner.v % texel != texel / 2 ? 1u : 0u;
            const std::int64_t area = (std::int64_t{t[1].u} - t[0].u) * (std::int64_t{t[2].v} - t[0].v) -
                                      (std::int64_t{t[2].u} - t[0].u) * (std::int64_t{t[1].v} - t[0].v);
            clockwise += area <= 0 ? 1u : 0u;
            GridPoints(t, map.geometry, formats).for_each([&](const GridPoint& point) {
                covered[std::size_t{point.row} * width + point.column] = true;
            });
        }
        CHECK(outside_a_centre == 0);
        CHECK(clockwise == 0);
        CHECK(std::count(covered.begin(), covered.end(), false) == 0);
    }
}

TEST_CASE("Crater Lake takes 3 x 4 quads of 128 texels, the last extend beyond the map, a period takes exactly one") {
    CHECK(lattice_quads(336, false, 128) == 3);
    CHECK(lattice_quads(459, false, 128) == 4);
    CHECK(lattice_quads(129, false, 128) == 1);
    CHECK(lattice_quads(128, true, 128) == 1);
    CHECK(lattice_quads(130, false, 128) == 2);
    CHECK(lattice_quads(1, false, 128) == 1);
}

TEST_CASE(
    "On a clamped axis a lattice ends at the last texel's centre or beyond the map, on a repeated one a period later or more") {
    const auto last = [](std::int64_t texels, bool repeats, std::int64_t spacing) {
        const BaseMesh mesh = make_lattice({texels, texels}, {repeats, repeats}, spacing, 2, 2);
        double farthest = 0;
        for (const BaseVertex& vertex : mesh.vertices)
            farthest = std::max(farthest, vertex.texture.x * static_cast<double>(texels));
        return farthest;
    };
    CHECK(last(65, false, 32) == Approx(64.5));  // the last texel's centre: inside
    CHECK(last(64, false, 32) == Approx(64.5));  // beyond
    CHECK(last(66, false, 32) == Approx(96.5));
    CHECK(last(64, true, 32) == Approx(64.5));  // a period after 0.5
    CHECK(last(65, true, 32) == Approx(96.5));
    CHECK(last(1, false, 32) == Approx(32.5));
}

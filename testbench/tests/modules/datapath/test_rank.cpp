#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdlib>

#include "modules/datapath/midpoint.h"
#include "modules/datapath/rank.h"

using namespace tessera::datapath;

namespace {

Formats narrow() {
    Formats formats;
    formats.texture = Format::make_unsigned(3 + 1 + 1, 1);
    return formats;
}

}  // namespace

TEST_CASE("an edge of even length has a midpoint on its ends' lattice, from either end", "[rank]") {
    const Formats formats = narrow();
    unsigned on_lattice = 0;
    for (std::uint32_t code = 0; code < 16 * 16 * 16 * 16; ++code) {
        const TexCoord i{code & 15, code >> 4 & 15}, j{code >> 8 & 15, code >> 12};
        const int du = static_cast<int>(i.u) - static_cast<int>(j.u),
                  dv = static_cast<int>(i.v) - static_cast<int>(j.v);
        const bool expected = du % 4 == 0 && dv % 4 == 0 && (du != 0 || dv != 0);
        REQUIRE(has_lattice_midpoint(i, j, formats) == expected);
        REQUIRE(has_lattice_midpoint(j, i, formats) == expected);
        REQUIRE(texture_length(i, j) == static_cast<std::uint32_t>(std::abs(du) + std::abs(dv)));
        REQUIRE(texture_length(i, j) == texture_length(j, i));
        if (!expected)
            continue;
        ++on_lattice;
        const TexCoord m = midpoint(i, j);
        REQUIRE(m == midpoint(j, i));
        REQUIRE(((m.u ^ i.u) & 1) == 0);  // the same fraction
        REQUIRE(((m.v ^ i.v) & 1) == 0);
    }
    CHECK(on_lattice > 1000);
}

TEST_CASE("an entry's rank is in the bits below its bound", "[rank]") {
    Formats formats;
    formats.height_test = HeightTest::rank;
    for (const int rank_bits : {0, 6, 8, 16}) {
        for (const int bound_bits : {0, 6, 12, 16}) {
            formats.rank_bits = rank_bits;
            formats.bound_bits = bound_bits;
            const std::uint64_t rank = (1u << rank_bits) - 1, bound = ((1u << bound_bits) - 1) & 0x5555;
            const RankEntry entry = rank_entry(rank | bound << rank_bits, formats);
            CHECK(entry.rank == rank);
            CHECK(entry.bound == bound);
            CHECK(ordering_rank(entry, formats) == (rank_bits > 0 ? rank : bound));
            CHECK(rank_entry_bits(formats) == rank_bits + bound_bits);
        }
    }
}

TEST_CASE("RT: splits above either threshold, not at it", "[rank]") {
    TestParameters parameters;
    parameters.height_thresholds[rank_number] = 10;
    parameters.height_thresholds[bound_number] = 20;
    CHECK_FALSE(rank_test({10, 20}, parameters));
    CHECK(rank_test({11, 0}, parameters));
    CHECK(rank_test({0, 21}, parameters));
    CHECK_FALSE(rank_test({0, 0}, {}));
}

TEST_CASE("a midpoint's entry is at its own texel, beyond the table at the border or a period before", "[rank]") {
    const Formats formats = narrow();
    const TableLayout table{100, 4, 3, 2};
    MapGeometry map{4, 3, AddressMode::clamp, AddressMode::clamp};
    CHECK(rank_address({2 * 3 + 1, 2 * 2}, table, map, formats) == 100 + 2 * (2 * 4 + 3));
    CHECK(rank_address({2 * 5, 2 * 4}, table, map, formats) == 100 + 2 * (2 * 4 + 3));
    map.address_u = map.address_v = AddressMode::repeat;
    CHECK(rank_address({2 * 5, 2 * 4}, table, map, formats) == 100 + 2 * (1 * 4 + 1));
}

TEST_CASE("one edge is cut: that of greatest rank, among equals the longest, then the first", "[rank]") {
    for (unsigned code = 0; code < 8 * 27 * 27; ++code) {
        const unsigned asked = code % 8, r = code / 8 % 27, l = code / 8 / 27;
        const std::array<std::uint16_t, 3> ranks{static_cast<std::uint16_t>(r % 3),
                                                 static_cast<std::uint16_t>(r / 3 % 3),
                                                 static_cast<std::uint16_t>(r / 9)};
        const std::array<std::uint32_t, 3> lengths{l % 3, l / 3 % 3, l / 9};
        const unsigned cut = edge_of_greatest_rank(asked, ranks, lengths);
        CAPTURE(asked, ranks, lengths, cut);
        if (asked == 0) {
            REQUIRE(cut == 0);
            continue;
        }
        REQUIRE((cut == 1 || cut == 2 || cut == 4));
        REQUIRE((cut & asked) == cut);
        const std::size_t best = cut == 1 ? 0 : cut == 2 ? 1 : 2;
        for (std::size_t k = 0; k < 3; ++k) {
            if ((asked >> k & 1u) == 0 || k == best)
                continue;
            const bool better = ranks[best] > ranks[k] || (ranks[best] == ranks[k] && lengths[best] > lengths[k]) ||
                                (ranks[best] == ranks[k] && lengths[best] == lengths[k] && best < k);
            REQUIRE(better);
        }
    }
}

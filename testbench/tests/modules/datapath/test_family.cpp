#include "modules/datapath/family.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <utility>

// The new edges of a triangle's children: each occurs once, and none is a whole edge of the parent.

using namespace tessera::datapath;

namespace {

using Ends = std::pair<int, int>;

Ends sorted(int a, int b) {
    return {std::min(a, b), std::max(a, b)};
}

/// The ends of the children's edges that are no edges of the parent, and how often each occurs.
std::map<Ends, int> new_edges(const ChildIndices& indices) {
    std::map<Ends, int> found;
    for (int c = 0; c < indices.count; ++c) {
        const auto& corners = indices.children[static_cast<std::size_t>(c)];
        for (std::size_t e = 0; e < 3; ++e)
            if (corners[e] > 2 || corners[(e + 1) % 3] > 2)
                ++found[sorted(corners[e], corners[(e + 1) % 3])];
    }
    return found;
}

}  // namespace

TEST_CASE("family: k splits give 2 k halves and k inner edges, each once, in the order of the children") {
    for (unsigned split = 1; split < 8; ++split) {
        for (const bool second : {false, true}) {
            const ChildIndices indices = triangulate(split, second);
            const FamilyEdges family = family_edges(indices, 0);
            const std::map<Ends, int> expected = new_edges(indices);
            const auto k = static_cast<unsigned>(__builtin_popcount(split));
            CHECK(family.count == 3 * k);
            CHECK(expected.size() == 3 * k);
            CHECK(std::count_if(expected.begin(), expected.end(), [](const auto& edge) { return edge.second == 2; }) ==
                  k);

            unsigned next = 0;
            for (std::size_t c = 0; c < static_cast<std::size_t>(indices.count); ++c) {
                for (std::size_t e = 0; e < 3; ++e) {
                    const int i = indices.children[c][e], j = indices.children[c][(e + 1) % 3];
                    const unsigned number = family.of_child[c][e];
                    if (expected.count(sorted(i, j)) == 0) {
                        CHECK(number == FamilyEdges::whole);
                        continue;
                    }
                    REQUIRE(number < family.count);
                    CHECK(sorted(family.edges[number].i, family.edges[number].j) == sorted(i, j));
                    CHECK(number <= next);
                    next = std::max(next, number + 1);
                }
            }
            CHECK(next == family.count);
        }
    }
}

TEST_CASE("family: a base triangle has three new edges, a finished one has none") {
    const FamilyEdges base = family_edges(triangulate(0, false), open_edges(true, 0));
    CHECK(base.count == 3);
    for (std::uint8_t e = 0; e < 3; ++e) {
        CHECK(base.of_child[0][e] == e);
        CHECK(base.edges[e].i == e);
        CHECK(base.edges[e].j == (e + 1) % 3);
    }
    const FamilyEdges finished = family_edges(triangulate(0, false), open_edges(false, 0));
    CHECK(finished.count == 0);
    for (std::size_t e = 0; e < 3; ++e)
        CHECK(finished.of_child[0][e] == FamilyEdges::whole);
}

TEST_CASE("family: uncut edges that asked for a split are tested with the children's edges") {
    for (unsigned cut = 1; cut < 8; cut *= 2) {
        for (unsigned uncut = 0; uncut < 8; ++uncut) {
            if ((uncut & cut) != 0)
                continue;
            const ChildIndices indices = triangulate(cut, false);
            const FamilyEdges family = family_edges(indices, open_edges(false, static_cast<std::uint8_t>(uncut)));
            CHECK(family.count == 3 + static_cast<unsigned>(__builtin_popcount(uncut)));
            unsigned whole = 0;
            for (std::size_t c = 0; c < 2; ++c)
                for (std::size_t e = 0; e < 3; ++e)
                    whole += family.of_child[c][e] == FamilyEdges::whole ? 1u : 0u;
            CHECK(whole == 2 - static_cast<unsigned>(__builtin_popcount(uncut)));
        }
    }
}

#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/triangulate.h"

namespace tessera::datapath {

/// The edges of a triangle's children to be tested: with k split edges their 2 k halves and k edges inside the
/// triangle, each once, although an inner edge belongs to two children; and the triangle's own open edges.
struct FamilyEdges {
    static constexpr std::uint8_t whole = 0xff;  ///< an edge of the parent that is final
    struct Ends {
        std::uint8_t i, j;  ///< numbered as in ChildIndices
    };
    std::array<Ends, 9> edges{};
    unsigned count = 0;
    /// of_child[c][e]: which of `edges` is edge e of child c, from its corner e to the next; or `whole`.
    std::array<std::array<std::uint8_t, 3>, 4> of_child{};
};

/// The triangle's own edges to be tested with those of its children: all edges of a base triangle, else those that
/// requested a split while another edge was cut. Bit k: edge k.
constexpr std::uint8_t open_edges(bool untested, std::uint8_t uncut) {
    return untested ? std::uint8_t{7} : uncut;
}

/// In the order of the children, and of each child's edges. open: the triangle's open edges (open_edges).
constexpr FamilyEdges family_edges(const ChildIndices& indices, std::uint8_t open) {
    FamilyEdges family;
    const auto number_of = [&](std::uint8_t i, std::uint8_t j) -> std::uint8_t {
        if (i < 3 && j < 3 && (open >> i & 1u) == 0)
            return FamilyEdges::whole;
        for (unsigned k = 0; k < family.count; ++k)
            if (family.edges[k].i == j && family.edges[k].j == i)
                return static_cast<std::uint8_t>(k);
        family.edges[family.count] = {i, j};
        return static_cast<std::uint8_t>(family.count++);
    };
    for (std::size_t c = 0; c < static_cast<std::size_t>(indices.count); ++c)
        for (std::size_t e = 0; e < 3; ++e)
            family.of_child[c][e] = number_of(indices.children[c][e], indices.children[c][(e + 1) % 3]);
    return family;
}

}  // namespace tessera::datapath

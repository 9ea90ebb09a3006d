#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/triangle_pass.h"
#include "modules/datapath/triangulate.h"

namespace tessera::datapath {

/// The generation of an inserted vertex, saturated to its field, counted. With the Generation Test on it always fits.
constexpr std::uint8_t kept_generation(std::uint8_t generation, const Formats& formats, Saturations& saturations) {
    return static_cast<std::uint8_t>(
        saturate(generation, Format::make_unsigned(formats.generation_bits, 0), saturations.generation));
}

/// A child's final edges: an edge between two corners of its parent is an edge of the parent. It is final unless it
/// requested a split and another edge was cut instead. With k split edges, k + 1 children have 3 (k + 1) edges, 4 k of
/// them new: edges tested = 3 x base triangles + 4 x edges split + edges left uncut, which every run checks.
/// `corners`: those of the child, as returned by triangulate().
constexpr std::uint8_t final_edges_of(const std::array<std::uint8_t, 3>& corners, unsigned asked) {
    unsigned edges = 0;
    for (unsigned k = 0; k < 3; ++k)
        edges |= corners[k] < 3 && corners[(k + 1) % 3] < 3 && (asked >> corners[k] & 1u) == 0 ? 1u << k : 0u;
    return static_cast<std::uint8_t>(edges);
}

/// Calls child(triangle) for each child of a pass whose edges are decided, with all known values of its vertices.
/// Returns the number of children.
template <class Child>
int tessellate(const TrianglePass& pass, Triangulation choice, const Formats& formats, Saturations& saturations,
               Child&& child) {
    std::array<Vertex, 3> inserted;
    std::array<const Vertex*, 6> vertices;
    std::uint8_t split_by = 0;
    unsigned asked = pass.triangle.uncut;  // of families, whose midpoints come without the tests' results
    for (int k = 0; k < 3; ++k) {
        vertices[static_cast<std::size_t>(k)] = &pass.triangle.vertices[static_cast<std::size_t>(k)];
        vertices[static_cast<std::size_t>(3 + k)] = &inserted[static_cast<std::size_t>(k)];
        asked |= split_decision(pass.edges[static_cast<std::size_t>(k)].tests) ? 1u << k : 0u;
        if ((pass.split >> k & 1) == 0)
            continue;
        Vertex& vertex = inserted[static_cast<std::size_t>(k)];
        vertex = inserted_vertex(pass, k);
        vertex.generation = kept_generation(vertex.generation, formats, saturations);
        split_by =
            static_cast<std::uint8_t>(split_by | (pass.edges[static_cast<std::size_t>(k)].tests & requesting_tests));
    }
    const bool second = choose_second_diagonal(
        pass.split, choice, [&](std::uint8_t index) -> const Position& { return vertices[index]->displaced; });
    const ChildIndices indices = triangulate(pass.split, second);
    Triangle triangle;
    triangle.base = pass.triangle.base;
    triangle.parent = pass.split != 0 ? pass.number : pass.triangle.parent;
    triangle.finished = pass.triangle.finished;
    triangle.stopped_by = pass.triangle.finished ? pass.triangle.stopped_by : std::uint8_t{0};
    triangle.split_by = pass.split != 0 ? split_by : pass.triangle.split_by;
    for (int k = 0; k < indices.count; ++k) {
        const auto& corners = indices.children[static_cast<std::size_t>(k)];
        triangle.vertices = {*vertices[corners[0]], *vertices[corners[1]], *vertices[corners[2]]};
        triangle.final_edges =
            formats.final_edges || formats.families ? final_edges_of(corners, asked) : std::uint8_t{0};
        child(triangle);
    }
    return indices.count;
}

}  // namespace tessera::datapath

#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/bump.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// Results of Calculate New P, Displace Vertex and Transform for the midpoint of one edge.
struct NewVertex {
    Position position;          ///< P_ij                             (Calculate New P)
    Direction mean_normal;      ///< (N_i + N_j) / 2, not yet unit    (Calculate New P)
    TexCoord texture;           ///< t_ij                             (Calculate New P)
    std::uint16_t code = 0;     ///< d_ij, 0 unless Formats::codes    (Displace Vertex)
    Position displaced;         ///< P'_ij                            (Displace Vertex)
    ScreenPosition screen;      ///< P's_ij                           (Transform)
    Direction screen_normal{};  ///< N's_ij, with Formats::families   (Transform)
    bool screen_normal_known = false;
};

/// Results of Tessellation Tests for one edge.
struct EdgeTests {
    TexCoord texture;            ///< t_ij    (Calculate New U)
    Direction normal;            ///< N_ij    (Normal Test)
    Direction tangent;           ///< T_ij    (Normal Test)
    Direction displaced_normal;  ///< N'_ij   (Normal Test)
    std::uint8_t tests = 0;      ///< TestBits
    std::uint8_t evaluated = 0;  ///< TestBits: the tests that were evaluated; 0: the edge is final and was not tested
    std::uint16_t rank = 0;      ///< rank of its midpoint, with a Rank Test
};

/// The information reported about a pass. In the family design edges are tested before their midpoints are made.
enum class Told : std::uint8_t { all, tests, midpoints };

/// One pass of one triangle through the machine, joined by Pass or Tessellate from the triangle and its parts. Edge k
/// runs from vertex k to vertex (k + 1) mod 3.
struct TrianglePass {
    std::uint32_t number = 0;  ///< the model's number for the pass
    Triangle triangle;
    std::uint8_t new_vertices = 0;  ///< bit k: vertex k has no P', P's, N' yet (a base triangle's first pass)
    std::uint8_t new_normals = 0;   ///< bit k: vertex k has N' but not yet N's
    bool tested = false;            ///< edges go through the tests on this pass
    std::array<NewVertex, 3> new_vertex;
    std::array<EdgeTests, 3> edges;
    std::uint8_t split = 0;  ///< bit k: edge k is split (Pass or Tessellate)
    Told told = Told::all;
    std::uint8_t shared = 0;  ///< bit k: edge k was tested once for this and for a sibling reported before

    constexpr const Vertex& edge_begin(int k) const { return triangle.vertices[static_cast<std::size_t>(k)]; }
    constexpr const Vertex& edge_end(int k) const {
        return triangle.vertices[static_cast<std::size_t>(k == 2 ? 0 : k + 1)];
    }
};

/// The vertex inserted on edge k, from the results of both branches. In the triangle design N's is calculated on its
/// next pass.
constexpr Vertex inserted_vertex(const TrianglePass& pass, int k) {
    const Vertex& i = pass.edge_begin(k);
    const Vertex& j = pass.edge_end(k);
    const NewVertex& made = pass.new_vertex[static_cast<std::size_t>(k)];
    const EdgeTests& tested = pass.edges[static_cast<std::size_t>(k)];
    Vertex vertex;
    vertex.position = made.position;
    vertex.normal = tested.normal;
    vertex.tangent = tested.tangent;
    vertex.texture = made.texture;
    vertex.handedness = inserted_handedness(i.handedness, j.handedness);
    vertex.generation = inserted_generation(i.generation, j.generation);
    vertex.displaced_known = true;
    vertex.code = made.code;
    vertex.displaced = made.displaced;
    vertex.displaced_normal = tested.displaced_normal;
    vertex.screen = made.screen;
    vertex.screen_normal = made.screen_normal;
    vertex.screen_normal_known = made.screen_normal_known;
    return vertex;
}

}  // namespace tessera::datapath

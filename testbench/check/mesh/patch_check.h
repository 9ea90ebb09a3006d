#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "testbench/check/mesh/base_edge_chains.h"
#include "testbench/check/mesh/corner_table.h"
#include "testbench/check/mesh/fold_map.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/check/mesh/violation_text.h"

namespace tessera {

/// Checks one patch after another: all that can be said of a base triangle's emitted triangles without
/// looking at its neighbours. Leaves how the base triangle's edges were cut, for base_edge_check.h.
///
/// Edges are matched by the numbers of their ends, then by P' of both. What has no partner within the patch
/// must be a piece of the base triangle's border: the border is walked by halving each base edge at
/// datapath::midpoint until a piece is found. What then remains is a T-vertex if its midpoint exists, else a
/// crack.
class PatchCheck {
  public:
    PatchCheck(const EmittedMesh& mesh, const std::vector<datapath::Triangle>& base_triangles,
               const datapath::Registers& registers, InvariantResult& result, FirstViolation& first,
               BaseEdgeChains& chains);

    /// base: 0, 1, 2, ... in this order. triangles: indices of what was emitted of it.
    void check(std::uint32_t base, const std::uint32_t* triangles, std::size_t count);

  private:
    __extension__ using Wide = __int128;

    struct HalfEdge {
        std::uint32_t low, high;       // numbers of its ends
        std::uint32_t corner_and_way;  // 2 * its first corner + (1: runs from high to low)
    };
    struct OpenEdge {
        std::uint32_t low, high, corner_and_way;
        bool used;
        bool ambiguous;  // one of several in its place
    };

    void number_vertices(const std::uint32_t* triangles, std::size_t count);
    void judge_shape(std::uint32_t triangle);
    void judge_vertices();
    void match_edges();
    void match_run(const HalfEdge* begin, const HalfEdge* end);
    void walk_border();
    void walk(const SurfacePoint& a, const SurfacePoint& b, std::uint32_t begin, int depth);
    void judge_remaining();
    std::uint64_t take_opposite(const SurfacePoint& a, const SurfacePoint& b, int depth);
    void compare_areas();
    void count_duplicates(const std::uint32_t* triangles, std::size_t count);
    OpenEdge* find_open(std::uint32_t from, std::uint32_t to);
    const HalfEdge* find_matched(std::uint32_t from, std::uint32_t to) const;
    OpenEdge* reopen(std::uint32_t from, std::uint32_t to);
    bool is_covered(const SurfacePoint& a, const SurfacePoint& b, int depth);
    bool is_split(const SurfacePoint& a, const SurfacePoint& b, SurfacePoint& middle);
    bool may_coincide(const EmittedTriangle::Corner& corner);
    bool coincides(std::uint32_t vertex) const {
        return std::binary_search(coincident_.begin(), coincident_.end(), vertex);
    }
    bool is_folded() const { return texture_folds_.any() && position_folds_.any(); }
    static void start(FoldMap& folds, Wide area, const Place& a, const Place& b, const Place& c);
    bool is_explained(const EmittedTriangle& triangle) const;
    void crack_between(CornerRef first, const char* what);

    const EmittedMesh& mesh_;
    const std::vector<datapath::Triangle>& base_triangles_;
    const datapath::Registers& registers_;
    InvariantResult& result_;
    FirstViolation& first_;
    BaseEdgeChains& chains_;

    // of the patch at hand
    std::uint32_t base_ = 0;
    int base_sign_ = 0;                                      // of its texture area
    Wide base_area_ = 0, patch_area_ = 0, border_area_ = 0;  // doubled
    Wide border_rounding_ = 0;                               // bound on border less base area, in 1/36
    Wide base_seen_area_ = 0;  // of P, doubled, seen along the axis on which it is largest
    int plane_ = 0;            // that axis
    std::size_t pieces_of_edge_ = 0;
    int depth_of_edge_ = 0;
    bool doubled_edge_ = false;  // some edge has two triangles on one side
    FoldMap texture_folds_, position_folds_;
    CornerTable vertices_;
    std::vector<CornerRef> unlike_;          // corners that differ from their vertex's first
    std::vector<std::uint32_t> coincident_;  // numbers, in order, that stand for several vertices
    std::vector<HalfEdge> edges_;
    std::vector<OpenEdge> open_;
    std::vector<HalfEdge> run_;
    std::vector<std::array<std::uint32_t, 3>> triples_;
};

}  // namespace tessera

#pragma once
#include <cstdint>
#include <vector>

#include "testbench/check/mesh/corner_table.h"

namespace tessera {

/// One piece of a base triangle's edge, as its emitted triangles cut it. Pieces follow one another along the
/// edge.
struct ChainPiece {
    static constexpr std::uint32_t whole = std::uint32_t{1} << 31;
    static constexpr int max_depth = 31;

    std::uint32_t begin = 0;      ///< where on the base edge, in parts of `whole`
    CornerRef first = no_corner;  ///< corner at its begin; no_corner: no triangle has this piece
    CornerRef last = no_corner;   ///< corner at its end, of the same triangle
    bool ambiguous =
        false;  ///< rounding has put several edges of a folded patch here: perhaps not the right one
    /// Rounding has put several vertices of a folded patch at its begin, at its end: perhaps not the right corner.
    bool first_coincides = false, last_coincides = false;
};

/// How every edge of every base triangle was cut. Edge k of base triangle b is number 3 b + k, and runs from
/// the triangle's vertex k on.
class BaseEdgeChains {
  public:
    explicit BaseEdgeChains(std::size_t base_triangles) { offsets_.reserve(3 * base_triangles + 1); }

    /// The edges are to be added in the order of their numbers: pieces, then end of edge.
    void add_piece(const ChainPiece& piece) { pieces_.push_back(piece); }
    void end_edge() { offsets_.push_back(pieces_.size()); }

    std::size_t size(std::size_t edge) const { return offsets_[edge + 1] - offsets_[edge]; }
    const ChainPiece& piece(std::size_t edge, std::size_t index) const {
        return pieces_[offsets_[edge] + index];
    }

  private:
    std::vector<ChainPiece> pieces_;
    std::vector<std::size_t> offsets_{0};
};

}  // namespace tessera

#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/triangle_pass.h"
#include "modules/datapath/triangulate.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Decides whether a tessellation is closed: a visitor of BareRecursion::walk. Traces each edge to the base edge from
/// which it descends; positions are not compared.
///
/// A vertex is identified by the edge on which it was inserted, so two vertices that rounding merges remain two. Base
/// vertices are the same if they agree in P, N, T, handedness, and in t up to whole periods of a repeated axis. Two
/// sides are *joined* into one base edge if both ends are the same vertices and t changes by the same amount along
/// both. Then
///   - a piece of a base edge must have the same triangles on either side as its base edge; an edge inside a base
///     triangle, one on each side: otherwise it is a crack;
///   - no edge may be split by one of its triangles and whole in another: a T-vertex;
///   - all fields of a vertex, except N's and whole periods of t, must be equal in all its triangles.
/// Exact for any formats, without exceptions. Gaps between sides that are not joined are caused by the input: its map
/// or its normals are discontinuous there.
///
/// Memory: about 200 bytes per base triangle, and 130 per triangle emitted from the current base triangle.
class Lineage {
  public:
    /// `setup` must outlive it; `bare` must be of the same setup.
    Lineage(const MachineSetup& setup, BareRecursion& bare);

    /// Call after the walk. Returns the results for base edges and between triangles; the other members stay 0.
    InvariantResult finish();

    using Number = std::uint32_t;  ///< of a vertex or an edge, see Numbered
    /// An edge as used by a triangle.
    struct Side {
        Number edge;
        bool along;  ///< the triangle uses it in the edge's own direction
        Side turned() const { return {edge, !along}; }
    };
    struct Note {
        std::array<Number, 3> vertices;
        std::array<Side, 3> edges;
    };
    Note begin(const datapath::Triangle& base);
    void decided(const datapath::TrianglePass& pass, const datapath::ChildIndices& children, const Note& note);
    Note child(const std::array<std::uint8_t, 3>& corners);
    void finished(const datapath::Triangle&, bool) {}

  private:
    static constexpr Number none = UINT32_MAX;

    /// Items of base edges, which are kept, and of the interior of the current base triangle.
    template <class Item>
    class Numbered {
      public:
        Number add(bool inside, const Item& item) {
            std::vector<Item>& items = inside ? inside_ : kept_;
            items.push_back(item);
            return static_cast<Number>(items.size() - 1) | (inside ? inside_bit : 0);
        }
        Item& operator[](Number number) { return is_inside(number) ? inside_[number & ~inside_bit] : kept_[number]; }
        const Item& operator[](Number number) const {
            return is_inside(number) ? inside_[number & ~inside_bit] : kept_[number];
        }
        static bool is_inside(Number number) { return (number & inside_bit) != 0; }
        const std::vector<Item>& kept() const { return kept_; }
        const std::vector<Item>& inside() const { return inside_; }
        void forget_inside() { inside_.clear(); }

      private:
        static constexpr Number inside_bit = Number{1} << 31;
        std::vector<Item> kept_, inside_;
    };

    struct KnownVertex {
        datapath::Vertex vertex;  // as first seen
        bool unlike = false;
    };
    /// The number of triangles that use an edge along its direction, and against it.
    struct Sides {
        std::uint32_t along = 0, against = 0;
        std::uint32_t& of(bool is_along) { return is_along ? along : against; }
        friend bool operator==(const Sides& a, const Sides& b) { return a.along == b.along && a.against == b.against; }
    };
    struct Edge {
        Number from, to;
        Number middle = none;  // none: not split
        Number pieces = none;  // from..middle; the next one is middle..to
        Sides wanted, found;   // found: from triangles that do not split it
    };
    /// The change of t from one end of a base edge to the other.
    struct Way {
        std::int64_t u, v;
        friend bool operator==(const Way& a, const Way& b) { return a.u == b.u && a.v == b.v; }
        Way turned() const { return {-u, -v}; }
    };

    void name_base_mesh(BareRecursion& bare);
    std::uint64_t within_period(std::uint32_t value, std::uint64_t period) const;
    bool same_texture(const datapath::TexCoord& a, const datapath::TexCoord& b) const;
    void meet(Number vertex, const datapath::Vertex& seen);
    void split(const Side& side, const datapath::Vertex& inserted);
    void judge(const std::vector<Edge>& edges);
    void judge_patch();
    void compare_base_edges();
    std::uint64_t open_pieces(Side a, Side b) const;
    std::uint64_t pieces_of(Number edge) const;
    const datapath::Vertex& begin_of(const Side& side) const;
    template <class Text>
    void fault(std::uint64_t& count, Text&& text);
    std::string vertex_text(const datapath::Vertex& vertex) const;

    const MachineSetup& setup_;
    std::uint64_t period_u_ = 0, period_v_ = 0;  // in LSB; 0: the axis does not repeat
    InvariantResult result_;
    Numbered<KnownVertex> vertices_;
    Numbered<Edge> edges_;
    std::vector<Way> ways_;         // of the base edges, which come first among the kept edges
    std::vector<Note> base_notes_;  // of the base triangles
    std::uint32_t base_ = none;     // current base triangle
    // of the last decided pass, by the six indices of its corners and midpoints
    std::array<Number, 6> corners_{};
    std::array<std::array<Side, 6>, 6> sides_{};
};

}  // namespace tessera

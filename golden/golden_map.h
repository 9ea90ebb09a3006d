#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "golden/summed_area_table.h"

namespace tessera::golden {

/// How one axis is read outside the map: `clamp` holds the border texel, `repeat` is periodic.
enum class AddressMode { clamp, repeat };

/// The Rank Table (4.7): for each texel of the lattice on which the base mesh lies, the error of leaving out the
/// midpoint there, on logarithmic scales. Rows from the bottom. A list is empty if the design lacks that part.
struct RankTable {
    std::int64_t columns = 0, rows = 0;
    std::vector<std::uint16_t> ranks, bounds;
    std::vector<std::uint8_t> radii;    ///< codes; present with bounds that depend on distance
    int highest_bound_threshold = 0;    ///< largest threshold for which the bounds hold
    std::vector<glm::dvec2> midpoints;  ///< in texels, in the order of their bisection
};

/// An entry of the Curvature Table (4.8) for a square of 2^l texels, in codes: | xx u^2 + xy u v + yy v^2 | is the
/// distance of the midpoint of an edge (u, v) 2^l from its chord, `rest` the root mean square of the remaining
/// deviation of the map. All are multiples of `unit`.
struct Curvature {
    double xx = 0, xy = 0, yy = 0, rest = 0;
    double unit = 0;
};

/// Levels l = 2, 3, ... in succession, each with its rows from the bottom and a cell every 2^(l - 1) texels.
struct CurvatureTable {
    std::int64_t columns = 0, rows = 0;  ///< texels covered
    std::vector<Curvature> cells;
};

/// The height of a block of a mipmap (4.9): the mean of its texels, rounded to nearest, or their maximum.
enum class MipmapFilter { mean, maximum };

/// How the displacement map and the normal map are read: the texel that contains t, or interpolation between the four
/// texels whose centres surround t.
enum class Filter { nearest, bilinear };

/// A displacement map with its summed-area table and normal map (ALGORITHM.md section 2).
/// Row 0 is v = 0, the bottom. Texture coordinates are in texels: texel x covers [x, x + 1).
class Map {
  public:
    /// `codes` row by row from the bottom: integers 0 .. 2^32 - 1, all sums below 2^52. Throws std::invalid_argument
    /// otherwise. The normal map starts flat.
    Map(int width, int height, AddressMode address_u, AddressMode address_v, const std::vector<double>& codes);

    int width() const { return width_; }
    int height() const { return height_; }
    AddressMode address_u() const { return address_u_; }
    AddressMode address_v() const { return address_v_; }

    /// The code in the displacement map.
    double code(std::size_t texel) const { return heights_.empty() ? codes_[texel] : heights_[texel]; }
    /// The code that everything but displacements is derived from.
    double given_code(std::size_t texel) const { return codes_[texel]; }
    /// N_d; flat, (0, 0, 1), until derive_normals() or set_normals() is called.
    glm::dvec3 normal(std::size_t texel) const;
    /// dh/du and dh/dv by central differences; h is the displacement in world units (see derive_normals()). A clamped
    /// border has only one neighbour and divides by 1. An axis of one texel has slope 0.
    glm::dvec2 slope(std::size_t texel) const;

    /// Index of the texel that contains t. On the last border (u = width) this is the last texel (clamp) or the first
    /// (repeat).
    std::size_t texel(const glm::dvec2& t) const;

    /// The code and N_d at t. An interpolated N_d may be shorter than a unit vector.
    double code(const glm::dvec2& t, Filter filter) const;
    glm::dvec3 normal(const glm::dvec2& t, Filter filter) const;

    /// Derives the normal map from the displacement by finite differences:
    ///     N_d = normalise(-dh/du, -dh/dv, 1),     h = scale_per_code * code in world units.
    /// `texel_size`: the world size of a texel per axis. Call it again when the scale changes. Normals are not stored;
    /// normal() calculates each on demand.
    void derive_normals(double scale_per_code, const glm::dvec2& texel_size);
    /// Uses the given normal map, e.g. the hardware's, dequantised.
    void set_normals(std::vector<glm::dvec3> normals);

    /// Sets the displacement map's heights, in codes. Everything else is still derived from the original codes.
    void set_heights(std::vector<double> heights);

    /// Uses a Rank Table, in place of the Summed Height Test. It may be larger than the map.
    void set_ranks(RankTable table) { rank_table_ = std::move(table); }
    const RankTable& rank_table() const { return rank_table_; }
    bool has_ranks() const { return rank_table_.columns > 0; }
    /// Rank and bound at the texel that contains t; 0 for parts that the table lacks.
    struct Rank {
        int rank = 0, bound = 0, radius = 0;
    };
    Rank rank(const glm::dvec2& t) const;
    /// The value by which the cut `greatest_rank` compares midpoints: the rank or, without ranks, the bound.
    int order(const Rank& rank) const { return rank_table_.ranks.empty() ? rank.bound : rank.rank; }

    /// Uses a Curvature Table, in place of the Summed Height Test. It may cover more than the map.
    void set_curvatures(CurvatureTable table) { curvature_table_ = std::move(table); }
    const CurvatureTable& curvature_table() const { return curvature_table_; }
    bool has_curvatures() const { return curvature_table_.columns > 0; }
    /// The cell nearest to the texel that contains t. level: from 2 to the table's highest.
    Curvature curvature(const glm::dvec2& t, int level) const;

    /// Builds the mipmap of a Mipmap Test that replaces the Summed Height Test.
    void make_mipmap(MipmapFilter filter);
    /// Heights of the blocks of 2^l x 2^l texels of each level l, rows from the bottom; empty if no mipmap was built.
    const std::vector<std::vector<double>>& mipmap() const { return mipmap_; }
    /// The height of the block that holds the texel that contains t. level: at most the last.
    double mipmap_height(const glm::dvec2& t, int level) const;

    /// Width and height in texels of the Summed Height Test's three rectangles on an edge (4.2):
    ///     n_w = min(width,  max(1, int(|du| / 2)))     n_h = min(height, max(1, int(|dv| / 4)))
    Rectangle rectangle_size(const glm::dvec2& t_i, const glm::dvec2& t_j) const;
    /// The rectangle of this size about t: first column int(u) - (n_w >> 1), first row int(v) - (n_h >> 1). It is never
    /// clipped, but shifted inside (clamp) or read periodically (repeat).
    Rectangle rectangle_about(const glm::dvec2& t, const Rectangle& size) const;

    /// S(r) by four reads of the table.
    std::uint64_t sum(const Rectangle& r) const { return sums_.sum(r); }
    /// S(r) summed texel by texel, read periodically. The reference for tests of the table.
    std::uint64_t brute_force_sum(const Rectangle& r) const;

  private:
    struct Part {
        std::size_t texel;
        double weight;
    };
    /// The four texels around t, and their weights.
    std::array<Part, 4> around(const glm::dvec2& t) const;

    int width_, height_;
    AddressMode address_u_, address_v_;
    std::vector<std::uint32_t> codes_;
    double scale_per_code_ = 0;
    glm::dvec2 texel_size_{1, 1};
    std::vector<glm::dvec3> normals_;  // given by set_normals(), else empty
    std::vector<double> heights_;      // given by set_heights(), else empty
    SummedAreaTable sums_;
    RankTable rank_table_;
    CurvatureTable curvature_table_;
    std::vector<std::vector<double>> mipmap_;
};

}  // namespace tessera::golden

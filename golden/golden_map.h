#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "golden/summed_area_table.h"

namespace tessera::golden {

/// How one axis is read outside the map: `clamp` holds the border texel, `repeat` is periodic.
enum class AddressMode { clamp, repeat };

/// How the displacement map and the normal map are read: the texel that contains t, or interpolation between the four
/// texels whose centres surround t.
enum class Filter { nearest, bilinear };

class HeightTest;

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

    /// At first a Summed Height Test with a threshold of 0.
    void set_height_test(std::shared_ptr<const HeightTest> test) { height_test_ = std::move(test); }
    const HeightTest& height_test() const { return *height_test_; }

    /// Column and row of the entry for t in a table of this size, addressed like the map.
    std::array<std::int64_t, 2> entry(const glm::dvec2& t, std::int64_t columns, std::int64_t rows) const;

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
    std::shared_ptr<const HeightTest> height_test_;
};

}  // namespace tessera::golden

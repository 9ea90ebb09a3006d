#pragma once
#include <array>
#include <cstdint>

namespace tessera::datapath {

/// A point in world space, in the position's format.
struct Position {
    std::int32_t x = 0, y = 0, z = 0;
    friend constexpr bool operator==(const Position& a, const Position& b) {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }
};

/// A normal or tangent, in the normal's format: of unit length within rounding, or the mean of two unit vectors.
struct Direction {
    std::int32_t x = 0, y = 0, z = 0;
    friend constexpr bool operator==(const Direction& a, const Direction& b) {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }
};

/// A texture coordinate in texels, in the texture's format; v = 0 is the map's bottom row.
struct TexCoord {
    std::uint32_t u = 0, v = 0;
    friend constexpr bool operator==(const TexCoord& a, const TexCoord& b) { return a.u == b.u && a.v == b.v; }
};

/// P's: pixels in the screen's format, and the distance w from the eye along the view direction in the view distance's
/// format, for a w-buffer. A vertex on or behind the near plane has no screen position.
struct ScreenPosition {
    std::int32_t x = 0, y = 0, w = 0;
    bool in_front = false;
    std::uint32_t distance = 0;  ///< D, from the eye, in any direction; 0 unless Formats::distances
    friend constexpr bool operator==(const ScreenPosition& a, const ScreenPosition& b) {
        return a.x == b.x && a.y == b.y && a.w == b.w && a.in_front == b.in_front && a.distance == b.distance;
    }
};

/// All values that a vertex carries through the machine (paper 3.1.5, golden/ALGORITHM.md 1).
struct Vertex {
    Position position;           ///< P, on the base surface
    Direction normal;            ///< N, of the base surface
    Direction tangent;           ///< T, of the base surface: dp/du
    TexCoord texture;            ///< t
    std::int8_t handedness = 1;  ///< bitangent = handedness * (N x T)
    std::uint8_t generation = 0;
    bool displaced_known = false;      ///< P', P's and N' have been calculated
    bool screen_normal_known = false;  ///< N's has been calculated
    std::uint16_t code = 0;            ///< d at t; 0 unless Formats::codes
    Position displaced;                ///< P'
    Direction displaced_normal;        ///< N', of the displaced surface, world space
    ScreenPosition screen;             ///< P's
    Direction screen_normal;           ///< N's
};

/// The tests of one edge, as bits; also a set of tests (split_by, stopped_by).
enum TestBits : std::uint8_t {
    normal_bit = 1,
    summed_height_bit = 2,  ///< or the test in its place (Formats::height_test)
    view_bit = 4,
    tex_coord_bit = 8,
    generation_bit = 16,
    highlight_bit = 32,
};

/// The requesting tests; the others are gating tests.
constexpr std::uint8_t requesting_tests = normal_bit | summed_height_bit | highlight_bit;
constexpr std::uint8_t gating_tests = view_bit | tex_coord_bit | generation_bit;
constexpr std::uint8_t all_tests = requesting_tests | gating_tests;

/// The tests' results for the midpoint of an edge that will be split.
struct TestedMidpoint {
    Direction normal;            ///< N_ij
    Direction tangent;           ///< T_ij
    Direction displaced_normal;  ///< N'_ij
};

/// A triangle in the Triangle Queue. Edge k runs from vertex k to vertex (k + 1) mod 3.
struct Triangle {
    std::array<Vertex, 3> vertices;
    std::uint32_t base = 0;     ///< index of the base triangle it descends from: for information only
    std::uint8_t split_by = 0;  ///< NT, SHT and HT bits of the parent's split edges; 0: a base triangle
    /// VT, TCT, GT bits: the tests that prevented a split requested by NT, SHT or HT.
    std::uint8_t stopped_by = 0;
    bool finished = false;  ///< no edge splits; one more pass calculates its normals in screen space
    /// Bit k: edge k was tested with the parent and not split, so it never will be. 0 unless Formats::final_edges
    /// or families.
    std::uint8_t final_edges = 0;
    std::uint32_t parent = 0;  ///< the pass in which its parent was split: for information only
    /// Formats::families: a triangle in the queue will be split; split_by and parent are those of its children.
    std::uint8_t split = 0;  ///< bit k: edge k
    std::array<TestedMidpoint, 3> midpoints{};
    /// Family design with a Rank Test. Bit k: edge k requested a split, but another was cut; it is tested again.
    std::uint8_t uncut = 0;
};

}  // namespace tessera::datapath

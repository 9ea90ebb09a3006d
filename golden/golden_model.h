#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "golden/golden_map.h"

/// ALGORITHM.md, sections 1 to 5, in double precision: the reference for the hardware. Written from that page alone; it
/// shares no code with the hardware model. Section numbers below refer to that page.
namespace tessera::golden {

/// Section 5: which diagonal divides the quadrilateral that remains when two edges split; with `greatest_rank` one edge
/// is cut at a time.
enum class Diagonal { shorter, first, second, greatest_rank };

/// The second diagonal is chosen only if it is shorter by more than this fraction of the first. Of two diagonals of
/// equal length the first is therefore chosen, whatever the rounding.
inline constexpr double diagonal_margin = 1.0 / 64;

/// Parameters from the mesh's author and the view. A disabled test counts as false (normal, summed height, highlight)
/// or as true (view, texture coordinate, generation).
struct Parameters {
    double scale = 0;  ///< world units per code; displacement = scale * code + bias
    double bias = 0;   ///< world units

    double normal_threshold = 0;  ///< difference of one component of two unit normals; the height test has its own
    glm::dvec3 eye{0};            ///< world
    /// Vertex distances are multiples of this (world units), radii sums of two of them. 0: neither exists.
    double distance_step = 0;
    double view_threshold = 0;  ///< pixels
    int generation_limit = 12;  ///< highest generation of an inserted vertex

    /// Section 4.6, the highlight test: the half vector between the directions to the light and to the viewer, both
    /// infinitely far; the cosine of the highlight's angle; the threshold on one component's difference of two normals.
    glm::dvec3 half_vector{0};
    double highlight_cosine = 1;
    double highlight_normal_threshold = 0;

    struct Enabled {
        /// summed_height: or the test that replaces it.
        bool normal = true, summed_height = true, view = true, tex_coord = true, generation = true, highlight = false;
    } enabled;

    Diagonal diagonal = Diagonal::shorter;

    Filter filter = Filter::nearest;  ///< section 2
    double texel_parts = 1;           ///< section 4.4: parts per texel and axis that the Tex Coord Test distinguishes

    /// Inserted texture coordinates are rounded down to multiples of this, in texels; 0: not rounded. Nothing else is
    /// rounded. At a texel's border the smallest difference in t selects another texel, so t must match the hardware's.
    double texture_step = 0;
    /// The mean of two directions is 0 if all its components are below half of this; 0: no such limit. The mean of
    /// opposite normals has no direction but that of its rounding error.
    double direction_step = 0;

    /// World to screen: with p = (P', 1) and w = dot(row_w, p), screen = (dot(row_x, p), dot(row_y, p)) / w
    /// in pixels; in front iff w > near_plane (>= 0). The default is a parallel view along z, one pixel per
    /// world unit.
    glm::dvec4 row_x{1, 0, 0, 0}, row_y{0, 1, 0, 0}, row_w{0, 0, 0, 1};
    double near_plane = 0;
};

/// Section 1. The first five members are given by the host, the others calculated.
struct Vertex {
    glm::dvec3 position{0};  ///< P, world, on the base surface
    glm::dvec3 normal{0};    ///< N, unit
    glm::dvec3 tangent{0};   ///< T, unit
    double handedness = 1;   ///< +1 or -1; bitangent = handedness * cross(N, T)
    glm::dvec2 texture{0};   ///< t, in texels

    glm::dvec3 displaced_position{0};  ///< P', world
    glm::dvec3 displaced_normal{0};    ///< N', world, unit
    glm::dvec2 screen{0};              ///< pixels; zero if not in front
    double w = 0;                      ///< the transform's w
    double distance = 0;               ///< D, from the eye; 0 if the height test uses none
    bool in_front = false;
    int generation = 0;  ///< 0: base vertex
};

/// A unit vector and its length before normalisation. The error of the direction is the input's error over that length.
/// **D** a zero vector stays zero.
struct Normalised {
    glm::dvec3 direction{0};
    double length = 0;
};
Normalised normalise(const glm::dvec3& v);

/// Section 3: N' = normalise(N_d.x * T + N_d.y * handedness * cross(N, T) + N_d.z * N).
Normalised bump(const glm::dvec3& normal, const glm::dvec3& tangent, double handedness, const glm::dvec3& map_normal);

/// Completes a base vertex with P', N' and screen position; generation 0.
Vertex complete_base_vertex(const Vertex& base, const Map& map, const Parameters& parameters);

/// Section 3: the vertex inserted on the edge (i,j), bit-identical for (j,i).
struct Insertion {
    Vertex vertex;
    double mean_normal_length = 0;   ///< |(N_i + N_j) / 2|
    double mean_tangent_length = 0;  ///< |(T_i + T_j) / 2|; T_ij is not made orthogonal to N_ij again
    double bump_length = 0;          ///< length of the sum inside bump()
};
Insertion insert_vertex(const Vertex& i, const Vertex& j, const Map& map, const Parameters& parameters);

/// Section 4: the values compared by the tests of an edge, and the results (`enabled` applied).
struct EdgeEvaluation {
    Insertion inserted;

    double normal_difference = 0;                            ///< largest of the six; NT = it > normal_threshold
    std::int64_t rectangle_width = 1, rectangle_height = 1;  ///< texels, all three rectangles
    double height = 0, height_limit = 0;  ///< SHT, or the test in its place, = height > it (HeightTest::Verdict)
    int order = 0;                        ///< likewise
    double view_length = 0;  ///< VT = it > view_threshold; Manhattan, pixels; +infinity if one end is not in
                             ///< front, -infinity if both are not
    /// Cosine between N' and the half vector: the greater of the two ends, and the midpoint's. HT = one of them >
    /// highlight_cosine and normal_difference > highlight_normal_threshold.
    double end_cosine = 0, midpoint_cosine = 0;

    /// summed_height_test: or the test that replaces it.
    bool normal_test = false, summed_height_test = false, view_test = false, tex_coord_test = false,
         generation_test = false, highlight_test = false;
    bool split = false;  ///< (NT or SHT or HT) and VT and TCT and GT
};
EdgeEvaluation evaluate_edge(const Vertex& i, const Vertex& j, const Map& map, const Parameters& parameters);

/// Section 5: 1 to 4 children as indices: 0 1 2 the triangle's vertices, 3 4 5 the midpoints of edges 0-1,
/// 1-2, 2-0.
///
/// Winding is kept, and an old vertex keeps its position in the children that share it:
///     none     (0 1 2)
///     one      edge 0-1: (0 3 2) (3 1 2)     edge 1-2: (0 1 4) (0 4 2)     edge 2-0: (0 1 5) (5 1 2)
///     two      the corner cut off, one of (0 3 5) (3 1 4) (5 4 2), then the quadrilateral q0 q1 q2 q3:
///              walk the boundary 0 3 1 4 2 5, leaving out the unsplit edge's midpoint and the corner
///              diagonal q0-q2: (q0 q1 q2) (q0 q2 q3)         diagonal q1-q3: (q0 q1 q3) (q1 q2 q3)
///     three    (0 3 5) (3 1 4) (5 4 2) (3 4 5)
/// `shorter` compares Manhattan lengths of displaced world positions: q1-q3 if it is shorter than q0-q2 by
/// more than the margin.
struct Subdivision {
    int count = 0;
    std::array<std::array<int, 3>, 4> children{};
};
Subdivision subdivide(const std::array<bool, 3>& split, const std::array<Vertex, 6>& vertices, Diagonal diagonal);

/// Section 5, `greatest_rank`: selects the edge to cut from those that request a split; none if `ask` is empty.
/// `order`: of the triangle's edges, in their order.
std::array<bool, 3> edge_to_cut(const std::array<bool, 3>& ask, const std::array<Vertex, 3>& triangle,
                                const std::array<int, 3>& order);

struct Triangle {
    std::array<Vertex, 3> vertices;
    std::size_t base_index = 0;
    int generation() const;  ///< the largest of its vertices'
};

struct Tessellation {
    std::uint64_t triangles_emitted = 0;
    std::uint64_t edges_evaluated = 0;  ///< three per triangle, emitted or split
    int largest_generation = 0;
    bool bound_hit = false;  ///< stopped early: the complete mesh has more triangles than `bound`
};

/// Sections 4 and 5: tessellates base triangles (the first five members of each vertex are read), depth first in the
/// children's order. Without the generation test the recursion may not end, so it stops when the number of triangles
/// emitted and waiting exceeds `bound`; each waiting triangle yields at least one of the mesh.
/// `bound` may change meanwhile.
Tessellation tessellate(const std::vector<std::array<Vertex, 3>>& base, const Map& map, const Parameters& parameters,
                        const std::atomic<std::uint64_t>& bound, const std::function<void(const Triangle&)>& emit);
Tessellation tessellate(const std::vector<std::array<Vertex, 3>>& base, const Map& map, const Parameters& parameters,
                        std::uint64_t bound, const std::function<void(const Triangle&)>& emit);

/// Manhattan length of a world-space vector.
double manhattan(const glm::dvec3& v);

/// Section 4.7: the distance used in place of the Euclidean length.
double eye_distance(const glm::dvec3& v);
/// Section 4.7: 4096 log2 of a distance, interpolated linearly between powers of two, rounded down.
double level(double distance);

}  // namespace tessera::golden

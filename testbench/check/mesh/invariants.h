#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"
#include "testbench/machine/emitted_mesh.h"

namespace tessera {

/// What the emitted mesh of any correct run must satisfy, counted on integers. No tolerance but those derived
/// here.
///
/// A *patch* is all that was emitted of one base triangle, culled triangles included. A vertex of a patch is
/// known by (P, t); a base edge by P of its two ends, so the two sides of a texture seam are one base edge.
/// Two sides of a base edge are *joined* if both ends agree in N, T and handedness, and in t but for whole
/// periods of a repeated axis: then the machine, deciding by edge alone, has to cut and displace both alike.
/// Sides that are not joined may come apart, and what comes apart there is the input's doing: its map, or its
/// normals, are not continuous there.
struct InvariantResult {
    // What was looked at.
    std::uint64_t triangles = 0;
    std::uint64_t base_triangles = 0;
    std::uint64_t base_edges = 0;               ///< distinct by P; those of zero length left out
    std::uint64_t border_base_edges = 0;        ///< of one base triangle
    std::uint64_t non_manifold_base_edges = 0;  ///< of more than two
    std::uint64_t texture_seams = 0;            ///< base edges whose sides differ in t: not joined
    std::uint64_t creases = 0;  ///< base edges whose sides agree in t but not in N, T: not joined

    // Violations: none in a correct run.
    /// Edges whole on one side whose midpoint is a vertex on the other: one for each such vertex.
    std::uint64_t t_vertices = 0;
    /// Other places, one emitted edge long, where the surface is not closed: an edge that does not have one
    /// triangle on each side (duplicated, missing, turned triangles), or whose two sides lie at different P'.
    std::uint64_t cracks = 0;
    /// Triangles emitted more than once.
    std::uint64_t duplicate_triangles = 0;
    /// Base triangles whose triangles' signed texture areas do not add up, exactly, to the area within their
    /// own subdivided border: some are missing or too many.
    std::uint64_t area_mismatches = 0;
    /// Base triangles whose subdivided border encloses an area further from their own than midpoints'
    /// rounding explains. A vertex d cuts deep on an edge is at most E = (2 d + 1) / 6 LSB off the straight
    /// line, from E_d <= (E_(d-1) + E_(d-2) + 1) / 2; so twice the area between an edge's n pieces and the
    /// edge is at most 2 E (|du| + |dv|) + n E^2. Guards datapath::midpoint itself, by which the border is walked.
    std::uint64_t areas_beyond_rounding = 0;
    std::uint64_t generation_violations = 0;  ///< vertices of triangles beyond the generation limit
    /// Vertices with one (P, t), but with different P', N' or generation in different triangles: of a patch,
    /// of two joined sides, or round a base vertex.
    std::uint64_t inconsistent_vertices = 0;
    std::uint64_t foreign_triangles = 0;  ///< name a base triangle that does not exist
    // and collapsed and turned over triangles that are not explained

    // Rounding's doing.
    std::uint64_t collapsed = 0;  ///< no area in texture space
    /// Of these: the base triangle itself has none; or it is thin, and rounding may have done it. With exact
    /// midpoints no triangle collapses or turns over: its corners have barycentric coordinates in steps of
    /// 2^-g, g the highest generation, so its area is at least 4^-g of the base triangle's. A rounded vertex
    /// is at most g / 2 LSB off, so the doubled area of a triangle with edges x, y is at most (g (|x| + |y|)
    /// + g^2) / 2 off (Manhattan lengths). Explained is what that can bring down to the area found; where P,
    /// seen along an axis, shows that more of the base triangle must be left than 4^-g, from that.
    std::uint64_t collapsed_explained = 0;
    std::uint64_t turned_over = 0;            ///< the texture area's sign is not the base triangle's
    std::uint64_t turned_over_explained = 0;  ///< likewise
    std::uint64_t displaced_collapsed = 0;    ///< two corners at one P'
    /// Vertices as inconsistent as above, but where collapsed or turned over triangles fold their patch both
    /// in t and in P (seen along an axis): there two different vertices can round to one (P, t).
    std::uint64_t coincident_vertices = 0;
    /// Edges of more than two triangles that still close in pairs; and pieces of joined base edges that do not seem to
    /// meet where such edges make it impossible to say which one it is.
    std::uint64_t coincident_edges = 0;

    // The input's doing: pieces of base edges whose sides are not joined, and do not meet. On the finer side.
    std::uint64_t open_texture_seam_edges = 0;
    std::uint64_t open_crease_edges = 0;

    /// The violation of lowest base triangle: what, where, P, P' in LSB, t in LSB and texels. Empty: none.
    std::string first_violation;

    bool passed() const { return violations() == 0; }
    std::uint64_t violations() const;
};

/// One figure of an InvariantResult, by name.
struct InvariantFigure {
    enum class Kind { fact, violation, rounding, input };
    const char* name;
    Kind kind;
    std::uint64_t value;
    const char* unit;
    const char* description;
};

/// All figures, in the struct's order.
std::vector<InvariantFigure> invariant_figures(const InvariantResult& result);

/// Checks a whole emitted mesh, in any order. `registers` are those it was made with: map size and addressing,
/// generation limit, fraction bits.
/// Per million triangles about 1 s and, beyond the mesh, 20 to 65 MB (the more, the fewer base triangles they come
/// of). A base mesh of a million triangles takes 2 s and 170 MB.
/// ResourceError beyond 700 million triangles.
InvariantResult check_invariants(const EmittedMesh& mesh,
                                 const std::vector<datapath::Triangle>& base_triangles,
                                 const datapath::Registers& registers);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// What must hold of the mesh of any run, on integers, with no tolerance:
///   - it is the mesh that the datapath by itself makes of the same setup (BareRecursion): the same triangles, bit for
///     bit, in any order (emitted_difference.h);
///   - that mesh is closed, by descent (lineage.h): no cracks, no T-vertices, no vertex that differs from one
///     triangle to another.
/// That the datapath's values and decisions are the right ones is the scoreboard's to say.
struct InvariantResult {
    // What was looked at.
    std::uint64_t triangles = 0;  ///< emitted, culled ones included
    std::uint64_t edges = 0;      ///< evaluated by the datapath by itself
    std::uint64_t base_triangles = 0;
    std::uint64_t base_edges = 0;               ///< distinct by P; those of zero length left out
    std::uint64_t border_base_edges = 0;        ///< of one base triangle
    std::uint64_t non_manifold_base_edges = 0;  ///< of more than two
    std::uint64_t texture_seams = 0;  ///< base edges whose sides differ in t by other than whole periods: not joined
    std::uint64_t creases = 0;        ///< base edges whose sides agree in t but not in N, T: not joined

    // Violations: none in a correct run.
    std::uint64_t t_vertices = 0;
    std::uint64_t cracks = 0;
    std::uint64_t inconsistent_vertices = 0;
    std::uint64_t missing_triangles = 0;
    std::uint64_t extra_triangles = 0;
    std::uint64_t differing_triangles = 0;    ///< one missing and one extra at the same three (P, t)
    std::uint64_t generation_violations = 0;  ///< triangles with a vertex beyond the generation limit
    std::uint64_t unfinished = 0;  ///< 1: the datapath's own recursion went on far beyond this mesh, and was cut off

    // Rounding's doing, to thin triangles: it opens nothing.
    std::uint64_t collapsed = 0;            ///< no area in texture space
    std::uint64_t turned_over = 0;          ///< the texture area's sign is not the base triangle's
    std::uint64_t displaced_collapsed = 0;  ///< two corners at one P'

    // Caused by the input: pieces of texture seams and creases that do not meet, counted on the finer side.
    std::uint64_t open_texture_seam_edges = 0;
    std::uint64_t open_crease_edges = 0;

    /// The first violation, as text: one in the datapath's own mesh before a difference of the emitted one. Empty:
    /// none.
    std::string first_violation;

    bool passed() const { return violations() == 0; }
    std::uint64_t violations() const;
    std::uint64_t wrong_triangles() const { return missing_triangles + extra_triangles + differing_triangles; }
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

/// Checks a whole emitted mesh, in any order, against the setup it was made of, whose base triangles are numbered in
/// their order (make_setup does).
/// Where the datapath's own recursion is far longer than the mesh explains, it is cut off: a violation; cracks are then
/// not known.
/// Memory beyond the mesh: 4 bytes a triangle, 150 a triangle of the base triangle that has most, 200 a base triangle,
/// 12 a texel. ResourceError beyond 2^32 - 2 triangles.
InvariantResult check_invariants(const EmittedMesh& mesh, const MachineSetup& setup);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Invariants of every run's mesh, checked on integers without tolerance:
///   - it equals the mesh that the bare datapath makes of the same setup (BareRecursion): the same triangles, bit for
///     bit, in any order (emitted_difference.h);
///   - that mesh is closed, by descent (lineage.h): no cracks, no T-vertices, and each vertex is the same in all
///     triangles.
/// The scoreboard checks that the datapath's values and decisions are correct.
struct InvariantResult {
    // Extent of the check.
    std::uint64_t triangles = 0;  ///< emitted, culled ones included
    std::uint64_t edges = 0;      ///< evaluated by the bare datapath
    std::uint64_t base_triangles = 0;
    std::uint64_t base_edges = 0;               ///< distinct by P; edges of zero length excluded
    std::uint64_t border_base_edges = 0;        ///< of one base triangle
    std::uint64_t non_manifold_base_edges = 0;  ///< of more than two
    /// Base edges whose sides are not joined: texture seams agree in N, but t differs by other than whole periods; the
    /// others are creases.
    std::uint64_t texture_seams = 0, creases = 0;

    // Violations: 0 in a correct run.
    std::uint64_t t_vertices = 0;
    std::uint64_t cracks = 0;
    std::uint64_t inconsistent_vertices = 0;
    std::uint64_t missing_triangles = 0;
    std::uint64_t extra_triangles = 0;
    std::uint64_t differing_triangles = 0;    ///< one missing and one extra at the same three (P, t)
    std::uint64_t generation_violations = 0;  ///< triangles with a vertex beyond the generation limit
    std::uint64_t unfinished = 0;  ///< 1: the bare datapath's recursion continued far beyond this mesh and was stopped

    // Effects of rounding on thin triangles; they open no gaps.
    std::uint64_t collapsed = 0;            ///< no area in texture space
    std::uint64_t turned_over = 0;          ///< the sign of the texture area differs from the base triangle's
    std::uint64_t displaced_collapsed = 0;  ///< two corners have the same P'

    // Caused by the input: pieces of texture seams and creases that do not meet, counted on the finer side.
    std::uint64_t open_texture_seam_edges = 0;
    std::uint64_t open_crease_edges = 0;
    std::uint64_t open_crease_edges_of_seams = 0;  ///< of these, where t differs as well

    /// Text of the first violation; one in the bare datapath's mesh precedes differences of the emitted mesh. Empty if
    /// none.
    std::string first_violation;

    bool empty() const { return triangles == 0 || edges == 0; }
    bool passed() const { return !empty() && violations() == 0; }
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

/// Checks a whole emitted mesh, in any order, against its setup. Base triangles are numbered in the setup's order (as
/// by make_setup). If the bare datapath's recursion is far longer than the mesh explains, it is stopped: a violation,
/// and cracks are then unknown. Memory beyond the mesh: 4 bytes per triangle, 150 per triangle of the largest base
/// triangle, 200 per base triangle, 12 per texel. ResourceError beyond 2^32 - 2 triangles.
InvariantResult check_invariants(const EmittedMesh& mesh, const MachineSetup& setup);

}  // namespace tessera

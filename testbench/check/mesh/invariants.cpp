#include "testbench/check/mesh/invariants.h"

#include <fmt/core.h>

#include <algorithm>

#include "testbench/check/mesh/corner_text.h"
#include "testbench/check/mesh/emitted_difference.h"
#include "testbench/check/mesh/lineage.h"
#include "testbench/machine/bare_recursion.h"

namespace tessera {

namespace {

__extension__ using Wide = __int128;

/// The sign of the triangle's area in texture space.
template <class HasTexture>
int texture_side(const std::array<HasTexture, 3>& c) {
    const auto u = [&](std::size_t k) { return Wide{c[k].texture.u} - c[0].texture.u; };
    const auto v = [&](std::size_t k) { return Wide{c[k].texture.v} - c[0].texture.v; };
    const Wide doubled_area = u(1) * v(2) - v(1) * u(2);
    return doubled_area > 0 ? 1 : (doubled_area < 0 ? -1 : 0);
}

/// Checks each triangle on its own.
void judge_triangles(const EmittedMesh& mesh, const MachineSetup& setup, InvariantResult& result) {
    const datapath::TestParameters& tests = setup.registers.tests;
    std::vector<std::int8_t> base_sides;
    for (const datapath::Triangle& base : setup.base_triangles)
        base_sides.push_back(static_cast<std::int8_t>(texture_side(base.vertices)));
    for (const EmittedTriangle& triangle : mesh.triangles) {
        const auto& c = triangle.corners;
        const int side = texture_side(c);
        if (side == 0)
            ++result.collapsed;
        else if (triangle.base < base_sides.size() && side * base_sides[triangle.base] < 0)
            ++result.turned_over;
        if (c[0].displaced == c[1].displaced || c[1].displaced == c[2].displaced || c[2].displaced == c[0].displaced)
            ++result.displaced_collapsed;
        const auto oldest = std::max_element(c.begin(), c.end(),
                                             [](const auto& a, const auto& b) { return a.generation < b.generation; });
        if (tests.generation_test && oldest->generation > tests.generation_limit) {
            ++result.generation_violations;
            if (result.first_violation.empty())
                result.first_violation =
                    fmt::format("base triangle {}: a vertex is beyond the generation limit of {}: {}", triangle.base,
                                tests.generation_limit, corner_text(*oldest, setup.registers.formats));
        }
    }
}

/// One walk for both checks: that the mesh is closed, and that it is the emitted mesh.
struct Walk {
    using Note = Lineage::Note;
    Lineage lineage;
    EmittedDifference difference;
    bool begun = false;

    void end() {
        if (begun)
            difference.end();
    }
    Note begin(const datapath::Triangle& base) {
        end();
        begun = true;
        difference.begin(base.base);
        return lineage.begin(base);
    }
    void decided(const datapath::TrianglePass& pass, const datapath::ChildIndices& children, const Note& note) {
        lineage.decided(pass, children, note);
    }
    Note child(const std::array<std::uint8_t, 3>& corners) { return lineage.child(corners); }
    void finished(const datapath::Triangle& triangle, bool culled) {
        difference.expect(EmittedTriangle::from(triangle, culled));
    }
};

}  // namespace

std::uint64_t InvariantResult::violations() const {
    return t_vertices + cracks + inconsistent_vertices + wrong_triangles() + generation_violations + unfinished;
}

std::vector<InvariantFigure> invariant_figures(const InvariantResult& r) {
    using Kind = InvariantFigure::Kind;
    return {
        {"triangles", Kind::fact, r.triangles, "triangle", "checked, culled ones included"},
        {"edges", Kind::fact, r.edges, "edge", "evaluated by the bare datapath"},
        {"base_triangles", Kind::fact, r.base_triangles, "triangle", "of the base mesh"},
        {"base_edges", Kind::fact, r.base_edges, "edge", "of the base mesh, by position"},
        {"border_base_edges", Kind::fact, r.border_base_edges, "edge", "of these, with one base triangle"},
        {"non_manifold_base_edges", Kind::fact, r.non_manifold_base_edges, "edge", "of these, with more than two"},
        {"texture_seams", Kind::fact, r.texture_seams, "edge",
         "base edges whose two sides have the same normals, but texture coordinates that differ, not by whole periods"},
        {"creases", Kind::fact, r.creases, "edge", "base edges whose two sides differ in normal, or in tangent only"},
        {"t_vertices", Kind::violation, r.t_vertices, "vertex",
         "on an edge that another of its triangles does not split"},
        {"cracks", Kind::violation, r.cracks, "edge", "without the expected triangles on either side"},
        {"inconsistent_vertices", Kind::violation, r.inconsistent_vertices, "vertex", "that differ between triangles"},
        {"missing_triangles", Kind::violation, r.missing_triangles, "triangle",
         "made by the bare datapath, but not emitted by the machine"},
        {"extra_triangles", Kind::violation, r.extra_triangles, "triangle",
         "emitted, but not made by the bare datapath"},
        {"differing_triangles", Kind::violation, r.differing_triangles, "triangle",
         "emitted in their place, but not bit-identical"},
        {"generation_violations", Kind::violation, r.generation_violations, "triangle",
         "with a vertex beyond the generation limit"},
        {"unfinished", Kind::violation, r.unfinished, "run",
         "1: the bare datapath kept splitting far beyond this mesh and was stopped"},
        {"collapsed", Kind::rounding, r.collapsed, "triangle", "no area in texture space"},
        {"turned_over", Kind::rounding, r.turned_over, "triangle", "turned over in texture space"},
        {"displaced_collapsed", Kind::rounding, r.displaced_collapsed, "triangle",
         "two corners at one displaced position"},
        {"open_texture_seam_edges", Kind::input, r.open_texture_seam_edges, "edge",
         "emitted edges along texture seams that do not meet: the map, or a table made from it, is not continuous there"},
        {"open_crease_edges", Kind::input, r.open_crease_edges, "edge",
         "likewise along creases: the base mesh's normals or tangents are not continuous"},
        {"open_crease_edges_of_seams", Kind::input, r.open_crease_edges_of_seams, "edge",
         "of these, where texture coordinates differ as well, so that the map may open the edge too"},
    };
}

InvariantResult check_invariants(const EmittedMesh& mesh, const MachineSetup& setup) {
    BareRecursion bare(setup);
    Walk walk{Lineage(setup, bare), EmittedDifference(mesh, setup.base_triangles.size(), setup.registers.formats)};
    // A machine's N triangles take fewer than 6 N edges. If the emitted mesh is wrong, the datapath's recursion may not
    // end.
    const std::uint64_t most_edges = 24 * mesh.triangles.size() + 3'000'000;
    const std::uint64_t edges = bare.walk(walk, most_edges);
    walk.end();
    const bool finished = edges < most_edges;
    InvariantResult result = finished ? walk.lineage.finish() : InvariantResult{};
    result.triangles = mesh.triangles.size();
    result.edges = edges;
    result.base_triangles = setup.base_triangles.size();
    result.missing_triangles = walk.difference.missing();
    result.extra_triangles = walk.difference.extra();
    result.differing_triangles = walk.difference.differing();
    result.unfinished = finished ? 0 : 1;
    if (result.first_violation.empty())
        result.first_violation = walk.difference.first();
    if (!finished && result.first_violation.empty())
        result.first_violation = fmt::format("the bare datapath had not finished after {} edges", result.edges);
    judge_triangles(mesh, setup, result);
    return result;
}

}  // namespace tessera

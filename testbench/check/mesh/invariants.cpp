#include "testbench/check/mesh/invariants.h"

#include <algorithm>
#include <string>

#include "testbench/check/mesh/base_edge_check.h"
#include "testbench/check/mesh/patch_check.h"
#include "testbench/common/error.h"

namespace tessera {
namespace {

constexpr std::size_t most_triangles = 700'000'000;  // corner numbers, doubled, fit 32 bits

/// The triangles' indices, by base triangle, in the mesh's order. offsets[b]: where those of base triangle b
/// begin.
struct Patches {
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> offsets;
};

Patches sort_into_patches(const EmittedMesh& mesh, std::size_t base_triangles) {
    Patches result;
    result.offsets.assign(base_triangles + 2, 0);
    for (const EmittedTriangle& triangle : mesh.triangles)
        if (triangle.base < base_triangles)
            ++result.offsets[triangle.base + 2];
    for (std::size_t b = 2; b < result.offsets.size(); ++b)
        result.offsets[b] += result.offsets[b - 1];
    result.order.resize(result.offsets.back());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (mesh.triangles[i].base < base_triangles)
            result.order[result.offsets[mesh.triangles[i].base + 1]++] = static_cast<std::uint32_t>(i);
    return result;
}

}  // namespace

std::uint64_t InvariantResult::violations() const {
    return t_vertices + cracks + duplicate_triangles + area_mismatches + areas_beyond_rounding +
           generation_violations + inconsistent_vertices + foreign_triangles +
           (collapsed - collapsed_explained) + (turned_over - turned_over_explained);
}

std::vector<InvariantFigure> invariant_figures(const InvariantResult& r) {
    using Kind = InvariantFigure::Kind;
    return {
        {"triangles", Kind::fact, r.triangles, "triangle", "looked at, culled ones included"},
        {"base_triangles", Kind::fact, r.base_triangles, "triangle", "of the base mesh"},
        {"base_edges", Kind::fact, r.base_edges, "edge", "of the base mesh, by position"},
        {"border_base_edges", Kind::fact, r.border_base_edges, "edge", "of these with one base triangle"},
        {"non_manifold_base_edges", Kind::fact, r.non_manifold_base_edges, "edge", "with more than two"},
        {"texture_seams", Kind::fact, r.texture_seams, "edge",
         "base edges whose two sides differ in texture coordinates by other than whole periods"},
        {"creases", Kind::fact, r.creases, "edge",
         "base edges whose two sides differ in normal or tangent only"},
        {"t_vertices", Kind::violation, r.t_vertices, "vertex", "on an edge that its other side has whole"},
        {"cracks", Kind::violation, r.cracks, "edge",
         "other places where the surface is not closed: an edge without one triangle on each side, or whose "
         "sides lie "
         "at different displaced positions"},
        {"duplicate_triangles", Kind::violation, r.duplicate_triangles, "triangle", "emitted more than once"},
        {"area_mismatches", Kind::violation, r.area_mismatches, "triangle",
         "base triangles whose triangles' texture areas do not add up exactly to what their border encloses"},
        {"areas_beyond_rounding", Kind::violation, r.areas_beyond_rounding, "triangle",
         "base triangles whose subdivided border encloses another area than they do, by more than rounding "
         "explains"},
        {"generation_violations", Kind::violation, r.generation_violations, "triangle",
         "with a vertex beyond the generation limit"},
        {"inconsistent_vertices", Kind::violation, r.inconsistent_vertices, "vertex",
         "different displaced position, normal or generation in different triangles"},
        {"foreign_triangles", Kind::violation, r.foreign_triangles, "triangle",
         "of a base triangle that does not exist"},
        {"collapsed_unexplained", Kind::violation, r.collapsed - r.collapsed_explained, "triangle",
         "no texture area, and rounding does not explain it"},
        {"turned_over_unexplained", Kind::violation, r.turned_over - r.turned_over_explained, "triangle",
         "turned over in texture space, and rounding does not explain it"},
        {"collapsed", Kind::rounding, r.collapsed, "triangle", "no area in texture space"},
        {"collapsed_explained", Kind::rounding, r.collapsed_explained, "triangle",
         "of these: the base triangle has none either, or it is thinner than midpoints' rounding"},
        {"turned_over", Kind::rounding, r.turned_over, "triangle", "turned over in texture space"},
        {"turned_over_explained", Kind::rounding, r.turned_over_explained, "triangle",
         "of these: thinner than midpoints' rounding"},
        {"displaced_collapsed", Kind::rounding, r.displaced_collapsed, "triangle",
         "two corners at one displaced position"},
        {"coincident_vertices", Kind::rounding, r.coincident_vertices, "vertex",
         "on collapsed or turned over triangles: different vertices rounded to one position and texture "
         "coordinate"},
        {"coincident_edges", Kind::rounding, r.coincident_edges, "edge",
         "of more than two triangles, which still close in pairs, or cannot be told apart"},
        {"open_texture_seam_edges", Kind::input, r.open_texture_seam_edges, "edge",
         "emitted edges along texture seams that do not meet: the map is not continuous across the seam"},
        {"open_crease_edges", Kind::input, r.open_crease_edges, "edge",
         "likewise along creases: the base mesh's normals or tangents are not continuous"},
    };
}

InvariantResult check_invariants(const EmittedMesh& mesh,
                                 const std::vector<datapath::Triangle>& base_triangles,
                                 const datapath::Registers& registers) {
    if (std::max(mesh.triangles.size(), base_triangles.size()) > most_triangles)
        throw ResourceError("check.invariants: cannot check more than " + std::to_string(most_triangles) +
                            " triangles; set it to false for a run of this size");
    InvariantResult result;
    FirstViolation first;
    result.triangles = mesh.triangles.size();
    result.base_triangles = base_triangles.size();

    BaseEdgeChains chains(base_triangles.size());
    {
        const Patches patches = sort_into_patches(mesh, base_triangles.size());
        result.foreign_triangles = mesh.triangles.size() - patches.order.size();
        PatchCheck check(mesh, base_triangles, registers, result, first, chains);
        for (std::uint32_t base = 0; base < base_triangles.size(); ++base)
            check.check(base, patches.order.data() + patches.offsets[base],
                        patches.offsets[base + 1] - patches.offsets[base]);
    }
    check_base_edges(mesh, base_triangles, registers, chains, result, first);
    if (result.foreign_triangles > 0)
        first.offer(base_triangles.size(), [&] {
            const auto stray =
                std::find_if(mesh.triangles.begin(), mesh.triangles.end(),
                             [&](const auto& triangle) { return triangle.base >= base_triangles.size(); });
            return "a triangle names base triangle " + std::to_string(stray->base) + ", of " +
                   std::to_string(base_triangles.size());
        });
    result.first_violation = first.text();
    return result;
}

}  // namespace tessera

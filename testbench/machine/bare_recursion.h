#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "modules/datapath/cull.h"
#include "modules/datapath/height_tests.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/tessellate.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// The datapath without SystemC: the same functions on the same tables, called in one loop over a work list. It bounds
/// the speed of a simulation of the machine; its mesh is the pipeline's, bit for bit (checked in every run).
class BareRecursion {
  public:
    /// `setup` must outlive it. Later changes of its thresholds count, those of its tables do not.
    explicit BareRecursion(const MachineSetup& setup);

    /// Counts so far. The machine normalises N_ij in two units and counts each; Lighting is not part of this.
    const datapath::Saturations& saturations() const { return saturations_; }

    /// Tessellates every base triangle; returns the number of edges evaluated. `mesh` is cleared first, but keeps its
    /// memory. Stops after `most_edges` edges, with the mesh incomplete.
    std::uint64_t run(EmittedMesh& mesh, std::uint64_t most_edges = UINT64_MAX);

    /// The same with a visitor: depth first, one base triangle after another. Returns the number of edges evaluated. A
    /// Visitor has
    ///   Note                  a type: data stored with each waiting triangle
    ///   Note begin(base)      for a base triangle, its vertices complete
    ///   void decided(pass, children, note)  for every pass, all its edges decided; `children` as returned by
    ///                         datapath::triangulate: the triangle itself if no edge is split
    ///   Note child(corners)   for each child of that pass; corners: one of children's
    ///   void finished(triangle, culled)     for each triangle that is not split, complete
    template <class Visitor>
    std::uint64_t walk(Visitor& visitor, std::uint64_t most_edges = UINT64_MAX);

    /// Completes a base triangle's vertices as the machine does in its first pass.
    void complete_base(datapath::Triangle& triangle);
    /// Evaluates edge k, and decides it by the setup's registers, without the Highlight Test.
    void evaluate_edge(datapath::TrianglePass& pass, int k);
    /// Evaluates all edges with every test, pass.split, and the tests that kept edges whole (Triangle::stopped_by).
    void evaluate(datapath::TrianglePass& pass);
    /// What the design's height test makes of an edge, on or off.
    datapath::HeightDecision test_heights(const datapath::HeightEdge& edge) const;

  private:
    datapath::ChildIndices children_of(const datapath::TrianglePass& pass) const;
    void transform_normals(datapath::Triangle& triangle);
    datapath::Direction map_normal_at(const datapath::TexCoord& t) const;
    std::uint32_t code_at(const datapath::TexCoord& t) const;
    /// The map's entries that are read at t (datapath::map_entries).
    template <class Entry>
    std::array<std::uint64_t, 4> entries_at(const datapath::TexCoord& t, const datapath::TableLayout& layout,
                                            const std::vector<Entry>& map) const;

    const MachineSetup& setup_;
    std::vector<std::uint64_t> normals_;  // packed as in the normal map
    const datapath::HeightTestFunctions& height_test_;
    std::vector<unsigned char> height_table_;  // as in the memory; 8 bytes more, since an entry is read as 8 bytes
    std::uint64_t height_entry_mask_ = 0;
    datapath::Saturations saturations_;
};

template <class Visitor>
std::uint64_t BareRecursion::walk(Visitor& visitor, std::uint64_t most_edges) {
    struct Waiting {
        datapath::Triangle triangle;
        typename Visitor::Note note;
    };
    const datapath::Registers& r = setup_.registers;
    std::vector<Waiting> waiting;
    datapath::TrianglePass pass;
    std::uint64_t edges = 0;
    for (datapath::Triangle base : setup_.base_triangles) {
        complete_base(base);
        waiting.push_back({base, visitor.begin(base)});
        pass.new_vertices = 7;
        while (!waiting.empty()) {
            if (edges >= most_edges)
                return edges;
            pass.triangle = waiting.back().triangle;
            const typename Visitor::Note note = waiting.back().note;
            waiting.pop_back();
            evaluate(pass);
            edges += 3;
            const datapath::ChildIndices children = children_of(pass);
            visitor.decided(pass, children, note);
            pass.new_vertices = 0;
            if (pass.split != 0) {
                std::size_t number = 0;
                datapath::tessellate(pass, r.triangulation, r.formats, saturations_,
                                     [&](const datapath::Triangle& child) {
                                         waiting.push_back({child, visitor.child(children.children[number++])});
                                     });
                continue;
            }
            transform_normals(pass.triangle);
            const auto& v = pass.triangle.vertices;
            visitor.finished(pass.triangle,
                             r.back_face_culling && datapath::faces_away(v[0].screen, v[1].screen, v[2].screen));
        }
    }
    return edges;
}

}  // namespace tessera

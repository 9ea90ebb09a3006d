#pragma once
#include <cstdint>
#include <cstring>
#include <vector>

#include "modules/datapath/cull.h"
#include "modules/datapath/tessellate.h"
#include "testbench/machine/bare_edges.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// The datapath without SystemC: the same functions on the same tables, called in one loop over a work list. It bounds
/// the speed of a simulation of the machine; its mesh is the pipeline's, bit for bit (checked in every run).
class BareRecursion : public BareEdges<BareRecursion> {
  public:
    /// `setup` must outlive it. Later changes of its thresholds count, those of its tables do not.
    explicit BareRecursion(const MachineSetup& setup);

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

    const datapath::Registers& scene_registers() const { return setup_.registers; }
    std::uint64_t code_entry(std::uint64_t index) const { return setup_.heights()[index]; }
    std::uint64_t normal_entry(std::uint64_t index) const { return normals_[index]; }
    std::uint64_t height_entry(std::uint64_t offset) const {
        static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "tables are read as their bytes lie in memory");
        std::uint64_t entry = 0;
        std::memcpy(&entry, &height_table_[offset], sizeof entry);
        return entry & height_entry_mask_;
    }

  private:
    datapath::ChildIndices children_of(const datapath::TrianglePass& pass) const;
    void transform_normals(datapath::Triangle& triangle);

    const MachineSetup& setup_;
    std::vector<std::uint64_t> normals_;       // packed as in the normal map
    std::vector<unsigned char> height_table_;  // as in the memory; 8 bytes more, since an entry is read as 8 bytes
    std::uint64_t height_entry_mask_ = 0;
};

extern template class BareEdges<BareRecursion>;

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
                datapath::tessellate(pass, r.triangulation, r.formats, saturations,
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

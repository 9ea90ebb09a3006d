#pragma once
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// The datapath without SystemC: the same functions on the same tables, called from one loop over a work list. What a
/// simulation of the machine cannot be faster than; its mesh is the pipeline's, bit for bit (tested).
class BareRecursion {
  public:
    /// `setup` must outlive it.
    explicit BareRecursion(const MachineSetup& setup);

    /// So far. The machine normalises N_ij in two units and counts there twice; Lighting is not part of this.
    const datapath::Saturations& saturations() const { return saturations_; }

    /// Tessellates every base triangle; returns the edges evaluated. `mesh` is cleared first, its memory
    /// kept. Gives up, the mesh incomplete, once `most_edges` have been.
    std::uint64_t run(EmittedMesh& mesh, std::uint64_t most_edges = UINT64_MAX);

    /// Its parts, for who walks in another way. What the machine does to a base triangle's vertices on its first pass:
    void complete_base(datapath::Triangle& triangle);
    /// All that a pass finds out about edge k, and decides by the setup's registers; the Highlight Test is not in it.
    void evaluate_edge(datapath::TrianglePass& pass, int k);
    /// All three edges with every test, and pass.split. Returns the tests that kept edges whole (Triangle::stopped_by).
    std::uint8_t evaluate(datapath::TrianglePass& pass);
    /// The Summed Height Test's sum of the map's codes.
    std::uint64_t sum_around(const datapath::TexCoord& t, const datapath::RectangleSize& size) const;

  private:
    datapath::Direction map_normal_at(const datapath::TexCoord& t) const;
    std::uint32_t code_at(const datapath::TexCoord& t) const;

    const MachineSetup& setup_;
    std::vector<std::uint16_t> codes_;
    std::vector<std::uint64_t> normals_;  // packed as the normal map's entries
    std::vector<std::uint32_t> sums_;     // narrow tables; else wide_sums_
    std::vector<std::uint64_t> wide_sums_;
    std::vector<datapath::Triangle> work_;
    datapath::Saturations saturations_;
};

}  // namespace tessera

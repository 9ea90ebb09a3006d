#pragma once
#include <cstdint>
#include <optional>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/datapath/height_tests.h"
#include "modules/datapath/triangle_pass.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// The result of every test on every edge of a pass, for reports and the mesh file: byte for byte the same in all
/// designs. Where the machine does not evaluate a test (Design::test_order, Formats::final_edges), this calls the
/// datapath, which takes no cycles.
class Decisions : public tlm::tlm_analysis_if<datapath::TrianglePass> {
  public:
    struct Counts {
        std::uint64_t split_by_normal = 0;         ///< NT, not SHT
        std::uint64_t split_by_summed_height = 0;  ///< SHT, not NT
        std::uint64_t split_by_both = 0;           ///< NT and SHT
        std::uint64_t split_by_highlight = 0;      ///< neither: HT alone
        std::uint64_t split_in_highlight = 0;      ///< HT, whatever NT and SHT say
        std::uint64_t stopped_by_view = 0;         ///< NT, SHT or HT would split, VT is false
        std::uint64_t stopped_by_tex_coord = 0;    ///< likewise TCT
        std::uint64_t stopped_by_generation = 0;   ///< likewise GT
        std::uint64_t stopped_by_view_alone = 0;   ///< of these: TCT and GT are true
        std::uint64_t stopped_by_tex_coord_alone = 0;
        std::uint64_t stopped_by_generation_alone = 0;
        std::uint64_t stopped_by_several = 0;
    };
    /// Number of edges for which the machine evaluated a test.
    struct Evaluated {
        std::uint64_t normal = 0;
        std::uint64_t summed_height = 0;
        std::uint64_t summed_height_by_codes = 0;  ///< of these: by codes of the displacement map
        std::uint64_t off_lattice = 0;             ///< of these: with a Rank Test, without a read
    };

    /// `setup` must outlive it.
    explicit Decisions(const MachineSetup& setup);

    /// Call for every decided pass (PassOrTessellate::decided).
    void write(const datapath::TrianglePass& pass) override;

    const Counts& counts() const { return counts_; }
    const Evaluated& evaluated() const { return evaluated_; }

    /// Completes split_by and stopped_by of an emitted triangle, whose last pass has been decided.
    void complete_tags(const datapath::Triangle& finished, EmittedTriangle& emitted);

  private:
    void count(const datapath::TrianglePass& pass);
    void count(std::uint8_t tests);
    void count_reads(const datapath::TrianglePass& pass, int edge);
    void evaluate(datapath::TrianglePass& pass);
    std::uint8_t& stopped_by(const datapath::Triangle& triangle);

    const datapath::Registers& registers_;
    const datapath::HeightTestFunctions& height_test_;
    const bool reads_vary_;               // some edges read the displacement map, or nothing
    std::optional<BareRecursion> bare_;   // absent if the machine evaluates every test of every edge
    std::vector<std::uint8_t> split_by_;  // of each pass that split its triangle, by number
    Counts counts_;
    Evaluated evaluated_;
    std::vector<std::uint8_t> stopped_by_;  // of the triangle decided last, and of each base triangle
};

}  // namespace tessera

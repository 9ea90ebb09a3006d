#pragma once
#include <cstdint>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/units/lighting.h"

namespace tessera {

/// What the work check found.
struct WorkResult {
    std::uint64_t triangles = 0;  ///< decided
    std::uint64_t equations = 0;  ///< of conservation.h
    std::uint64_t violations =
        0;  ///< of these, base triangles whose work does not add up, and single findings
    std::string first_violation;  ///< empty: none

    bool passed() const { return violations == 0; }
};

/// Work is neither lost, nor doubled, nor altered on its way: what is to come follows from what was decided before, and
/// has to come exactly once, every bit as it left.
///
///   decided   a base triangle as the host has it, and each child of a decided triangle
///   finished  each triangle that was decided and not split
///   lit       each finished triangle that is not culled; its N's are transformed N', its intensities lit N's
///
/// Kept as sums of 64-bit hashes, expected minus come, one for each base triangle and for all that is lit: no table of
/// triangles. Differences cancel by chance once in 2^64. The scoreboard judges what was decided; this, that it was
/// decided from what it should have been. Children and light are the datapath's own: unit tests hold these.
/// Cost: some 70 ns an edge, an eighth of the scoreboard's.
class TransportCheck : public tlm::tlm_analysis_if<datapath::TrianglePass>,
                       public tlm::tlm_analysis_if<datapath::Triangle>,
                       public tlm::tlm_analysis_if<LitTriangle> {
  public:
    TransportCheck(const datapath::Registers& registers,
                   const std::vector<datapath::Triangle>& base_triangles);

    void write(const datapath::TrianglePass& pass) override;
    void write(const datapath::Triangle& finished) override;
    void write(const LitTriangle& lit) override;

    /// After a run that drained.
    WorkResult result() const;

  private:
    struct Balance {
        std::uint64_t sum = 0;   // of hashes
        std::int64_t count = 0;  // expected minus come
        void expect(std::uint64_t hash) {
            sum += hash;
            ++count;
        }
        void come(std::uint64_t hash) {
            sum -= hash;
            --count;
        }
        bool even() const { return sum == 0 && count == 0; }
    };
    struct Base {
        Balance decided;
        Balance finished;
    };

    Base& base_of(std::uint32_t base);
    void finding(const std::string& what);

    datapath::Registers registers_;
    std::vector<Base> bases_;
    Base foreign_;
    Balance lit_;
    datapath::Saturations counted_by_the_unit_;  // once more, and not looked at
    WorkResult result_;
};

}  // namespace tessera

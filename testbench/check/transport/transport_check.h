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

/// The transport check's result.
struct WorkResult {
    std::uint64_t triangles = 0;  ///< decided
    std::uint64_t equations = 0;  ///< of conservation.h
    std::uint64_t violations =
        0;  ///< failed equations, base triangles whose hash sums are not zero, and single findings
    std::string first_violation;  ///< empty: none

    bool empty() const { return triangles == 0; }
    bool passed() const { return !empty() && violations == 0; }
};

/// Checks that no triangle is lost, duplicated or altered between units. The expected triangles follow from earlier
/// decisions, and each must arrive exactly once with every bit unchanged.
///
///   decided   a base triangle as the host sends it, and each child of a decided triangle
///   split     with families, each triangle that was decided and split, as it returns from the queue
///   finished  each triangle that was decided and not split
///   lit       each finished triangle that is not culled; its N's is the transformed N', its intensities those of N's
///
/// Keeps sums of 64-bit hashes, expected minus arrived, per base triangle and one for all lit triangles, instead of a
/// table of triangles. Differences cancel with a probability of 2^-64. The scoreboard checks the decisions; this checks
/// that their inputs are right. Children and light come from the datapath's functions, which have unit tests.
/// Cost: about 90 ns per edge, a sixth of the scoreboard's.
///
/// Passes may be written by one thread, finished and lit triangles by another.
class TransportCheck : public tlm::tlm_analysis_if<datapath::TrianglePass>,
                       public tlm::tlm_analysis_if<datapath::Triangle>,
                       public tlm::tlm_analysis_if<LitTriangle> {
  public:
    TransportCheck(const datapath::Registers& registers, const std::vector<datapath::Triangle>& base_triangles);

    void write(const datapath::TrianglePass& pass) override;
    void write(const datapath::Triangle& finished) override;
    void write(const LitTriangle& lit) override;

    /// Call after a run that drained.
    WorkResult result() const;

  private:
    struct Balance {
        std::uint64_t sum = 0;   // of hashes
        std::int64_t count = 0;  // expected minus arrived
        void expect(std::uint64_t hash) {
            sum += hash;
            ++count;
        }
        void come(std::uint64_t hash) {
            sum -= hash;
            --count;
        }
        void operator+=(const Balance& other) {
            sum += other.sum;
            count += other.count;
        }
        bool even() const { return sum == 0 && count == 0; }
    };
    /// What the passes of a base triangle say.
    struct Passes {
        Balance decided;
        Balance split;     // with families
        Balance finished;  // expected only
    };

    std::size_t place_of(std::uint32_t base) const { return base < foreign() ? base : foreign(); }
    std::size_t foreign() const { return passes_.size() - 1; }
    void finding(const std::string& what);

    datapath::Registers registers_;
    // Written with the passes.
    std::vector<Passes> passes_;  // by base triangle; the last: of triangles of none
    std::uint64_t triangles_ = 0;
    // Written with finished and lit triangles; not in the same line of the cache.
    alignas(64) std::vector<Balance> finished_;  // likewise: arrived only
    Balance lit_;
    WorkResult result_;
};

}  // namespace tessera

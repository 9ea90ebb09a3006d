#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/format.h"
#include "testbench/common/distinct_table.h"
#include "testbench/machine/emitted_mesh.h"

namespace tessera {

/// Compares two multisets of triangles, bit for bit (all of EmittedTriangle), one base triangle at a time: the emitted
/// and the expected ones. Order within a base triangle does not matter.
///
/// Differing: one missing and one extra with the same three (P, t), which may be in another order. A triangle of a
/// nonexistent base triangle is extra.
class EmittedDifference {
  public:
    /// `mesh` must outlive it. Four bytes per triangle; ResourceError beyond 2^32 - 1.
    EmittedDifference(const EmittedMesh& mesh, std::size_t base_triangles, const datapath::Formats& formats);

    void begin(std::uint32_t base);  ///< once per base triangle
    void expect(const EmittedTriangle& triangle);
    void end();

    std::uint64_t missing() const { return missing_; }
    std::uint64_t extra() const { return extra_; }
    std::uint64_t differing() const { return differing_; }
    /// The first difference found; empty if none.
    const std::string& first() const { return first_; }

  private:
    /// Equal triangles.
    struct Entry {
        std::uint32_t triangle;  ///< index of one of them, among the emitted ones or, if there is none, the expected
        bool emitted;
        std::int64_t surplus;  ///< emitted minus expected
    };
    EmittedTriangle triangle_of(const Entry& entry) const {
        return entry.emitted ? mesh_.triangles[entry.triangle] : expected_alone_[entry.triangle];
    }
    /// `added`: the entry if there is none of an equal triangle.
    Entry& entry_of(const EmittedTriangle& triangle, const Entry& added);
    void note(const char* what, const EmittedTriangle& triangle);

    const EmittedMesh& mesh_;
    const datapath::Formats& formats_;
    std::vector<std::uint32_t> order_;    // triangle indices, by base triangle
    std::vector<std::uint32_t> offsets_;  // start of each base triangle's part
    DistinctTable table_;
    std::vector<Entry> entries_;
    std::vector<EmittedTriangle> expected_alone_;
    std::uint64_t missing_ = 0, extra_ = 0, differing_ = 0;
    std::string first_;
};

}  // namespace tessera

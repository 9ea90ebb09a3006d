#pragma once
#include <cstddef>
#include <cstdint>

#include "modules/timing/design_choices.h"

namespace tessera {

struct QueueDesign {
    TriangleOrder order = TriangleOrder::fifo;
    std::size_t watermark = 1;  ///< host triangles are taken while fewer than this many wait
    std::size_t capacity = 0;   ///< triangles on chip; 0: unbounded
    QueueOverflow overflow = QueueOverflow::spill;
    std::uint64_t off_chip_triangles = std::uint64_t{1} << 20;  ///< places in off-chip memory
};

inline constexpr unsigned most_tests_units = 3;  ///< one for each edge of a triangle

/// The options of a design. Their ranges, and those of Timing, are declared in design_keys.h; the rules between them in
/// design_rules.h.
struct DesignOptions {
    QueueDesign queue;
    Work work = Work::triangle;
    unsigned tests_units = 1;  ///< Tessellation Tests units: 1 or 3
    TestOrder test_order = TestOrder::parallel;
    unsigned edge_lanes = 1;    ///< family design, tests cheapest first: parallel lanes of cheap tests
    unsigned normal_tests = 1;  ///< likewise: Normal Tests that share the lanes' edges
    unsigned transform_pipelines = 1;
    bool direct_memory = true;  ///< units read memories through DMI in functional mode
};

}  // namespace tessera

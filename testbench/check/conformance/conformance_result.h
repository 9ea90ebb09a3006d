#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace tessera {

/// The scoreboard's result of a run, for the printed and the JSON report.
struct ConformanceResult {
    /// One kind of value, over all its components. Errors are hardware minus golden, absolute, in LSB of the
    /// value's format.
    struct Quantity {
        std::string name;
        std::string unit;
        std::string description;
        std::uint64_t count = 0;    ///< components compared
        std::uint64_t outside = 0;  ///< components beyond their bound: mismatches
        double max_error = 0;
        double rms_error = 0;
        double max_bound = 0;  ///< largest bound of any component
        /// Largest error / bound, each with the bound of its own operands. 1 is usual: often only one integer is
        /// correct, and its distance from the golden model's real number is the bound.
        double worst_ratio = 0;
    };

    /// One kind of decision.
    struct Test {
        std::string name;
        std::string description;
        std::uint64_t compared = 0;
        std::uint64_t agreed = 0;
        std::uint64_t allowed_flips = 0;  ///< differences with golden within its error bound of the threshold
        std::uint64_t mismatches = 0;     ///< all other differences
    };

    std::vector<Quantity> quantities;
    std::vector<Test> tests;
    std::uint64_t passes = 0;
    std::uint64_t edges = 0;
    std::uint64_t base_vertices = 0;  ///< compared, once per base triangle
    std::uint64_t flipped_edges = 0;  ///< edges with an allowed flip
    std::uint64_t mismatches = 0;     ///< of values and decisions
    std::string first_mismatch;       ///< with all operands; empty if there is none

    double flips_percent() const {
        return edges == 0 ? 0 : 100.0 * static_cast<double>(flipped_edges) / static_cast<double>(edges);
    }
    /// The kinds may be empty one by one: a test that is off, a mesh without a split.
    bool empty() const {
        const auto none = [](const auto& kinds, auto count) {
            return std::all_of(kinds.begin(), kinds.end(), [&](const auto& kind) { return kind.*count == 0; });
        };
        return edges == 0 || none(quantities, &Quantity::count) || none(tests, &Test::compared);
    }
    bool passed(double allowed_flips_percent) const {
        return !empty() && mismatches == 0 && flips_percent() <= allowed_flips_percent;
    }
};

}  // namespace tessera

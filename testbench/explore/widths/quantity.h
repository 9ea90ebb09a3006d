#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/job/job.h"

namespace tessera {

/// Returned by Quantity::set() where validate() of the job refuses the formats it set, and says why.
inline constexpr const char* by_the_job = "refused by the job";

/// A format whose width is swept. Either its integer or its fraction bits stay as in the job; the other part takes the
/// rest.
struct Quantity {
    const char* name;
    const char* description;
    const char* keys;          ///< of [formats] that a width sets
    std::int64_t least, most;  ///< total bits that a job may give it; other keys may narrow the range
    /// Total bits, and fraction bits.
    std::int64_t (*bits)(const Job::Formats&);
    std::int64_t (*fraction)(const Job::Formats&);
    /// Empty on success. Else why a job cannot have this width, and what to do; or `by_the_job`.
    std::string (*set)(Job::Formats&, std::int64_t bits);
};

const std::vector<Quantity>& quantities();
/// Null: no such quantity.
const Quantity* find_quantity(std::string_view name);

/// The default widths of a sweep: all, of more than 16 every second, of more than 32 every fourth; the job's own is
/// always included. Widest first.
std::vector<std::int64_t> usual_widths(const Quantity& quantity, const Job::Formats& job);

}  // namespace tessera

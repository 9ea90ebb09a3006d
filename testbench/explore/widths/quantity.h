#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/job/job.h"

namespace tessera {

/// What Quantity::set() answers where validate() of the job refuses the formats it set, and says why.
inline constexpr const char* by_the_job = "refused by the job";

/// A format whose width is swept. Of its integer and fraction bits one part is the job's and the other takes
/// what is left.
struct Quantity {
    const char* name;
    const char* description;
    const char* keys;          ///< of [formats] that a width sets
    std::int64_t least, most;  ///< bits in all that a job may give it; others of its keys may narrow that
    /// Bits in all and behind the point.
    std::int64_t (*bits)(const Job::Formats&);
    std::int64_t (*fraction)(const Job::Formats&);
    /// Empty: done. Else why no such width can be written in a job, and what to do; or `by_the_job`.
    std::string (*set)(Job::Formats&, std::int64_t bits);
};

const std::vector<Quantity>& quantities();
/// Null: no such quantity.
const Quantity* find_quantity(std::string_view name);

/// The widths that a sweep of it takes by itself: all, or of more than 16 every second, of more than 32 every
/// fourth; the job's own among them. Widest first.
std::vector<std::int64_t> usual_widths(const Quantity& quantity, const Job::Formats& job);

}  // namespace tessera

#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/job/job.h"

namespace tessera {

/// Returned by Quantity::set() if the job's validate() refuses the formats; validate() gives the reason.
inline constexpr const char* by_the_job = "refused by the job";

/// A format whose width is swept. Either its integer or its fraction bits stay as in the job; the other part gets the
/// remaining bits.
struct Quantity {
    const char* name;
    const char* description;
    const char* keys;          ///< keys of [formats] set by a width
    std::int64_t least, most;  ///< range of total bits in a job; other keys may narrow it
    /// Total bits, and fraction bits.
    std::int64_t (*bits)(const Job::Formats&);
    std::int64_t (*fraction)(const Job::Formats&);
    /// Returns an empty string on success; else why a job cannot have this width, and the remedy; or `by_the_job`.
    std::string (*set)(Job::Formats&, std::int64_t bits);
};

const std::vector<Quantity>& quantities();
/// Null if there is no such quantity.
const Quantity* find_quantity(std::string_view name);

/// The default widths of a sweep: all possible ones, or every second of more than 16, every fourth of more than 32; the
/// job's own is always included. Widest first.
std::vector<std::int64_t> usual_widths(const Quantity& quantity, const Job::Formats& job);

}  // namespace tessera

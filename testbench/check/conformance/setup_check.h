#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/check/conformance/golden_job.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/machine/simulation.h"

namespace tessera {

/// What the set-up check found.
struct SetupResult {
    /// A kind of what the host sets.
    struct Part {
        std::string name;
        std::string description;     ///< what is compared, and within which bound
        std::uint64_t compared = 0;  ///< values
        std::uint64_t wrong = 0;     ///< beyond their bound
        double worst_ratio = 0;      ///< largest error / bound; 0 where all are compared exactly
    };
    std::vector<Part> parts;
    std::string first_wrong;  ///< its name, index, value and what is allowed; empty: none

    /// Of each of the machine's base triangles, which of the mesh's it is: the host leaves out those that
    /// collapse in the formats.
    std::vector<std::uint32_t> base_triangles;

    std::uint64_t compared() const;
    std::uint64_t wrong() const;
    bool passed() const { return wrong() == 0; }
};

/// Judges what the host set against what the golden model derives from the job by itself: each register, each field of
/// each base vertex, each entry of the three tables as the memories hold it. So the scoreboard, which takes
/// registers and tables as they are, compares arithmetic within tight bounds, and a mistake of the host still
/// fails the run.
///
/// Bounds, of hardware minus golden in LSB of the value's format:
///     rounded to nearest   -1/2 .. 1/2: transform, normal rows, displacement, light, half vector, highlight cosine,
///                          base vertices, displacement map
///     rounded down         above -1, up to 0: thresholds, near plane
///     normal map           golden's slopes are of the same codes and of S unrounded; S's register is off by
///                          at most 1/2 LSB of the position, so a slope s by |s| / (2 |S|): each component
///                          lies between the least and the greatest over those slopes, and 1/2
///     exact                formats, flags, the map's size and addressing, the Summed Height Table modulo 2^bits
/// To each, what double precision itself may be off by: 2^-48 of the terms. In a fourth column of the
/// transform, which is finer than a double where the eye is far, that is more than an LSB.
///
/// The host's own choice, of which only soundness is judged: the model's scale (a power of two with which the displaced
/// mesh fits the position's format), the transform's exponent (entries reach 1/2 and not beyond 1), the view distance's
/// fraction bits (the most with which the farthest position fits), the Summed Height Table's width (holds the largest
/// rectangle's sum; 0: the narrowest of 32, 40, 48 that does), where the tables lie (apart), whole periods added to
/// a texture coordinate on an axis that repeats (the same on all three corners of a triangle).
///
/// Reads the memories by debug transport, row by row. 4096 x 4096 texels take about 2 seconds.
SetupResult check_setup(const MachineSetup& setup, const GoldenJob& golden, Simulation& simulation);

}  // namespace tessera

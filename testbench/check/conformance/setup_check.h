#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/check/conformance/golden_job.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/machine/simulation.h"

namespace tessera {

/// The set-up check's result.
struct SetupResult {
    /// A group of values written by the host.
    struct Part {
        std::string name;
        std::string description;     ///< the values and their bound
        std::uint64_t compared = 0;  ///< values
        std::uint64_t wrong = 0;     ///< values beyond their bound
        double worst_ratio = 0;      ///< largest error / bound; 0 if all are compared exactly
    };
    std::vector<Part> parts;
    std::string first_wrong;  ///< name, index, value and allowed range of the first wrong value; empty: none

    /// For each base triangle of the machine its index in the mesh: the host drops triangles that collapse in the
    /// formats.
    std::vector<std::uint32_t> base_triangles;

    std::uint64_t compared() const;
    std::uint64_t wrong() const;
    bool empty() const;  ///< a part compared nothing
    bool passed() const { return !empty() && wrong() == 0; }
};

/// Compares the host's set-up with values that the golden model derives from the job independently: each register, each
/// field of each base vertex, each entry of the three tables in the memories. The scoreboard takes registers and tables
/// as given, so that it can compare arithmetic within tight bounds; errors of the host are found here.
///
/// Bounds, of hardware minus golden in LSB of the value's format:
///     rounded to nearest   -1/2 .. 1/2: transform, normal rows, displacement, light, half vector, highlight cosine,
///                          base vertices, displacement map
///     rounded down         above -1, up to 0: thresholds, near plane
///     normal map           golden's slopes use the same codes and the unrounded S; S's register has an error of at
///                          most 1/2 LSB of the position, and a slope s of |s| / (2 |S|): each component lies
///                          between the least and the greatest value over those slopes, plus 1/2
///     exact                formats, flags, the map's size and addressing, the Summed Height Table modulo 2^bits
/// Plus the error of double precision: 2^-48 of the terms. In the transform's fourth column, which is finer than a
/// double if the eye is far, this exceeds an LSB.
///
/// Values that the host may choose are checked for validity only: the model's scale (a power of two with which the
/// displaced mesh fits the position's format), the transform's exponent (entries reach 1/2 and not beyond 1), the view
/// distance's fraction bits (the most with which the farthest position fits), the Summed Height Table's width (fits the
/// largest rectangle's sum; 0: the narrowest of 32, 40, 48 that does), the addresses of the tables (no overlap), whole
/// periods added to a texture coordinate on a repeated axis (the same on all three corners of a triangle).
///
/// Reads the memories by debug transport, row by row. 4096 x 4096 texels take about 2 seconds.
SetupResult check_setup(const MachineSetup& setup, const GoldenJob& golden, Simulation& simulation);

/// Computes SetupResult::base_triangles before a simulation exists.
std::vector<std::uint32_t> received_triangles(const MachineSetup& setup, const GoldenJob& golden);

}  // namespace tessera

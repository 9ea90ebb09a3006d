#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/explore/thresholds/threshold_search.h"

namespace tessera {

/// Largest mesh that tune accepts; its RefinementForest takes some gigabytes.
inline constexpr std::uint64_t most_tuned_triangles = std::uint64_t{1} << 22;

/// The arguments of `tessera tune`.
struct TuneOrder {
    std::string job_file;               ///< empty: the default job
    std::vector<std::string> settings;  ///< --set
    std::uint64_t triangles = 0;        ///< one of the two
    double error = 0;                   ///< map units on a height field, else model units
    bool largest = false;               ///< --metric max
    std::vector<std::string> tests;     ///< thresholds searched; empty: of the tests that the job enables
    TuneSpace vary;                     ///< its choices, not its thresholds
    std::vector<std::string> grids;     ///< auto, COLUMNSxROWS, latticeSPACING; empty: the job's base mesh
    std::string output = "tuned.toml";
    std::string tried;  ///< file for the table; empty: none
    unsigned jobs = 1;
};

/// Searches (explore/thresholds/tune.h), runs functional mode with what was found, measures its mesh as `tessera
/// compare` does, writes the tuned job, a .json of the same name and, for a lattice, the base mesh as .obj. Nothing is
/// written when it fails. Throws InputError on wrong usage and on goals that cannot be met.
ExitCode tune_command(const TuneOrder& order, const std::filesystem::path& data_folder);

}  // namespace tessera

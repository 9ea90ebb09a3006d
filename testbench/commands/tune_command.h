#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/tune/threshold_search.h"

namespace tessera {

/// Largest mesh that tune accepts; its RefinementForest takes some gigabytes.
inline constexpr std::uint64_t most_tuned_triangles = std::uint64_t{1} << 22;

/// The arguments of `tessera tune`.
struct TuneOrder {
    std::string job_file;               ///< empty: the default job
    std::vector<std::string> settings;  ///< --set
    std::uint64_t triangles = 0;        ///< goal: either this or `error`
    double error = 0;                   ///< map units on a height field, else model units
    bool largest = false;               ///< --metric max
    std::vector<std::string> tests;     ///< thresholds to search; empty: of the tests that the job enables
    TuneSpace vary;                     ///< its choices are used, its thresholds are not
    std::vector<std::string> grids;     ///< auto, COLUMNSxROWS, latticeSPACING; empty: the job's base mesh
    std::string output = "tuned.toml";
    std::string tried;  ///< file for the table; empty: none
    unsigned jobs = 1;
};

/// Searches (tune/tune.h), runs functional mode with the result, measures its mesh as `tessera compare`
/// does, writes the tuned job, a .json of the same name and, for a lattice, the base mesh as .obj. Writes nothing on
/// failure. Throws InputError on wrong usage and on goals that cannot be met.
ExitCode tune_command(const TuneOrder& order, const std::filesystem::path& data_folder);

}  // namespace tessera

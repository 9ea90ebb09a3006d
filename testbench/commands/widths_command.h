#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "testbench/common/error.h"

namespace tessera {

/// The arguments of `tessera widths`.
struct WidthsOrder {
    std::string job_file;                                       ///< empty: the default job
    std::vector<std::string> settings;                          ///< --set
    std::vector<std::string> quantities;                        ///< empty: all
    std::optional<std::pair<std::int64_t, std::int64_t>> bits;  ///< from, to; none: each quantity's usual widths
    std::optional<double> most_flips;                           ///< percent
    std::optional<double> most_error;                           ///< model units
    std::string output = "runs/widths";                         ///< a folder, or a .csv, with a .json beside it
    unsigned jobs = 1;
};

/// Sweeps the widths (explore/widths/width_sweep.h), prints the tables, writes them as CSV and JSON. Writes nothing on
/// failure. Returns check_failed if a design violated an invariant or disagreed with the golden model beyond rounding.
/// Throws InputError on wrong usage and if the job itself cannot run.
ExitCode widths_command(const WidthsOrder& order, const std::filesystem::path& data_folder);

}  // namespace tessera

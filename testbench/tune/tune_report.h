#pragma once
#include <string>

#include "testbench/tune/tune.h"
#include "testbench/tune/tuned_figures.h"

namespace tessera {

// The output of `tessera tune`. Contains no times: the same tuning gives the same bytes.

/// The report for the terminal.
std::string tune_text(const TuneRequest& request, const TuneResult& result, const TunedFigures& figures,
                      const ErrorUnit& unit);

/// The header of the tuned job file, as TOML comments.
std::string tune_comment(const TuneRequest& request, const TuneResult& result, const TunedFigures& figures,
                         const ErrorUnit& unit);

std::string tune_json(const TuneRequest& request, const TuneResult& result, const TunedFigures& figures,
                      const ErrorUnit& unit);

/// A row for each point tried that met the goal; the error at texels as the search measures it, in `unit`.
std::string tried_csv(const TuneRequest& request, const TuneResult& result, const ErrorUnit& unit);

}  // namespace tessera

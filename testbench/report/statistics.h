#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "testbench/host/simulation.h"

namespace tessera {

/// One figure of a run, as an architect reads it.
struct Figure {
    std::string group;  ///< the unit, memory or stream it belongs to
    std::string name;
    std::variant<std::uint64_t, std::int64_t, double, std::string> value;
    std::string unit;
    std::string description;
};

/// The figures of a run, in the order of the pipeline. No wall-clock time: two runs give the same bytes.
std::vector<Figure> collect_statistics(const Setup& setup, const Simulation& simulation);

/// {"group": {"name": {"value": ..., "unit": "...", "description": "..."}}}
std::string statistics_json(const std::vector<Figure>& figures);

/// Two rows: "group.name" headings, values.
std::string statistics_csv(const std::vector<Figure>& figures);

}  // namespace tessera

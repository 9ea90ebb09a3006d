#include "testbench/tune/rank_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "modules/datapath/rank.h"
#include "testbench/setup/tables/rank_table.h"

namespace tessera {

namespace {

constexpr std::uint32_t most_points = 64;

double model_units_per_code(const MachineSetup& setup) {
    return std::abs(setup.height_per_code) / setup.scale;
}

std::int32_t highest_entry(int bits) {
    return (std::int32_t{1} << bits) - 1;
}

}  // namespace

std::vector<RankPoint> rank_curve(MachineSetup& setup, const Job& job, const TexelError& errors, std::uint64_t limit,
                                  const std::function<void(double)>& on_progress) {
    const datapath::Formats& formats = setup.registers.formats;
    datapath::TestParameters& tests = setup.registers.tests;
    std::vector<RankPoint> curve;
    for (const bool bound : {false, true}) {
        const int bits = bound ? formats.bound_bits : formats.rank_bits;
        if (bits == 0)
            continue;
        tests.height_thresholds[datapath::rank_number] = highest_entry(formats.rank_bits);
        tests.height_thresholds[datapath::bound_number] = highest_entry(formats.bound_bits);
        TuneGoal goal;
        goal.largest = bound;
        RankSearch search(setup, job, errors, goal);
        const std::uint32_t step = std::max<std::uint32_t>(1, (search.highest() + 1) / most_points);
        const std::size_t first = curve.size();
        for (std::int64_t value = search.highest(); value >= 0; value -= step) {
            RankPoint point;
            point.bound = bound;
            point.register_value = static_cast<std::uint32_t>(value);
            point.threshold = search.threshold_of(point.register_value);
            point.promised = (bound_error(point.register_value, std::max(bits, 1)) + setup.map.rounding) *
                             model_units_per_code(setup);
            point.outcome = search.outcome(point.register_value, limit, true);
            on_progress(1 - static_cast<double>(value) / (search.highest() + 1.0));
            if (!point.outcome.complete)
                break;
            // Of the thresholds with the same mesh, the lowest is kept: it guarantees the smallest error.
            if (curve.size() > first && curve.back().outcome.triangles == point.outcome.triangles)
                curve.pop_back();
            curve.push_back(point);
        }
    }
    return curve;
}

std::string rank_curve_csv(const std::vector<RankPoint>& curve, const ErrorUnit& unit) {
    std::string text =
        fmt::format("test,register,threshold,promised [{0}],triangles,rms [{0}],largest [{0}]\n", unit.name());
    for (const RankPoint& point : curve)
        text += fmt::format(
            "{},{},{},{},{},{:.6g},{:.6g}\n", point.bound ? "bound" : "rank", point.register_value, point.threshold,
            point.bound ? fmt::format("{:.6g}", point.promised / unit.model_units) : std::string{},
            point.outcome.triangles, point.outcome.rms / unit.model_units, point.outcome.max / unit.model_units);
    return text;
}

std::string rank_curve_text(const std::vector<RankPoint>& curve, const ErrorUnit& unit) {
    std::string text = fmt::format("  {:<7}{:>12}{:>12}{:>12}{:>12}{:>12}   errors in {}s\n", "test", "threshold",
                                   "promised", "triangles", "RMS", "largest", unit.name());
    const RankPoint* before = nullptr;
    for (const RankPoint& point : curve) {
        if (before != nullptr && before->bound == point.bound &&
            2 * point.outcome.triangles < 3 * before->outcome.triangles)
            continue;
        before = &point;
        text += fmt::format(
            "  {:<7}{:>12.5g}{:>12}{:>12}{:>12.4g}{:>12.4g}\n", point.bound ? "bound" : "rank", point.threshold,
            point.bound ? fmt::format("{:.4g}", point.promised / unit.model_units) : "-", point.outcome.triangles,
            point.outcome.rms / unit.model_units, point.outcome.max / unit.model_units);
    }
    return text;
}

std::string rank_table_json(const MachineSetup& setup, const ErrorUnit& unit) {
    const datapath::TableLayout& layout = setup.registers.height_table;
    const datapath::Formats& formats = setup.registers.formats;
    nlohmann::ordered_json json;
    json["columns"] = layout.columns;
    json["rows"] = layout.rows;
    json["entry_bytes"] = layout.entry_bytes;
    json["rank_bits"] = formats.rank_bits;
    json["bound_bits"] = formats.bound_bits;
    json["order"] = "row by row, bottom row first; little endian; the rank in an entry's lowest bits, then the bound";
    json["base_triangles"] = setup.base_triangles.size();
    json["shared_midpoints"] = setup.rank_tables.clashes;
    json["least_error"] = {{"value", setup.rank_tables.least_error * model_units_per_code(setup) / unit.model_units},
                           {"unit", unit.name()}};
    json["highest_bound_register"] = setup.rank_tables.highest_bound_threshold;
    return json.dump(2) + "\n";
}

std::string rank_table_bytes(const MachineSetup& setup) {
    const datapath::TableLayout& layout = setup.registers.height_table;
    std::string bytes(layout.bytes(), '\0');
    write_tables(setup, [&](std::uint64_t address, const unsigned char* from, std::size_t count) {
        if (address >= layout.base && address - layout.base < bytes.size())
            std::copy_n(from, count, bytes.begin() + static_cast<std::ptrdiff_t>(address - layout.base));
    });
    return bytes;
}

}  // namespace tessera

#include "testbench/explore/widths/widths_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "testbench/common/grouped_digits.h"

namespace tessera {

namespace {

using Json = nlohmann::ordered_json;

std::uint64_t open_places(const InvariantResult& invariants) {
    return invariants.cracks + invariants.t_vertices;
}

/// The storage that depends on the quantity's width.
std::string storage_text(const Quantity& quantity, const WidthRow& row) {
    const std::string_view name = quantity.name;
    if (name == "displacement")
        return grouped_digits(row.displacement_map_bytes) + " B map";
    if (name == "summed_height")
        return grouped_digits(row.summed_height_table_bytes) + " B table";
    const std::string entry = fmt::format("{} b", row.queue_entry_bits);
    return name == "normal" ? fmt::format("{}, {} B map", entry, grouped_digits(row.normal_map_bytes)) : entry;
}

std::string row_text(const Quantity& quantity, const WidthRow& row) {
    const std::string bits = fmt::format("{}{}", row.bits, row.of_the_job ? "*" : " ");
    if (!row.refused.empty())
        return fmt::format("  {:>5}{:>5}  refused: {}\n", bits, row.fraction, row.refused);
    const WidthRun& run = row.run;
    const auto flips = [&](Decided decided) { return grouped_digits(run.flips_of(decided)); };
    return fmt::format(
        "  {:>5}{:>5}{:>10}{:>10}{:>10}{:>9}{:>8.3f}{:>8}{:>8}{:>8}{:>8}{:>11.3e}{:>11.3e}{:>11.3g}"
        "{:>8}{:>7}{:>10}  {}\n",
        bits, row.fraction, grouped_digits(run.triangles), grouped_digits(run.end_to_end.golden_triangles),
        grouped_digits(run.edges), flips(Decided::split), run.split_flips_percent(), flips(Decided::normal),
        flips(Decided::summed_height), flips(Decided::view), flips(Decided::tex_coord), run.position_max,
        run.position_rms, run.position_rms / run.position_lsb,
        grouped_digits(run.conformance.flipped_edges + run.conformance.mismatches), open_places(run.invariants),
        grouped_digits(row.saturated), storage_text(quantity, row));
}

std::string limit_text(bool given, const std::string& limit, const char* relative) {
    return given ? limit : fmt::format("{} ({})", limit, relative);
}

std::string knee_text(const WidthTable& table) {
    const WidthKnee& knee = table.knee;
    const std::string limits = fmt::format(
        "at most {} of the edges with a split decision that differs from exact arithmetic, an RMS position error of "
        "at most {}, at most {:g} % local (check.allowed_flips), and no invariant violated",
        limit_text(knee.flips_given, fmt::format("{:.3f} %", knee.most_flips), "0.5 above the widest's"),
        limit_text(knee.error_given, fmt::format("{:.3e} model units", knee.most_error), "1.25 times the widest's"),
        knee.most_local);
    if (!knee.row) {
        const bool any =
            std::any_of(table.rows.begin(), table.rows.end(), [](const WidthRow& row) { return row.refused.empty(); });
        return any ? fmt::format("  knee: none; even the widest exceeds the limits: {}\n", limits)
                   : "  knee: none; every width was refused\n";
    }
    const WidthRow& row = table.rows[*knee.row];
    const bool last = *knee.row + 1 == table.rows.size();
    return fmt::format("  knee: {} bits, {} of them fraction{}: at this and every wider width tried, {}\n", row.bits,
                       row.fraction, last ? " (the narrowest tried)" : "", limits);
}

std::string table_text(const WidthTable& table) {
    const Quantity& quantity = *table.swept.quantity;
    std::string text = fmt::format("\n{}: {} ({})\n", quantity.name, quantity.description, quantity.keys);
    text += fmt::format(
        "  {:<5}{:>5}{:>10}{:>10}{:>10}{:>9}{:>8}{:>8}{:>8}{:>8}{:>8}{:>11}{:>11}{:>11}{:>8}{:>7}{:>10}  "
        "{}\n",
        " bits", "frac", "triangles", "golden", "edges", "flipped", "%", "NT", "SHT", "VT", "TCT", "error max", "RMS",
        "RMS LSB", "local", "open", "saturated", "storage");
    for (const WidthRow& row : table.rows)
        text += row_text(quantity, row);
    return text + knee_text(table);
}

std::string quoted(std::string text) {
    for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2))
        text.insert(at, 1, '"');
    return '"' + text + '"';
}

Json saturations_json(const WidthRow& row) {
    Json json = Json::object();
    for (const SaturationFigure& figure : row.saturations)
        json[figure.name] = figure.count;
    return json;
}

Json row_json(const WidthRow& row) {
    Json json = {{"bits", row.bits}, {"fraction", row.fraction}, {"of_the_job", row.of_the_job}};
    if (!row.refused.empty()) {
        json["refused"] = row.refused;
        return json;
    }
    const WidthRun& run = row.run;
    json["triangles"] = run.triangles;
    json["golden_triangles"] = run.end_to_end.golden_triangles;
    json["edges"] = run.edges;
    json["edges_split"] = run.edges_split;
    Json& flips = json["flips"];
    for (std::size_t k = 0; k < decided_names.size(); ++k)
        flips[decided_names[k]] = {{"edges", run.flips[k]}, {"percent", run.percent(run.flips[k])}};
    json["diagonals"] = {{"quadrilaterals", run.quadrilaterals}, {"flips", run.diagonal_flips}};
    Json& local = json["local"];
    local["flipped_edges"] = run.conformance.flipped_edges;
    local["mismatches"] = run.conformance.mismatches;
    for (const ConformanceResult::Test& test : run.conformance.tests)
        local["decisions"][test.name] = test.allowed_flips + test.mismatches;
    json["position_error"] = {{"positions", run.positions},
                              {"max_model", run.position_max},
                              {"rms_model", run.position_rms},
                              {"max_lsb", run.position_max / run.position_lsb},
                              {"rms_lsb", run.position_rms / run.position_lsb},
                              {"lsb_model", run.position_lsb}};
    json["cracks"] = run.invariants.cracks;
    json["t_vertices"] = run.invariants.t_vertices;
    json["violations"] = run.invariants.violations();
    json["saturations"] = saturations_json(row);
    json["storage"] = {{"base_vertex_bits", row.base_vertex_bits},
                       {"queue_entry_bits", row.queue_entry_bits},
                       {"displacement_map_bytes", row.displacement_map_bytes},
                       {"normal_map_bytes", row.normal_map_bytes},
                       {"summed_height_table_bytes", row.summed_height_table_bytes}};
    return json;
}

}  // namespace

std::string widths_text(const WidthRequest& request, const WidthSweep& sweep) {
    std::string text = fmt::format(
        "tessera widths: one quantity at a time, all others as in the job (*: the job's own width)\n"
        "  triangles        of the machine; golden: of the golden model from the same rounded inputs; exact "
        "arithmetic: {}\n"
        "  flipped, %       edges with a split decision that differs from exact arithmetic; NT SHT VT TCT: edges on "
        "which that test differs{}\n"
        "  error            of displaced positions against exact arithmetic, in model units; in LSB of the "
        "position\n"
        "  local            edges with a decision that differs from the golden model's from the same rounded "
        "ends\n"
        "  open             cracks and T-vertices, which must be 0\n"
        "  saturated        values; the JSON file lists which\n"
        "  storage          bits of a Triangle Queue entry, bytes of a table\n",
        sweep.exact_triangles == 0 ? "too many to count" : grouped_digits(sweep.exact_triangles),
        request.job.tests.highlight ? " (HT: in the CSV)" : "");
    for (const WidthTable& table : sweep.tables)
        text += table_text(table);
    if (!sweep.texel_borders.empty())
        text += fmt::format("\n  warning: {}\n", sweep.texel_borders);
    return text;
}

std::string widths_csv(const WidthSweep& sweep) {
    std::string text = "quantity,bits,fraction [bit],refused,triangles,golden triangles,edges,edges split";
    for (const char* const name : decided_names)
        text += fmt::format(",{} flips,{} flips [%]", name, name);
    text +=
        ",local flipped edges,local mismatches,positions,position error max [model unit],position error RMS "
        "[model "
        "unit],position error max [LSB],position error RMS [LSB],position LSB [model "
        "unit],cracks,T-vertices,violations,saturations,base vertex [bit],queue entry [bit],displacement map "
        "[byte],normal map [byte],summed height table [byte]\n";
    const std::size_t columns = static_cast<std::size_t>(std::count(text.begin(), text.end(), ','));
    for (const WidthTable& table : sweep.tables) {
        for (const WidthRow& row : table.rows) {
            text += fmt::format("{},{},{},", table.swept.quantity->name, row.bits, row.fraction);
            if (!row.refused.empty()) {
                text += quoted(row.refused) + std::string(columns - 3, ',') + '\n';
                continue;
            }
            const WidthRun& run = row.run;
            text +=
                fmt::format(",{},{},{},{}", run.triangles, run.end_to_end.golden_triangles, run.edges, run.edges_split);
            for (const std::uint64_t flips : run.flips)
                text += fmt::format(",{},{:.6g}", flips, run.percent(flips));
            text +=
                fmt::format(",{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{},{},{},{},{},{},{},{}\n",
                            run.conformance.flipped_edges, run.conformance.mismatches, run.positions, run.position_max,
                            run.position_rms, run.position_max / run.position_lsb, run.position_rms / run.position_lsb,
                            run.position_lsb, run.invariants.cracks, run.invariants.t_vertices,
                            run.invariants.violations(), row.saturated, row.base_vertex_bits, row.queue_entry_bits,
                            row.displacement_map_bytes, row.normal_map_bytes, row.summed_height_table_bytes);
        }
    }
    return text;
}

std::string widths_json(const WidthRequest& request, const WidthSweep& sweep) {
    Json json;
    json["exact_triangles"] = sweep.exact_triangles;
    if (!sweep.texel_borders.empty())
        json["warning"] = sweep.texel_borders;
    json["decisions"] = request.job.tests.highlight ? "with the Highlight Test" : "without the Highlight Test";
    for (const WidthTable& table : sweep.tables) {
        const Quantity& quantity = *table.swept.quantity;
        Json& entry = json["quantities"][quantity.name];
        entry["description"] = quantity.description;
        entry["keys"] = quantity.keys;
        const WidthKnee& knee = table.knee;
        entry["knee"] = {{"most_flips_percent", knee.most_flips}, {"most_rms_error_model", knee.most_error}};
        entry["knee"]["bits"] = knee.row ? Json(table.rows[*knee.row].bits) : Json(nullptr);
        for (const WidthRow& row : table.rows)
            entry["rows"].push_back(row_json(row));
    }
    return json.dump(2) + "\n";
}

}  // namespace tessera

#include "testbench/output/report/conformance_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "testbench/output/report/figures_text.h"

namespace tessera {

namespace {

using Json = nlohmann::ordered_json;

/// A check's group, with its verdict. meaning: of `passed`.
template <class Result>
FigureGroup check_group(std::vector<Figure>& all, const char* group, const Result& result, bool passed,
                        std::string meaning) {
    FigureGroup figures(all, group);
    figures.add("passed", passed, "", result.empty() ? "nothing was compared" : std::move(meaning));
    return figures;
}
template <class Result>
FigureGroup check_group(std::vector<Figure>& all, const char* group, const Result& result, std::string meaning) {
    return check_group(all, group, result, result.passed(), std::move(meaning));
}

void setup_figures(std::vector<Figure>& all, const SetupResult& result) {
    FigureGroup c = check_group(all, "setup", result,
                                "the host's settings are those that the golden model derives from the job, each within "
                                "the bound of its format's rounding");
    c.add("compared", result.compared(), "value", "");
    c.add("wrong", result.wrong(), "value", "beyond their bound");
    c.add("first_wrong", result.first_wrong, "", "");
    for (const SetupResult::Part& part : result.parts) {
        FigureGroup row(all, "setup.parts", part.name);
        row.add("compared", part.compared, "value", "set by the host");
        row.add("wrong", part.wrong, "value", "beyond their bound");
        row.add("worst_ratio", part.worst_ratio, "times", "largest error over its bound; 0: all are compared exactly");
        row.add("description", part.description, "", "");
    }
}

void decision_figures(std::vector<Figure>& all, const ConformanceResult& result, double allowed_flips) {
    FigureGroup c = check_group(all, "conformance", result, result.passed(allowed_flips),
                                "the golden model decided every edge again, in double precision, from the same ends");
    c.add("passes", result.passes, "pass", "triangles that went through the tests");
    c.add("edges", result.edges, "edge", "compared");
    c.add("flipped_edges", result.flipped_edges, "edge",
          "with a flip: golden's value lies within the format's error bound of its threshold");
    c.add("flips_percent", result.flips_percent(), "percent", "of the edges");
    c.add("allowed_flips_percent", allowed_flips, "percent", "check.allowed_flips");
    c.add("mismatches", result.mismatches, "", "decisions and values of any kind");
    c.add("first_mismatch", result.first_mismatch, "", "");
    for (const ConformanceResult::Test& test : result.tests) {
        FigureGroup row(all, "conformance.decisions", test.name);
        row.add("compared", test.compared, "decision", "with golden's");
        row.add("agreed", test.agreed, "decision", "equal");
        row.add("allowed_flips", test.allowed_flips, "decision", "that differ within the error bound of the threshold");
        row.add("mismatches", test.mismatches, "decision", "all others that differ");
        row.add("description", test.description, "", "");
    }
    for (const ConformanceResult::Quantity& q : result.quantities) {
        FigureGroup row(all, "conformance.values", q.name);
        row.add("compared", q.count, "value", "components, hardware minus golden");
        row.add("outside", q.outside, "value", "beyond their bound, which is derived from the formats and operands");
        row.add("max_error", q.max_error, "", "largest error, in the unit of the row");
        row.add("rms_error", q.rms_error, "", "root mean square of the errors, likewise");
        row.add("largest_bound", q.max_bound, "", "of any component, likewise");
        row.add("worst_ratio", q.worst_ratio, "times", "largest error over its own bound");
        row.add("unit", q.unit, "", "");
        row.add("description", q.description, "", "");
    }
}

void distance_figures(std::vector<Figure>& all, const char* name, const EndToEndResult& result,
                      const EndToEndResult::Distance& d) {
    FigureGroup row(all, "end_to_end", name);
    row.add("points", d.points, "point", "vertices and centroids of the first surface");
    row.add("measured", d.measured, "point", "of these");
    row.add("unseen_percent", 100 * d.unseen, "percent",
            "of all points, at most, are farther away than the maximum, with the confidence beside it");
    row.add("confidence_percent", 100 * EndToEndResult::confidence, "percent", "that this is so");
    row.add("farther_percent", d.farther, "percent",
            fmt::format("of the measured points, farther than rounding_model from the other surface; allowed: {:.3g}",
                        result.allowed_farther()));
    row.add("max_model", d.max_model, "model unit", "largest distance");
    row.add("rms_model", d.rms_model, "model unit", "root mean square of the distances");
    row.add("max_position_lsb", d.max_position_lsb, "position LSB", "largest distance");
    row.add("rms_position_lsb", d.rms_position_lsb, "position LSB", "root mean square of the distances");
}

void end_to_end_figures(std::vector<Figure>& all, const EndToEndResult& e) {
    FigureGroup c = check_group(all, "end_to_end", e,
                                "the golden model's own run of the job: its own camera, heights, normal map and "
                                "thresholds; only codes and texture coordinates are rounded, as in the hardware");
    c.add("hardware_triangles", e.hardware_triangles, "triangle", "of the machine's mesh");
    c.add("golden_triangles", e.golden_triangles, "triangle", "of golden's");
    c.add("more_triangles_percent", e.more_triangles(), "percent", "of the machine's, by which golden's are more");
    c.add("allowed_triangles_percent", e.allowed.triangles, "percent",
          "more or fewer: check.allowed_triangles; any, if values saturated");
    c.add("rounding_model", e.allowed.rounding, "model unit", "by which rounding moves a point, at most");
    c.add("allowed_rms_model", e.allowed_rms_model(), "model unit",
          "this, and the range of displacements times the root of the share of farther points");
    c.add("golden_bound_hit", e.bound_hit, "", fmt::format("golden's run was stopped at {} triangles", e.bound));
    distance_figures(all, "hardware_to_golden", e, e.hardware_to_golden);
    distance_figures(all, "golden_to_hardware", e, e.golden_to_hardware);
}

const char* kind_name(InvariantFigure::Kind kind) {
    switch (kind) {
        case InvariantFigure::Kind::fact: return "fact";
        case InvariantFigure::Kind::violation: return "violation";
        case InvariantFigure::Kind::rounding: return "rounding";
        case InvariantFigure::Kind::input: break;
    }
    return "input";
}

void invariant_rows(std::vector<Figure>& all, const InvariantResult& result) {
    FigureGroup c = check_group(all, "invariants", result,
                                "the emitted mesh equals the bare datapath's, bit for bit, and is closed by descent");
    c.add("first_violation", result.first_violation, "", "");
    for (const InvariantFigure& figure : invariant_figures(result)) {
        FigureGroup row(all, "invariants", figure.name);
        row.add("value", figure.value, "", "");
        row.add("kind", kind_name(figure.kind), "", "violations must be 0");
        row.add("unit", figure.unit, "", "");
        row.add("description", figure.description, "", "");
    }
}

void transport_figures(std::vector<Figure>& all, const Checks& checks) {
    if (checks.work) {
        FigureGroup c = check_group(all, "work", *checks.work,
                                    "each triangle arrived where expected, once and unaltered; each unit received what "
                                    "another sent");
        c.add("triangles", checks.work->triangles, "triangle", "decided");
        c.add("equations", checks.work->equations, "", "between counts of units");
        c.add("violations", checks.work->violations, "", "");
        c.add("first_violation", checks.work->first_violation, "", "");
    }
    if (checks.reads) {
        FigureGroup c =
            check_group(all, "reads", *checks.reads, "every table entry read was compared with the memory's contents");
        c.add("entries", checks.reads->entries, "entry", "compared");
        c.add("wrong", checks.reads->wrong, "entry", "");
        c.add("missed", checks.reads->missed, "entry", "read but not compared");
        c.add("first_wrong", checks.reads->first_wrong, "", "");
    }
}

void bound_figures(std::vector<Figure>& all, const BoundResult& bound) {
    FigureGroup c = check_group(all, "bound", bound, "the mesh keeps tests.bound_threshold");
    const char* const unit = bound.in_picture ? "pixels" : "full scale";
    c.add("promised", bound.promised, "", "all conditions are met");
    c.add("threshold", bound.threshold, unit, "");
    c.add("deviation", bound.deviation, unit, "largest found");
    c.add("unit", unit, "", "");
    c.add("points", bound.points, "texel", "compared");
    c.add("text", bound.text(), "", "");
}

std::vector<Figure> check_figures(const Checks& checks) {
    std::vector<Figure> all;
    if (checks.setup)
        setup_figures(all, *checks.setup);
    if (checks.conformance)
        decision_figures(all, *checks.conformance, checks.allowed_flips);
    if (checks.end_to_end)
        end_to_end_figures(all, *checks.end_to_end);
    if (checks.invariants)
        invariant_rows(all, *checks.invariants);
    transport_figures(all, checks);
    if (checks.bound)
        bound_figures(all, *checks.bound);
    return all;
}

}  // namespace

std::string report_text(const Checks& checks, const std::vector<Figure>& statistics) {
    std::vector<Figure> all = check_figures(checks);
    std::string failed;
    for (const Figure& figure : all)
        if (figure.name == "passed" && !std::get<bool>(figure.value))
            failed += (failed.empty() ? "" : ", ") + figure.group;
    std::string text = failed.empty() ? "Checks: passed\n" : "Checks: FAILED: " + failed + "\n";
    for (const auto& [made, name] :
         {std::pair{checks.setup.has_value(), "setup (check.golden and check.end_to_end = false)"},
          {checks.conformance.has_value(), "conformance (check.golden = false)"},
          {checks.end_to_end.has_value(), "end_to_end (check.end_to_end = false)"},
          {checks.invariants.has_value(), "invariants (check.invariants = false)"},
          {checks.work.has_value(), "work (check.work = false)"}})
        if (!made)
            text += fmt::format("  not checked: {}\n", name);
    if (!checks.remarks.empty())
        text += "Remarks on mesh and map:\n";
    for (const std::string& remark : checks.remarks)
        text += fmt::format("  {}\n", remark);
    all.insert(all.end(), statistics.begin(), statistics.end());
    return text + "\n" + figures_text(all);
}

std::string conformance_json(const Checks& checks) {
    Json json = {{"passed", checks.passed()}, {"remarks", checks.remarks}};
    for (const Figure& figure : check_figures(checks)) {
        Json* place = &json;
        for (std::size_t from = 0, dot = 0; dot != std::string::npos; from = dot + 1) {
            dot = figure.group.find('.', from);
            place = &(*place)[figure.group.substr(from, dot - from)];
        }
        if (!figure.row.empty())
            place = &(*place)[figure.row];
        std::visit([&](const auto& value) { (*place)[figure.name] = value; }, figure.value);
    }
    return json.dump(2) + "\n";
}

}  // namespace tessera

#include "testbench/output/report/conformance_report.h"

#include <fmt/core.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace tessera {

namespace {

using Json = nlohmann::ordered_json;

const char* verdict(bool passed) {
    return passed ? "passed" : "FAILED";
}

template <class Result>
std::string verdict(const Result& result, bool passed) {
    return std::string(verdict(passed)) + (result.empty() ? ", since nothing was compared" : "");
}
template <class Result>
std::string verdict(const Result& result) {
    return verdict(result, result.passed());
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

std::string decisions_text(const ConformanceResult& result, double allowed_flips) {
    std::string text = fmt::format(
        "Decisions: {}. The golden model decided every edge again, in double precision, from the same "
        "ends.\n"
        "A flip is allowed where golden's value lies within the format's error bound of its threshold, on at "
        "most {} %\n"
        "of the edges.\n\n"
        "  {:<16}{:>12}{:>12}{:>14}{:>12}\n",
        verdict(result, result.passed(allowed_flips)), allowed_flips, "decision", "compared", "agreed", "allowed flips",
        "mismatches");
    for (const ConformanceResult::Test& test : result.tests)
        text += fmt::format("  {:<16}{:>12}{:>12}{:>14}{:>12}\n", test.name, test.compared, test.agreed,
                            test.allowed_flips, test.mismatches);
    text += fmt::format("\n  edges {}, with an allowed flip {} ({:.4f} %), mismatches of any kind {}\n", result.edges,
                        result.flipped_edges, result.flips_percent(), result.mismatches);
    if (!result.first_mismatch.empty())
        text += "\nFirst mismatch:\n" + result.first_mismatch + "\n";
    return text;
}

std::string values_text(const ConformanceResult& result) {
    std::string text = fmt::format(
        "Values: hardware minus golden, in LSB of the value's format; each within a bound derived from the "
        "formats\nand operands. `of bound`: the largest ratio of a value to its own bound.\n\n"
        "  {:<28}{:>12}{:>10}{:>12}{:>12}{:>15}{:>10}\n",
        "quantity", "compared", "outside", "maximum", "RMS", "largest bound", "of bound");
    for (const ConformanceResult::Quantity& q : result.quantities)
        text += fmt::format("  {:<28}{:>12}{:>10}{:>12.4f}{:>12.4f}{:>15.4f}{:>9.0f}%\n", q.name, q.count, q.outside,
                            q.max_error, q.rms_error, q.max_bound, 100 * q.worst_ratio);
    return text;
}

std::string distance_text(const char* name, const EndToEndResult::Distance& d) {
    return fmt::format(
               "  {:<20} {:>10} points: {:.4f} % farther than that; maximum {:.6g}, RMS {:.6g} model units "
               "({:.2f}, {:.2f} position LSB)\n",
               name, d.points, d.farther, d.max_model, d.rms_model, d.max_position_lsb, d.rms_position_lsb) +
           (d.measured < d.points
                ? fmt::format("  {:<20} {:>10} of them measured: with {} % confidence at most {:.2g} % of all are "
                              "farther away than the maximum\n",
                              "", d.measured, 100 * EndToEndResult::confidence, 100 * d.unseen)
                : std::string());
}

std::string end_to_end_text(const EndToEndResult& result) {
    std::string text = fmt::format(
        "End to end: {}. The golden model's own run of the job: its own camera, heights, normal map "
        "and "
        "thresholds.\nOnly map values (to displacement codes) and texture coordinates are rounded, as in the "
        "hardware. Allowed: {} % more or\nfewer triangles; {} % of the points farther from the other "
        "surface "
        "than rounding moves them, {:.3g} model units;\nan RMS distance of {:.6g} model units: the same rounding, "
        "and the range of displacements times the root of the\nshare of farther points that was measured.\n\n"
        "  triangles: hardware {}, golden {}\n",
        verdict(result), result.allowed.triangles, result.allowed_farther(), result.allowed.rounding,
        result.allowed_rms_model(), result.hardware_triangles,
        result.bound_hit ? fmt::format("more than {}; its run was stopped there", result.bound)
                         : fmt::format("{} ({:+.4f} %)", result.golden_triangles, result.more_triangles()));
    if (!result.bound_hit)
        text += distance_text("hardware to golden", result.hardware_to_golden) +
                distance_text("golden to hardware", result.golden_to_hardware);
    return text;
}

std::string setup_text(const SetupResult& result) {
    std::string text = fmt::format(
        "Set-up: {}. The host's settings compared with those that the golden model derives from the job; each "
        "value within\nthe bound of its format's rounding.\n\n  {:<22}{:>12}{:>10}{:>10}  {}\n",
        verdict(result), "set by the host", "compared", "wrong", "of bound", "");
    for (const SetupResult::Part& part : result.parts)
        text += fmt::format("  {:<22}{:>12}{:>10}{:>9.0f}%  {}\n", part.name, part.compared, part.wrong,
                            100 * part.worst_ratio, part.description);
    if (!result.first_wrong.empty())
        text += "\nFirst wrong:\n" + result.first_wrong + "\n";
    return text;
}

std::string invariants_text(const InvariantResult& result) {
    std::string text = fmt::format(
        "Invariants: {}. The emitted mesh equals the bare datapath's, bit for bit, and is closed by\n"
        "descent. Violations must be 0; the kinds `rounding` and `input` are explained below.\n\n",
        verdict(result));
    for (const InvariantFigure& figure : invariant_figures(result))
        text += fmt::format("  {:<28}{:>12}  {:<10} {}\n", figure.name, figure.value, kind_name(figure.kind),
                            figure.description);
    if (!result.first_violation.empty())
        text += "\nFirst violation:\n" + result.first_violation + "\n";
    return text;
}

std::string work_text(const WorkResult& result) {
    std::string text = fmt::format(
        "Work conservation: {}. Each triangle arrived where expected, once and unaltered; each unit "
        "received\nwhat another sent.\n\n  triangles decided {}, equations {}, violations {}\n",
        verdict(result), result.triangles, result.equations, result.violations);
    if (!result.first_violation.empty())
        text += "\nFirst violation:\n" + result.first_violation + "\n";
    return text;
}

std::string reads_text(const ReadResult& result) {
    std::string text = fmt::format(
        "Reads: {}. Every table entry read was compared with the memory's contents.\n\n"
        "  entries {}, wrong {}, read but not compared {}\n",
        verdict(result), result.entries, result.wrong, result.missed);
    if (!result.first_wrong.empty())
        text += "\nFirst wrong:\n" + result.first_wrong + "\n";
    return text;
}

Json distance_json(const EndToEndResult::Distance& d) {
    return {{"points", d.points},
            {"measured", d.measured},
            {"unseen_percent", 100 * d.unseen},
            {"confidence_percent", 100 * EndToEndResult::confidence},
            {"farther_percent", d.farther},
            {"max_model", d.max_model},
            {"rms_model", d.rms_model},
            {"max_position_lsb", d.max_position_lsb},
            {"rms_position_lsb", d.rms_position_lsb}};
}

Json conformance_part(const ConformanceResult& result, double allowed_flips) {
    Json part = {{"passed", result.passed(allowed_flips)},
                 {"passes", result.passes},
                 {"edges", result.edges},
                 {"flipped_edges", result.flipped_edges},
                 {"flips_percent", result.flips_percent()},
                 {"allowed_flips_percent", allowed_flips},
                 {"mismatches", result.mismatches},
                 {"first_mismatch", result.first_mismatch}};
    for (const ConformanceResult::Test& test : result.tests)
        part["decisions"][test.name] = {{"compared", test.compared},
                                        {"agreed", test.agreed},
                                        {"allowed_flips", test.allowed_flips},
                                        {"mismatches", test.mismatches},
                                        {"description", test.description}};
    for (const ConformanceResult::Quantity& q : result.quantities)
        part["values"][q.name] = {
            {"compared", q.count},      {"outside", q.outside},         {"max_error", q.max_error},
            {"rms_error", q.rms_error}, {"largest_bound", q.max_bound}, {"worst_ratio", q.worst_ratio},
            {"unit", q.unit},           {"description", q.description}};
    return part;
}

}  // namespace

std::string conformance_text(const Checks& checks) {
    std::string text = fmt::format("Conformance report: {}\n\n", verdict(checks.passed()));
    text += checks.setup ? setup_text(*checks.setup) + "\n"
                         : "Set-up: not checked (check.golden and check.end_to_end = false).\n\n";
    if (checks.conformance)
        text +=
            decisions_text(*checks.conformance, checks.allowed_flips) + "\n" + values_text(*checks.conformance) + "\n";
    else
        text += "Decisions and values: not checked (check.golden = false).\n\n";
    text += checks.end_to_end ? end_to_end_text(*checks.end_to_end) + "\n"
                              : "End to end: not run (check.end_to_end = false).\n\n";
    text += checks.invariants ? invariants_text(*checks.invariants)
                              : "Invariants: not checked (check.invariants = false).\n";
    text += "\n" + (checks.work ? work_text(*checks.work)
                                : std::string("Work conservation: not checked (check.work = false).\n"));
    if (checks.reads)
        text += "\n" + reads_text(*checks.reads);
    if (checks.bound)
        text += fmt::format("\nBound: {}\n", checks.bound->text());
    if (!checks.remarks.empty())
        text += "\nRemarks on mesh and map:\n";
    for (const std::string& remark : checks.remarks)
        text += fmt::format("  {}\n", remark);
    return text;
}

std::string conformance_json(const Checks& checks) {
    Json json = {{"passed", checks.passed()}, {"remarks", checks.remarks}};
    if (checks.setup) {
        Json part = {{"passed", checks.setup->passed()},
                     {"compared", checks.setup->compared()},
                     {"wrong", checks.setup->wrong()},
                     {"first_wrong", checks.setup->first_wrong}};
        for (const SetupResult::Part& p : checks.setup->parts)
            part["parts"][p.name] = {{"compared", p.compared},
                                     {"wrong", p.wrong},
                                     {"worst_ratio", p.worst_ratio},
                                     {"description", p.description}};
        json["setup"] = std::move(part);
    }
    if (checks.conformance)
        json["conformance"] = conformance_part(*checks.conformance, checks.allowed_flips);
    if (checks.end_to_end) {
        const EndToEndResult& e = *checks.end_to_end;
        json["end_to_end"] = {{"passed", e.passed()},
                              {"hardware_triangles", e.hardware_triangles},
                              {"golden_triangles", e.golden_triangles},
                              {"more_triangles_percent", e.more_triangles()},
                              {"allowed_triangles_percent", e.allowed.triangles},
                              {"rounding_model", e.allowed.rounding},
                              {"allowed_rms_model", e.allowed_rms_model()},
                              {"golden_bound_hit", e.bound_hit},
                              {"hardware_to_golden", distance_json(e.hardware_to_golden)},
                              {"golden_to_hardware", distance_json(e.golden_to_hardware)}};
    }
    if (checks.invariants) {
        Json part = {{"passed", checks.invariants->passed()}, {"first_violation", checks.invariants->first_violation}};
        for (const InvariantFigure& figure : invariant_figures(*checks.invariants))
            part[figure.name] = {{"value", figure.value},
                                 {"kind", kind_name(figure.kind)},
                                 {"unit", figure.unit},
                                 {"description", figure.description}};
        json["invariants"] = std::move(part);
    }
    if (checks.work)
        json["work"] = {{"passed", checks.work->passed()},
                        {"triangles", checks.work->triangles},
                        {"equations", checks.work->equations},
                        {"violations", checks.work->violations},
                        {"first_violation", checks.work->first_violation}};
    if (checks.reads)
        json["reads"] = {{"passed", checks.reads->passed()},
                         {"entries", checks.reads->entries},
                         {"wrong", checks.reads->wrong},
                         {"missed", checks.reads->missed},
                         {"first_wrong", checks.reads->first_wrong}};
    if (checks.bound)
        json["bound"] = {{"passed", checks.bound->passed()},
                         {"promised", checks.bound->promised},
                         {"threshold", checks.bound->threshold},
                         {"deviation", checks.bound->deviation},
                         {"unit", checks.bound->in_picture ? "pixels" : "full scale"},
                         {"points", checks.bound->points},
                         {"text", checks.bound->text()}};
    return json.dump(2) + "\n";
}

}  // namespace tessera

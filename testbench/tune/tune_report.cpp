#include "testbench/tune/tune_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "modules/datapath/height_tests.h"
#include "testbench/job/job_choices.h"
#include "testbench/job/toml_text.h"
#include "testbench/setup/height_tests/height_test_host.h"

namespace tessera {

namespace {

/// Below this fraction of the budget the report has a remark.
constexpr double well_used = 0.97;

std::string goal_text(const TuneRequest& request, const ErrorUnit& unit) {
    const TuneGoal& goal = request.goal;
    if (goal.triangles > 0)
        return fmt::format("the least {} error with at most {} triangles", goal.largest ? "largest" : "RMS",
                           goal.triangles);
    return fmt::format("the fewest triangles with {} error of at most {:.6g} {}s",
                       goal.largest ? "a largest" : "an RMS", goal.error / unit.model_units, unit.name());
}

std::string figures_text(const TunedFigures& figures) {
    return fmt::format("{} triangles; {}: RMS {:.4g}, largest {:.4g} {}s", figures.triangles, figures.what, figures.rms,
                       figures.max, figures.unit);
}

/// "off" or the threshold.
std::string threshold_text(bool on, double threshold) {
    return on ? toml_number(threshold) : "off";
}

std::string height_threshold_text(HeightTest test, const Job::Tests& tests) {
    const std::string threshold = threshold_text(tests.summed_height, tests.threshold(host_of(test).searched()));
    return test == HeightTest::summed_height && tests.summed_height
               ? fmt::format("{}, {}", threshold, name_of(tests.summed_height_unit))
               : threshold;
}

/// The tests that may be in the Summed Height Test's place, and are decided by one threshold.
std::vector<HeightTest> other_height_tests() {
    std::vector<HeightTest> tests;
    for (std::size_t k = 1; k < datapath::height_tests().size(); ++k)
        if (const auto test = static_cast<HeightTest>(k); host_of(test).searched() != nullptr)
            tests.push_back(test);
    return tests;
}

std::string rest_text(const TuneRequest& request, const TunedFigures& figures) {
    const double budget = static_cast<double>(request.goal.triangles);
    const double used = static_cast<double>(figures.triangles) / budget;
    if (request.goal.triangles == 0 || used >= well_used)
        return {};
    return fmt::format(
        "{:.1f} % of the budget is used: with these tests more triangles did not reduce the error, "
        "or the next threshold step gives too many",
        100 * used);
}

std::string base_text(const TuneRequest& request, const TuneResult& result) {
    return request.bases[result.base].name();
}

}  // namespace

std::string tune_text(const TuneRequest& request, const TuneResult& result, const TunedFigures& figures,
                      const ErrorUnit& unit) {
    const Job::Tests& tests = result.point.tests;
    std::string text;
    const auto row = [&](const std::string& name, const std::string& value) {
        text += fmt::format("  {:<24}{}\n", name, value);
    };
    text += fmt::format("tessera tune: {}\n", goal_text(request, unit));
    row("result", figures_text(figures));
    row("base mesh", base_text(request, result));
    row("Normal Test", threshold_text(result.job.tests.normal, tests.normal_threshold));
    if (request.bases[result.base].ranks)
        row(request.goal.largest ? "Bound Test" : "Rank Test",
            toml_number(request.goal.largest ? tests.threshold("bound_threshold") : tests.threshold("rank_threshold")));
    else
        row(functions_of(result.job.hardware.height_test).title(),
            height_threshold_text(result.job.hardware.height_test, tests));
    row("View Test", threshold_text(tests.view, tests.view_threshold));
    row("generation limit", tests.generation ? std::to_string(tests.generation_limit) : "off");
    row("triangulation", std::string(name_of(result.point.triangulation)));
    row("searched", fmt::format("{} base mesh{}, {} meshes", request.bases.size(),
                                request.bases.size() == 1 ? "" : "es", result.evaluations));
    if (const std::string rest = rest_text(request, figures); !rest.empty())
        row("remark", rest);
    return text;
}

std::string tune_comment(const TuneRequest& request, const TuneResult& result, const TunedFigures& figures,
                         const ErrorUnit& unit) {
    return fmt::format("# Tuned by `tessera tune` for {}.\n# {}.\n# Base mesh: {}.\n", goal_text(request, unit),
                       figures_text(figures), base_text(request, result));
}

std::string tune_json(const TuneRequest& request, const TuneResult& result, const TunedFigures& figures,
                      const ErrorUnit& unit) {
    const TuneGoal& goal = request.goal;
    const Job::Tests& tests = result.point.tests;
    const BaseChoice& base = request.bases[result.base];
    nlohmann::ordered_json json;
    if (goal.triangles > 0)
        json["goal"]["triangles"] = goal.triangles;
    else
        json["goal"]["error"] = goal.error / unit.model_units;
    json["goal"]["metric"] = goal.largest ? "max" : "rms";
    json["triangles"] = figures.triangles;
    json["error"] = {{"what", figures.what}, {"unit", figures.unit}, {"rms", figures.rms}, {"max", figures.max}};
    nlohmann::ordered_json& found = json["tests"];
    found = {{"normal", tests.normal},
             {"normal_threshold", tests.normal_threshold},
             {"summed_height", tests.summed_height},
             {"summed_height_threshold", tests.threshold("summed_height_threshold")},
             {"summed_height_unit", name_of(tests.summed_height_unit)}};
    for (const HeightTest test : other_height_tests())
        found[host_of(test).searched()] = tests.threshold(host_of(test).searched());
    found.update({{"rank_threshold", tests.threshold("rank_threshold")},
                  {"bound_threshold", tests.threshold("bound_threshold")},
                  {"view", tests.view},
                  {"view_threshold", tests.view_threshold},
                  {"tex_coord", tests.tex_coord},
                  {"generation", tests.generation},
                  {"generation_limit", tests.generation_limit}});
    json["height_test"] = name_of(result.job.hardware.height_test);
    json["triangulation"] = name_of(result.point.triangulation);
    json["base"] = {{"name", base.name()}};
    if (base.kind != BaseChoice::Kind::job) {
        json["base"]["columns"] = base.columns;
        json["base"]["rows"] = base.rows;
        json["base"]["triangles"] = base.triangles();
    }
    if (base.kind == BaseChoice::Kind::lattice)
        json["base"]["spacing"] = base.spacing;
    json["evaluations"] = result.evaluations;
    return json.dump(2) + "\n";
}

std::string tried_csv(const TuneRequest& request, const TuneResult& result, const ErrorUnit& unit) {
    const std::vector<HeightTest> others = other_height_tests();
    std::string text =
        "base,height_test,normal_threshold,summed_height_threshold,summed_height_unit,view_threshold,generation_limit,"
        "triangulation,";
    for (const HeightTest test : others)
        text += fmt::format("{},", host_of(test).searched());
    text += fmt::format("rank_threshold,bound_threshold,triangles,rms [{0}],max [{0}]\n", unit.name());
    for (const TriedPoint& tried : result.tried) {
        const Job::Tests& tests = tried.point.tests;
        const Outcome& outcome = tried.point.outcome;
        const BaseChoice& base = request.bases[tried.base];
        const HeightTest kind = base.ranks ? HeightTest::rank : request.job.hardware.height_test;
        const auto of = [&](HeightTest test, double threshold, bool used = true) {
            return threshold_text(tests.summed_height && kind == test && used, threshold);
        };
        text += fmt::format("\"{}\",{},{},{},{},{},{},{},", base.name(), name_of(kind),
                            threshold_text(tests.normal, tests.normal_threshold),
                            of(HeightTest::summed_height, tests.threshold("summed_height_threshold")),
                            name_of(tests.summed_height_unit), threshold_text(tests.view, tests.view_threshold),
                            tests.generation_limit, name_of(tried.point.triangulation));
        for (const HeightTest test : others)
            text += of(test, tests.threshold(host_of(test).searched())) + ",";
        text += fmt::format("{},{},{},{:.6g},{:.6g}\n",
                            of(HeightTest::rank, tests.threshold("rank_threshold"), !request.goal.largest),
                            of(HeightTest::rank, tests.threshold("bound_threshold"), request.goal.largest),
                            outcome.triangles, outcome.rms / unit.model_units, outcome.max / unit.model_units);
    }
    return text;
}

}  // namespace tessera

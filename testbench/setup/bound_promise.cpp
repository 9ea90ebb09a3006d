#include "testbench/setup/bound_promise.h"

#include <fmt/format.h>

#include <cmath>

#include "modules/datapath/rank.h"
#include "testbench/setup/tables/rank_table.h"

namespace tessera {

namespace {

BoundFacts facts_of(const SceneSettings& settings, const BaseMesh& mesh, const PreparedScene& scene) {
    const datapath::Formats& formats = scene.registers.formats;
    const RankTables& tables = scene.rank_tables;
    const bool ranks = settings.height_test == datapath::HeightTest::rank;
    constexpr double whole_map = 65536;  // codes
    BoundFacts facts;
    facts.tests = settings.tests;
    facts.height_test = settings.height_test;
    facts.triangulation = settings.triangulation;
    facts.culling = settings.culling != Culling::none;
    facts.fitted = scene.heights() != scene.map.codes;
    facts.lattice = mesh.beyond_map;
    facts.closed = tables.clashes == 0 && !tables.beyond_period;
    facts.reaches_all = tables.clashes > 0 || tables.least_error == 0;
    facts.in_picture = settings.tests.rank_view != RankView::none;
    facts.bound_bits = static_cast<int>(settings.formats.bound_bits);
    if (ranks && facts.bound_bits > 0) {
        facts.in_order = tables.highest_bound_threshold >= bound_threshold(whole_map, formats.bound_bits);
        facts.generations = tables.highest_generation(
            formats.distances ? 0 : scene.registers.tests.height_thresholds[datapath::bound_number]);
        facts.least_threshold =
            (scene.map.rounding + bound_error(0, formats.bound_bits)) / static_cast<double>(scene.map.highest_code());
    }
    return facts;
}

/// With the least threshold, rounded up, where that is the setting.
std::string remedy(const BoundCondition& condition, const BoundFacts& facts) {
    if (&condition != &bound_conditions.back())
        return condition.setting;
    const double step = std::pow(10, std::floor(std::log10(facts.least_threshold)) - 2);
    return fmt::format("tests.bound_threshold = {:.3g}, or raise formats.displacement_bits",
                       std::ceil(facts.least_threshold / step) * step);
}

}  // namespace

std::string as_text(const BoundCondition& condition) {
    const std::string where = condition.where;
    return condition.setting + (where.empty() ? "" : " (" + where + ")");
}

bool asks_for_bound(const SceneSettings& settings) {
    const bool has_table = settings.height_test == datapath::HeightTest::rank && settings.formats.bound_bits > 0;
    return has_table || settings.tests.threshold("bound_threshold") != TestSettings{}.threshold("bound_threshold");
}

std::vector<const BoundCondition*> broken_bound_conditions(const SceneSettings& settings, const BaseMesh& mesh,
                                                           const PreparedScene& scene) {
    std::vector<const BoundCondition*> broken;
    if (!asks_for_bound(settings))
        return broken;
    const BoundFacts facts = facts_of(settings, mesh, scene);
    for (const BoundCondition& condition : bound_conditions)
        if (!condition.met(facts))
            broken.push_back(&condition);
    return broken;
}

void remark_on_bound(const SceneSettings& settings, const BaseMesh& mesh, PreparedScene& scene) {
    const BoundFacts facts = facts_of(settings, mesh, scene);
    std::string reasons;
    scene.bound_asked = asks_for_bound(settings);
    for (const BoundCondition* condition : broken_bound_conditions(settings, mesh, scene))
        reasons += fmt::format("{}{} (set {})", reasons.empty() ? "" : "; ", condition->why, remedy(*condition, facts));
    scene.bound_promised = scene.bound_asked && reasons.empty();
    if (!reasons.empty())
        scene.remarks.push_back(fmt::format("tests.bound_threshold = {} is not guaranteed{}: {}",
                                            settings.tests.threshold("bound_threshold"),
                                            facts.in_picture ? " in the picture" : "", reasons));
}

}  // namespace tessera

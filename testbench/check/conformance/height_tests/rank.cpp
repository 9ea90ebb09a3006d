#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "golden/height_tests/rank_table.h"
#include "golden/height_tests/rank_test.h"
#include "modules/datapath/rank.h"
#include "testbench/check/conformance/height_test_check.h"

namespace tessera {

using namespace setup_check;

namespace {

golden::RankTable table_of(const RankTables& ranks, int texture_fraction) {
    std::vector<glm::dvec2> midpoints;
    midpoints.reserve(ranks.midpoints.size());
    for (const datapath::TexCoord& t : ranks.midpoints)
        midpoints.push_back(glm::dvec2(t.u, t.v) * std::ldexp(1.0, -texture_fraction));
    return {ranks.columns,       ranks.rows,   ranks.rank,
            ranks.bound,         ranks.radius, static_cast<int>(ranks.highest_bound_threshold),
            std::move(midpoints)};
}

golden::RankView golden_view(RankView view) {
    return view == RankView::per_point   ? golden::RankView::per_point
           : view == RankView::per_pixel ? golden::RankView::per_pixel
                                         : golden::RankView::none;
}

/// Of a rank's and a bound's threshold, by an octave of distance, as seen.
double rank_per_octave(golden::RankView view) {
    return view == golden::RankView::per_pixel ? 4096 : 2048;
}
constexpr double bound_per_octave = 2048;

/// As seen, the registers' thresholds hold at D_i + D_j = 1 LSB, golden's at a mean distance of 1: they differ by these
/// octaves and by the position of the binary point.
int octaves_of_step(const datapath::Formats& formats) {
    return formats.view_distance.fraction + 1;
}

/// Largest difference of a map's value and its code, in codes.
double code_rounding(const GoldenJob& golden) {
    double largest = 0;
    const auto texels =
        static_cast<std::size_t>(golden.map().width()) * static_cast<std::size_t>(golden.map().height());
    for (std::size_t texel = 0; texel < texels; ++texel) {
        const double code = golden.unrounded_code(texel);
        largest = std::max(largest, std::abs(std::floor(code + 0.5) - code));
    }
    return largest;
}

const golden::RankTest& test_of(const GoldenJob& golden) {
    return *golden::height_test_of<golden::RankTest>(golden.map());
}

/// The Rank Table that golden derives, empty if midpoints share entries. Reports an invalid order.
golden::DerivedRanks derived_ranks(const MachineSetup& setup, const GoldenJob& golden, SetupResult& result) {
    const golden::RankTable& table = test_of(golden).table();
    const golden::RankSettings& settings = test_of(golden).settings();
    golden::RankSource source;
    source.base = base_texels(setup, golden, result);
    Judge judge(result, "table's extent", "texels that the base mesh covers; the order of bisections");
    judge_extent(judge, source.base, golden.map(), table.columns, table.rows);
    source.columns = table.columns;
    source.rows = table.rows;
    source.midpoints = table.midpoints;
    std::vector<std::size_t> sorted;
    for (const glm::dvec2& midpoint : source.midpoints)
        sorted.push_back(source.entry(midpoint));
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
        return {};
    source.rank_bits = settings.rank_bits;
    source.bound_bits = settings.bound_bits;
    const auto entries = static_cast<std::size_t>(source.columns * source.rows);
    judge.require(sorted.empty() || sorted.back() < entries,
                  [] { return std::string("a bisection beyond the table"); });
    if (!sorted.empty() && sorted.back() >= entries)
        return {};
    if (settings.view != golden::RankView::none && source.bound_bits > 0) {
        const double last_place = std::ldexp(1.0, -golden.view_distance_fraction());
        source.radii = true;
        source.steps = glm::dvec3(golden.texel_size(), std::abs(golden.parameters().scale)) / last_place;
        source.rounding = 4 + 32 * std::sqrt(3.0) *
                                  std::ldexp(1.0, -static_cast<int>(golden.job().formats.position_fraction)) /
                                  last_place;
    }
    golden::DerivedRanks ranks = golden::derive_ranks(golden.map(), source);
    if (ranks.shared)
        return {};
    judge.require(ranks.fault.empty(), [&] { return ranks.fault; });
    if (source.bound_bits > 0 && ranks.fault.empty())
        judge.judge("highest_bound_threshold", table.highest_bound_threshold, ranks.highest_bound_threshold.low,
                    {0, ranks.highest_bound_threshold.high - ranks.highest_bound_threshold.low});
    return ranks;
}

class RankCheck : public HeightTestCheck {
  public:
    Golden of_machine(const MachineSetup& setup, const golden::Map&) const override {
        const datapath::Formats& formats = setup.registers.formats;
        const datapath::TestParameters& tests = setup.registers.tests;
        golden::RankSettings settings{number(tests.height_thresholds[datapath::rank_number]),
                                      number(tests.height_thresholds[datapath::bound_number]), formats.rank_bits,
                                      formats.bound_bits, golden::RankView::none};
        if (formats.distances) {
            settings.view = tests.rank_per_pixel ? golden::RankView::per_pixel : golden::RankView::per_point;
            settings.rank_threshold += octaves_of_step(formats) * rank_per_octave(settings.view);
            settings.bound_threshold += octaves_of_step(formats) * bound_per_octave;
        }
        return std::make_shared<golden::RankTest>(table_of(setup.rank_tables, formats.texture.fraction), settings);
    }
    Golden of_job(const GoldenJob& golden, const TakenFromHost& taken) const override {
        const TestSettings& tests = golden.job().tests;
        const Job::Formats& formats = golden.job().formats;
        golden::RankSettings settings = golden::on_scales(
            {tests.threshold("rank_threshold"), tests.threshold("bound_threshold"), static_cast<int>(formats.rank_bits),
             static_cast<int>(formats.bound_bits), golden_view(tests.rank_view)},
            golden.scene(), formats.bound_bits > 0 ? code_rounding(golden) : 0);
        golden::RankTable table = table_of(taken.rank_tables, static_cast<int>(formats.texture_fraction));
        if (settings.view == golden::RankView::none)
            settings.bound_threshold = std::min(settings.bound_threshold, number(table.highest_bound_threshold));
        return std::make_shared<golden::RankTest>(std::move(table), settings);
    }

    void check_thresholds(const datapath::Registers& registers, const GoldenJob& golden, Judge& judge) const override {
        const datapath::TestParameters& tests = registers.tests;
        const datapath::Formats& formats = registers.formats;
        const golden::RankSettings& settings = test_of(golden).settings();
        const bool seen = settings.view != golden::RankView::none;
        const auto threshold = [&](const char* name, std::int64_t hardware, double golden_threshold, double per_octave,
                                   int entry_bits, int seen_bits) {
            const double most = std::ldexp(1.0, seen_bits - 1);
            if (!seen)
                judge.judge(name, number(hardware), golden_threshold, rounded_down,
                            double_rounding * std::ldexp(1.0, entry_bits));
            else if (entry_bits > 0)
                judge.judge(name, number(hardware),
                            std::clamp(golden_threshold - octaves_of_step(formats) * per_octave, -most, most - 1),
                            rounded_down, double_rounding * most + 2 * per_octave * golden.texel_rounding());
        };
        threshold("tests.rank_threshold", tests.height_thresholds[datapath::rank_number], settings.rank_threshold,
                  rank_per_octave(settings.view), formats.rank_bits, datapath::rank_limit_bits);
        threshold("tests.bound_threshold", tests.height_thresholds[datapath::bound_number], settings.bound_threshold,
                  bound_per_octave, formats.bound_bits, datapath::bound_limit_bits);
        if (seen)
            judge.judge("tests.rank_per_pixel", number(tests.rank_per_pixel),
                        number(settings.view == golden::RankView::per_pixel), exact);
    }
    void check_layout(const datapath::Registers& registers, const GoldenJob& golden, Judge& judge) const override {
        const golden::RankTable& table = test_of(golden).table();
        const Job::Formats& formats = golden.job().formats;
        const bool radii = registers.formats.distances && formats.bound_bits > 0;
        judge_layout(judge, "rank_table", registers.height_table, number(table.columns), number(table.rows),
                     static_cast<int>(formats.rank_bits + formats.bound_bits) + (radii ? datapath::radius_bits : 0));
        judge.judge("rank_table.columns", registers.covered.columns, number(table.columns), exact);
        judge.judge("rank_table.rows", registers.covered.rows, number(table.rows), exact);
    }
    TableCheck table_check(const MachineSetup& setup, const GoldenJob& golden, SetupResult& result) const override {
        return [&, ranks = derived_ranks(setup, golden, result)](Host& host) {
            check_entries(setup.registers.height_table, golden, ranks, host, result);
        };
    }

  private:
    static void check_entries(const datapath::TableLayout& layout, const GoldenJob& golden,
                              const golden::DerivedRanks& ranks, Host& host, SetupResult& result) {
        const golden::RankTable& table = test_of(golden).table();
        const golden::RankSettings& settings = test_of(golden).settings();
        const bool derived = !ranks.ranks.empty() || !ranks.bounds.empty();
        Judge judge(result, "rank table",
                    derived ? "every rank, bound and radius; of a double's error, both sides"
                            : "every entry, as ranked by the host, since midpoints share entries");
        each_entry(judge, host.summed_height_table, layout, number(table.columns), number(table.rows),
                   [&](std::uint32_t x, std::uint32_t y, std::uint64_t entry) {
                       const std::size_t k = std::size_t{y} * static_cast<std::size_t>(table.columns) + x;
                       const auto field = [&](const char* name, int bits, const auto& given,
                                              const std::vector<golden::EntryRange>& ranges) {
                           if (bits == 0)
                               return;
                           const std::uint64_t value = entry & ((std::uint64_t{1} << bits) - 1);
                           entry >>= bits;
                           const golden::EntryRange range =
                               derived ? ranges[k] : golden::EntryRange{number(given[k]), number(given[k])};
                           judge.judge([&] { return fmt::format("({}, {}).{}", x, y, name); }, number(value), range.low,
                                       {0, range.high - range.low});
                       };
                       field("rank", settings.rank_bits, table.ranks, ranks.ranks);
                       field("bound", settings.bound_bits, table.bounds, ranks.bounds);
                       field("radius", table.radii.empty() ? 0 : datapath::radius_bits, table.radii, ranks.radii);
                       judge.require(entry == 0, [&] { return fmt::format("({}, {}) has other bits", x, y); });
                   });
    }
};

}  // namespace

template <>
const HeightTestCheck& check_part<datapath::RankTest>() {
    static const RankCheck check;
    return check;
}

}  // namespace tessera

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "golden/height_tests/curvature_test.h"
#include "modules/datapath/curvature.h"
#include "testbench/check/conformance/height_test_check.h"

namespace tessera {

using namespace setup_check;

namespace {

HeightTestCheck::Golden test_of(const CurvatureTable& given, double threshold) {
    golden::CurvatureTable table{given.covered.width, given.covered.height, {}};
    for (const std::uint64_t packed : given.entries) {
        const datapath::CurvatureEntry entry = datapath::unpack_curvature(packed);
        const double unit = std::ldexp(1.0, entry.exponent - datapath::curvature_fraction);
        table.cells.push_back({entry.xx * unit, entry.xy * unit, entry.yy * unit, entry.rest * unit, unit});
    }
    return std::make_shared<golden::CurvatureTest>(std::move(table), threshold);
}

const golden::CurvatureTable& table_of(const GoldenJob& golden) {
    return golden::height_test_of<golden::CurvatureTest>(golden.map())->table();
}

class CurvatureCheck : public HeightTestCheck {
  public:
    Golden of_machine(const MachineSetup& setup, const golden::Map&) const override {
        return test_of(setup.curvature_table,
                       std::ldexp(number(setup.registers.tests.height_thresholds[0]), -datapath::curvature_fraction));
    }
    Golden of_job(const GoldenJob& golden, const TakenFromHost& taken) const override {
        return test_of(taken.curvature_table,
                       golden.job().tests.threshold("curvature_threshold") * golden.scene().highest_code);
    }

    void check_thresholds(const datapath::Registers& registers, const GoldenJob& golden, Judge& judge) const override {
        judge.judge("tests.curvature_threshold", number(registers.tests.height_thresholds[0]),
                    golden::height_test_of<golden::CurvatureTest>(golden.map())->threshold() * 8, rounded_down);
    }
    void check_layout(const datapath::Registers& registers, const GoldenJob& golden, Judge& judge) const override {
        const golden::CurvatureTable& table = table_of(golden);
        judge_layout(judge, "curvature_table", registers.height_table, number(table.cells.size()), 1, 36);
        judge.judge("curvature_table.columns", registers.covered.columns, number(table.columns), exact);
        judge.judge("curvature_table.rows", registers.covered.rows, number(table.rows), exact);
    }
    TableCheck table_check(const MachineSetup& setup, const GoldenJob& golden, SetupResult& result) const override {
        Judge extent(result, "table's extent", "texels that the base mesh covers");
        const golden::CurvatureTable& table = table_of(golden);
        judge_extent(extent, base_texels(setup, golden, result), golden.map(), table.columns, table.rows);
        return [&](Host& host) { check_cells(setup.registers.height_table, golden, host, result); };
    }

  private:
    static void check_cells(const datapath::TableLayout& layout, const GoldenJob& golden, Host& host,
                            SetupResult& result) {
        Judge judge(result, "curvature table",
                    "every quadratic and its rest, to nearest, in the smallest unit that fits");
        const golden::CurvatureTable& table = table_of(golden);
        std::vector<std::array<std::int64_t, 3>> cells;  // column, row, reach
        for (std::int64_t reach = 2;; reach *= 2) {
            const auto nearest = [&](std::int64_t texel) { return (texel + reach / 2) / reach; };
            for (std::int64_t row = 0; row <= nearest(table.rows - 1); ++row)
                for (std::int64_t column = 0; column <= nearest(table.columns - 1); ++column)
                    cells.push_back({column * reach, row * reach, reach});
            if (2 * reach >= std::max(table.columns, table.rows))
                break;
        }
        each_entry(judge, host.summed_height_table, layout, number(cells.size()), 1,
                   [&](std::uint32_t x, std::uint32_t, std::uint64_t entry) {
                       const auto [column, row, reach] = cells[x];
                       const golden::Curvature cell = golden::fit_curvature(golden.map(), column, row, reach);
                       const datapath::CurvatureEntry found = datapath::unpack_curvature(entry);
                       const double unit = std::ldexp(1.0, found.exponent - datapath::curvature_fraction);
                       constexpr double leeway = 0.02;  // of a unit, for sums of squares in doubles
                       const auto field = [&](const char* name, double hardware, double golden_value) {
                           judge.judge([&] { return fmt::format("{}.{}", x, name); }, hardware, golden_value / unit,
                                       to_nearest, leeway);
                       };
                       field("xx", found.xx, cell.xx);
                       field("xy", found.xy, cell.xy);
                       field("yy", found.yy, cell.yy);
                       field("rest", found.rest, cell.rest);
                       const double largest = std::max({std::abs(cell.xx), std::abs(cell.xy), std::abs(cell.yy)});
                       const double smaller = unit / 2;
                       const bool fits = largest / smaller < 127.5 - leeway && cell.rest / smaller < 255.5 - leeway;
                       judge.require(found.exponent == 0 || !fits,
                                     [&] { return fmt::format("{}.unit = {}, and a smaller one fits", x, unit); });
                   });
    }
};

}  // namespace

template <>
const HeightTestCheck& check_part<datapath::CurvatureTest>() {
    static const CurvatureCheck check;
    return check;
}

}  // namespace tessera

#include <cmath>
#include <cstdint>

#include "golden/height_tests/summed_height_test.h"
#include "testbench/check/conformance/height_test_check.h"

namespace tessera {

using namespace setup_check;

namespace {

class SummedHeightCheck : public HeightTestCheck {
  public:
    Golden of_machine(const MachineSetup& setup, const golden::Map&) const override {
        const datapath::TestParameters& tests = setup.registers.tests;
        const bool area = tests.summed_height_unit == SummedHeightUnit::area;
        // With the `sum` unit, the register holds four times the threshold.
        return std::make_shared<golden::SummedHeightTest>(std::ldexp(number(tests.height_thresholds[0]), area ? 0 : -2),
                                                          area);
    }
    Golden of_job(const GoldenJob& golden, const TakenFromHost&) const override {
        return std::make_shared<golden::SummedHeightTest>(threshold(golden), area(golden));
    }

    void check_thresholds(const datapath::Registers& registers, const GoldenJob& golden, Judge& judge) const override {
        judge.judge("tests.summed_height_threshold", number(registers.tests.height_thresholds[0]),
                    threshold(golden) * (area(golden) ? 1 : 4), rounded_down);
    }
    void check_layout(const datapath::Registers& registers, const GoldenJob& golden, Judge& judge) const override {
        judge_layout(judge, "summed_height_table", registers.height_table, golden.map().width() + 1,
                     golden.map().height() + 1, registers.formats.summed_height.bits);
    }
    TableCheck table_check(const MachineSetup& setup, const GoldenJob& golden, SetupResult& result) const override {
        return [&](Host& host) {
            Judge judge(result, "summed height table", "every sum of codes, exact modulo 2^bits");
            const golden::Map& map = golden.map();
            const auto mask = static_cast<std::uint64_t>(setup.registers.formats.summed_height.highest);
            each_entry(judge, host.summed_height_table, setup.registers.height_table, map.width() + 1, map.height() + 1,
                       [&](std::uint32_t x, std::uint32_t y, std::uint64_t sum) {
                           judge.judge([&] { return fmt::format("({}, {})", x, y); }, number(sum),
                                       number(map.sum({0, 0, x, y}) & mask), exact);
                       });
        };
    }

  private:
    static double threshold(const GoldenJob& golden) {
        return golden.job().tests.threshold("summed_height_threshold") * golden.scene().highest_code;
    }
    static bool area(const GoldenJob& golden) {
        return golden.job().tests.summed_height_unit == SummedHeightUnit::area;
    }
};

}  // namespace

template <>
const HeightTestCheck& check_part<datapath::SummedHeightTest>() {
    static const SummedHeightCheck check;
    return check;
}

}  // namespace tessera

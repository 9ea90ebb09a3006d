#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "golden.h"
#include "testbench/check/conformance/height_test_check.h"

namespace range_test {

/// Golden's test, from the machine's registers and from the job, and what a run compares before it starts.
class RangeCheck : public tessera::HeightTestCheck {
  public:
    Golden of_machine(const tessera::MachineSetup& setup, const tessera::golden::Map& map) const override {
        return std::make_shared<GoldenRange>(map, static_cast<double>(setup.registers.tests.height_thresholds[0]));
    }
    Golden of_job(const tessera::GoldenJob& golden, const tessera::TakenFromHost&) const override {
        return std::make_shared<GoldenRange>(
            golden.map(), golden.job().tests.threshold("range_threshold") * golden.scene().highest_code);
    }

    void check_thresholds(const tessera::datapath::Registers& registers, const tessera::GoldenJob& golden,
                          tessera::setup_check::Judge& judge) const override {
        judge.judge("tests.range_threshold", static_cast<double>(registers.tests.height_thresholds[0]),
                    test_of(golden).threshold(), tessera::setup_check::rounded_down);
    }
    void check_layout(const tessera::datapath::Registers& registers, const tessera::GoldenJob& golden,
                      tessera::setup_check::Judge& judge) const override {
        tessera::setup_check::judge_layout(judge, "range_table", registers.height_table,
                                           static_cast<double>(ranges_of(golden).size()), 1,
                                           2 * registers.formats.displacement.bits);
    }
    TableCheck table_check(const tessera::MachineSetup& setup, const tessera::GoldenJob& golden,
                           tessera::SetupResult& result) const override {
        return [&](tessera::Host& host) {
            tessera::setup_check::Judge judge(result, "range table", "every block's lowest and highest code");
            const std::vector<GoldenRange::Range> ranges = ranges_of(golden);
            const int bits = setup.registers.formats.displacement.bits;
            tessera::setup_check::each_entry(
                judge, host.summed_height_table, setup.registers.height_table, static_cast<double>(ranges.size()), 1,
                [&](std::uint32_t x, std::uint32_t, std::uint64_t entry) {
                    const auto name = [&] { return std::to_string(x); };
                    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
                    judge.judge(name, static_cast<double>(entry & mask), ranges[x].lowest, tessera::setup_check::exact);
                    judge.judge(name, static_cast<double>(entry >> bits), ranges[x].highest,
                                tessera::setup_check::exact);
                });
        };
    }

  private:
    static const GoldenRange& test_of(const tessera::GoldenJob& golden) {
        return *tessera::golden::height_test_of<GoldenRange>(golden.map());
    }
    static std::vector<GoldenRange::Range> ranges_of(const tessera::GoldenJob& golden) {
        std::vector<GoldenRange::Range> all;
        for (const auto& level : test_of(golden).levels())
            all.insert(all.end(), level.begin(), level.end());
        return all;
    }
};

}  // namespace range_test

#include <cmath>
#include <cstdint>
#include <vector>

#include "golden/height_tests/mipmap_test.h"
#include "testbench/check/conformance/height_test_check.h"

namespace tessera {

using namespace setup_check;

namespace {

HeightTestCheck::Golden test_of(const golden::Map& map, MipmapFilter filter, double threshold) {
    return std::make_shared<golden::MipmapTest>(
        map, filter == MipmapFilter::maximum ? golden::MipmapFilter::maximum : golden::MipmapFilter::mean, threshold);
}

/// Heights of all levels in succession.
std::vector<double> blocks_of(const golden::Map& map) {
    std::vector<double> blocks;
    for (const std::vector<double>& level : golden::height_test_of<golden::MipmapTest>(map)->levels())
        blocks.insert(blocks.end(), level.begin(), level.end());
    return blocks;
}

class MipmapCheck : public HeightTestCheck {
  public:
    Golden of_machine(const MachineSetup& setup, const golden::Map& map) const override {
        return test_of(map, setup.mipmap_table.filter,
                       std::ldexp(number(setup.registers.tests.height_thresholds[0]), -1));
    }
    /// The filter as the job has it, not as the host.
    Golden of_job(const GoldenJob& golden, const TakenFromHost&) const override {
        const TestSettings& tests = golden.job().tests;
        return test_of(golden.map(), tests.mipmap_filter,
                       tests.threshold("mipmap_threshold") * golden.scene().highest_code);
    }

    void check_thresholds(const datapath::Registers& registers, const GoldenJob& golden, Judge& judge) const override {
        judge.judge("tests.mipmap_threshold", number(registers.tests.height_thresholds[0]),
                    golden::height_test_of<golden::MipmapTest>(golden.map())->threshold() * 2, rounded_down);
    }
    void check_layout(const datapath::Registers& registers, const GoldenJob& golden, Judge& judge) const override {
        judge_layout(judge, "mipmap_table", registers.height_table, number(blocks_of(golden.map()).size()), 1,
                     registers.formats.displacement.bits);
    }
    TableCheck table_check(const MachineSetup& setup, const GoldenJob& golden, SetupResult& result) const override {
        return [&](Host& host) {
            Judge judge(result, "mipmap table", "every block's mean, to nearest, or maximum");
            const std::vector<double> blocks = blocks_of(golden.map());
            each_entry(judge, host.summed_height_table, setup.registers.height_table, number(blocks.size()), 1,
                       [&](std::uint32_t x, std::uint32_t, std::uint64_t entry) {
                           judge.judge([&] { return fmt::format("{}", x); }, number(entry), blocks[x], exact);
                       });
        };
    }
};

}  // namespace

template <>
const HeightTestCheck& check_part<datapath::MipmapTest>() {
    static const MipmapCheck check;
    return check;
}

}  // namespace tessera

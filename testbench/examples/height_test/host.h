#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "blocks.h"
#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/setup/height_tests/table_rows.h"
#include "testbench/setup/threshold_register.h"

namespace range_test {

/// The host's part: the threshold's key and register, and the table.
class RangeHost : public tessera::HeightTestHost {
  public:
    const char* meaning() const override {
        return "an edge requests a split if the heights around it differ by more than the threshold";
    }
    const std::vector<tessera::HeightThresholdKey>& thresholds() const override {
        static const std::vector<tessera::HeightThresholdKey> keys{
            {"range_threshold", 0.05, "full scale", tessera::between(0, 1),
             "With hardware.height_test = \"range\": an edge requests a split if the heights around it differ by more"}};
        return keys;
    }
    void set_thresholds(const tessera::TestSettings& tests, const tessera::datapath::Formats& formats,
                        const tessera::ViewedScale&, tessera::datapath::TestParameters& registers) const override {
        const auto highest = static_cast<double>(formats.displacement.highest);
        registers.height_thresholds[0] =
            tessera::to_register({"tests.range_threshold", tests.threshold("range_threshold"), tests.summed_height,
                                  highest, highest, "formats.displacement_bits"});
    }
    void write_table(const tessera::PreparedScene& scene, const tessera::TableSink& sink) const override {
        const tessera::QuantisedMap& map = scene.map;
        std::vector<std::uint64_t> lowest(map.codes.begin(), map.codes.end()), highest = lowest, entries;
        for (int level = 0;; ++level) {
            for (std::size_t k = 0; k < lowest.size(); ++k)
                entries.push_back(lowest[k] | highest[k] << map.bits);
            if (level == highest_level(map.geometry))
                break;
            const Blocks fine = blocks_of(level, map.geometry), coarse = blocks_of(level + 1, map.geometry);
            std::vector<std::uint64_t> low(std::size_t{coarse.columns} * coarse.rows, ~std::uint64_t{0});
            std::vector<std::uint64_t> high(low.size(), 0);
            for (std::uint32_t y = 0; y < fine.rows; ++y)
                for (std::uint32_t x = 0; x < fine.columns; ++x) {
                    const std::size_t from = std::size_t{y} * fine.columns + x;
                    const std::size_t to = std::size_t{y / 2} * coarse.columns + x / 2;
                    low[to] = std::min(low[to], lowest[from]);
                    high[to] = std::max(high[to], highest[from]);
                }
            lowest = low;
            highest = high;
        }
        tessera::write_rows(scene.registers.height_table, sink,
                            [&](std::uint32_t x, std::uint32_t) { return entries[x]; });
    }

    const char* searched() const override { return "range_threshold"; }
    Range range(const tessera::PreparedScene& scene, tessera::datapath::SummedHeightUnit) const override {
        return {1 / static_cast<double>(scene.map.highest_code()), 1};
    }
};

}  // namespace range_test

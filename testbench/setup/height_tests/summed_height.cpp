#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/setup/height_tests/table_rows.h"
#include "testbench/setup/threshold_register.h"

namespace tessera {

namespace {

class SummedHeightHost : public HeightTestHost {
  public:
    const char* meaning() const override { return "the paper's Summed Height Test"; }
    const std::vector<HeightThresholdKey>& thresholds() const override {
        static const std::vector<HeightThresholdKey> keys{
            {"summed_height_threshold", 0.03, "full-scale texels (sum), full scale (area)", between(0, 1e9),
             "Summed Height Test: an edge requests a split if S_ij / 2 and (S_i + S_j) / 4 differ by more (sum), or if 2 S_ij and S_i + S_j differ by more than the threshold times the rectangle's area (area)"}};
        return keys;
    }
    /// sum: compared with |2 S_ij - S_i - S_j|, four times the paper's difference.
    void set_thresholds(const TestSettings& tests, const datapath::Formats& formats, const ViewedScale&,
                        datapath::TestParameters& registers) const override {
        const bool area = tests.summed_height_unit == datapath::SummedHeightUnit::area;
        registers.height_thresholds[0] =
            to_register({"tests.summed_height_threshold", tests.threshold("summed_height_threshold"),
                         tests.summed_height, static_cast<double>(formats.displacement.highest) * (area ? 1 : 4),
                         area ? std::ldexp(1.0, 18) : std::ldexp(1.0, 50), "formats.displacement_bits",
                         datapath::FormatLimits::displacement_bits.most - formats.displacement.bits});
    }
    void write_table(const PreparedScene& scene, const TableSink& sink) const override {
        const datapath::TableLayout& layout = scene.registers.height_table;
        const auto mask = static_cast<std::uint64_t>(scene.registers.formats.summed_height.highest);
        std::vector<std::uint64_t> below(layout.columns, 0);
        std::uint64_t along = 0;
        write_rows(layout, sink, [&](std::uint32_t x, std::uint32_t y) -> std::uint64_t {
            if (x == 0)
                along = 0;
            if (x == 0 || y == 0)
                return 0;
            along += scene.map.code(x - 1, y - 1);
            return below[x] = (below[x] + along) & mask;
        });
    }

    const char* searched() const override { return "summed_height_threshold"; }
    Range range(const PreparedScene& scene, datapath::SummedHeightUnit unit) const override {
        const auto highest_code = static_cast<double>(scene.map.highest_code());
        if (unit == datapath::SummedHeightUnit::area)
            return {1 / highest_code, 2};
        const double largest = static_cast<double>(scene.largest_rectangle_sum) / highest_code / 2;
        return {1 / highest_code / 4, std::max(largest, 1.0)};
    }
};

}  // namespace

template <>
const HeightTestHost& host_part<datapath::SummedHeightTest>() {
    static const SummedHeightHost host;
    return host;
}

}  // namespace tessera

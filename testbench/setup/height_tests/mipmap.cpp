#include <cmath>
#include <cstdint>
#include <vector>

#include "modules/datapath/mipmap.h"
#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/setup/height_tests/table_rows.h"
#include "testbench/setup/tables/mipmap_table.h"
#include "testbench/setup/threshold_register.h"

namespace tessera {

namespace {

class MipmapHost : public HeightTestHost {
  public:
    const char* meaning() const override {
        return "compares heights of the map filtered to the edge's length, the alternative that the paper discusses";
    }
    const std::vector<HeightThresholdKey>& thresholds() const override {
        static const std::vector<HeightThresholdKey> keys{
            {"mipmap_threshold", 0.02, "full scale", between(0, 1),
             "With hardware.height_test = \"mipmap\": an edge requests a split if the filtered height at its midpoint deviates by more from the mean of those at its ends"}};
        return keys;
    }
    /// Compared with |2 M_ij - M_i - M_j|, twice the height.
    void set_thresholds(const TestSettings& tests, const datapath::Formats& formats, const ViewedScale&,
                        datapath::TestParameters& registers) const override {
        registers.height_thresholds[0] =
            to_register({"tests.mipmap_threshold", tests.threshold("mipmap_threshold"), tests.summed_height,
                         2 * static_cast<double>(formats.displacement.highest),
                         std::ldexp(1.0, datapath::mipmap_threshold_bits(formats)) - 1, "formats.displacement_bits",
                         datapath::FormatLimits::displacement_bits.most - formats.displacement.bits});
    }
    void make_table(const TestSettings& tests, const std::vector<TextureTriangle>&,
                    PreparedScene& scene) const override {
        scene.mipmap_table = make_mipmap_table(scene.map, tests.mipmap_filter);
    }
    void write_table(const PreparedScene& scene, const TableSink& sink) const override {
        write_rows(scene.registers.height_table, sink,
                   [&](std::uint32_t x, std::uint32_t) { return std::uint64_t{scene.mipmap_table.entries[x]}; });
    }

    const char* searched() const override { return "mipmap_threshold"; }
    Range range(const PreparedScene& scene, datapath::SummedHeightUnit) const override {
        return {1 / static_cast<double>(scene.map.highest_code()) / 2, 1};
    }
};

}  // namespace

template <>
const HeightTestHost& host_part<datapath::MipmapTest>() {
    static const MipmapHost host;
    return host;
}

}  // namespace tessera

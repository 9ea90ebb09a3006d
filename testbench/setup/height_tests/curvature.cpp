#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "modules/datapath/curvature.h"
#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/setup/height_tests/table_rows.h"
#include "testbench/setup/tables/curvature_table.h"
#include "testbench/setup/threshold_register.h"

namespace tessera {

namespace {

class CurvatureHost : public HeightTestHost {
  public:
    const char* meaning() const override {
        return "the host fits quadratics to the map, for any base mesh, and an edge requests a split if they deviate from its chord";
    }
    const std::vector<HeightThresholdKey>& thresholds() const override {
        static const std::vector<HeightThresholdKey> keys{
            {"curvature_threshold", 0.1, "full scale times texels", between(0, 1e9),
             "With hardware.height_test = \"curvature\": an edge requests a split if the map deviates from its chord by more than the threshold divided by the edge's length in texels, rounded up to a power of two"}};
        return keys;
    }
    void set_thresholds(const TestSettings& tests, const datapath::Formats& formats, const ViewedScale&,
                        datapath::TestParameters& registers) const override {
        registers.height_thresholds[0] =
            to_register({"tests.curvature_threshold", tests.threshold("curvature_threshold"), tests.summed_height,
                         std::ldexp(static_cast<double>(formats.displacement.highest), datapath::curvature_fraction),
                         std::ldexp(1.0, datapath::curvature_threshold_bits(formats)) - 1, "formats.displacement_bits",
                         datapath::FormatLimits::displacement_bits.most - formats.displacement.bits});
    }
    void make_table(const TestSettings&, const std::vector<TextureTriangle>& base,
                    PreparedScene& scene) const override {
        scene.curvature_table = make_curvature_table(scene.map, base, scene.registers.formats);
    }
    void write_table(const PreparedScene& scene, const TableSink& sink) const override {
        write_rows(scene.registers.height_table, sink,
                   [&](std::uint32_t x, std::uint32_t) { return scene.curvature_table.entries[x]; });
    }

    const char* searched() const override { return "curvature_threshold"; }
    Range range(const PreparedScene& scene, datapath::SummedHeightUnit) const override {
        const datapath::CoveredTexels& covered = scene.registers.covered;
        return {1 / static_cast<double>(scene.map.highest_code()) / 8, 2.0 * std::max(covered.columns, covered.rows)};
    }
};

}  // namespace

template <>
const HeightTestHost& host_part<datapath::CurvatureTest>() {
    static const CurvatureHost host;
    return host;
}

}  // namespace tessera

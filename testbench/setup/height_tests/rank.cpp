#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "modules/datapath/rank.h"
#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/setup/height_tests/table_rows.h"
#include "testbench/setup/view.h"

namespace tessera {

namespace {

/// Only for radii, which exist with a bound as seen. A vertex's position is off by less than 8 LSB, half of one for
/// each of up to 15 generations and for P', and its distance by 1 in the last place; this applies to four vertices.
std::optional<RadiusScale> radius_scale(const PreparedScene& scene) {
    const datapath::Formats& formats = scene.registers.formats;
    if (!formats.distances || formats.bound_bits == 0)
        return {};
    const double step = distance_step(formats), position = std::ldexp(1.0, -formats.position.fraction);
    constexpr double root_of_three = 1.7320508075688772;
    return RadiusScale{{scene.texel_size[0] / step, scene.texel_size[1] / step, std::abs(scene.height_per_code) / step},
                       4 * (1 + 8 * root_of_three * position / step)};
}

/// Adds remarks on the Rank Test's limits on a base mesh, and on remedies.
void remark_on_base(const std::vector<TextureTriangle>& base, PreparedScene& scene) {
    const RankTables& tables = scene.rank_tables;
    std::vector<std::string> limits;
    if (tables.least_error > 0) {
        limits.push_back(fmt::format(
            "errors of up to {:.2g} of full scale remain at any threshold, since midpoints do not reach every texel",
            tables.least_error / scene.map.highest_code()));
        if (const std::uint64_t whole = count_whole_base_edges(base, scene.registers.formats); whole > 0)
            limits.push_back(fmt::format(
                "{} edges of the base mesh never split: their ends are not an even number of texels apart", whole));
    }
    if (tables.clashes > 0)
        limits.push_back(
            fmt::format("{} midpoints share a texel of the Rank Table with another and use the greater rank: more "
                        "triangles than are needed, and no bound on the error",
                        tables.clashes));
    else if (tables.beyond_period)
        limits.emplace_back(
            "it is longer than the map, and edges a period apart share an entry: more triangles than are "
            "needed, and no bound on the error");
    if (!limits.empty())
        scene.remarks.push_back(fmt::format(
            "the Rank Test is limited on this base mesh: {}. {}; the Summed Height, Curvature and "
            "Mipmap Tests support any base mesh",
            fmt::join(limits, "; "),
            scene.registers.formats.texture.fraction == 0
                ? "Set formats.texture_fraction = 1, since texture coordinates miss the centres of texels"
                : "Use mesh.source = \"lattice\" with a mesh.spacing that divides each side on which the map "
                  "repeats"));
}

class RankHost : public HeightTestHost {
  public:
    const char* meaning() const override {
        return "the host ranks the points of the base mesh's lattice, and an edge requests a split if the rank of its midpoint exceeds the threshold";
    }
    const std::vector<HeightThresholdKey>& thresholds() const override {
        static const std::vector<HeightThresholdKey> keys{
            {"rank_threshold", 0.05,
             "full scale times the root of a texel; pixels times the root of a texel (per_point), of a pixel (per_pixel)",
             between(0, 1e9),
             "With hardware.height_test = \"rank\" and formats.rank_bits: an edge requests a split if the square root of the squared error that its midpoint removes, per added triangle, is larger"},
            {"bound_threshold", 0.01, "full scale; pixels (per_point, per_pixel)", between(0, 1e6),
             "With hardware.height_test = \"rank\" and formats.bound_bits: largest distance of a point of the map from the mesh, along the normal, or as it appears in the picture. A run whose table has bounds, or whose value is not the default, says that it holds, or what to set (testbench/check/PROMISES.md)"}};
        return keys;
    }
    void set_thresholds(const TestSettings& tests, const datapath::Formats& formats, const ViewedScale& view,
                        datapath::TestParameters& registers) const override {
        const double highest_code = static_cast<double>(formats.displacement.highest);
        registers.rank_per_pixel = formats.distances && tests.rank_view == RankView::per_pixel;
        if (formats.rank_bits > 0)
            registers.height_thresholds[datapath::rank_number] =
                formats.distances ? std::int64_t{seen_rank_threshold(tests.threshold("rank_threshold"),
                                                                     registers.rank_per_pixel, view)}
                                  : rank_threshold(tests.threshold("rank_threshold") * highest_code, formats.rank_bits);
        if (formats.bound_bits > 0)
            registers.height_thresholds[datapath::bound_number] =
                formats.distances
                    ? std::int64_t{seen_bound_threshold(tests.threshold("bound_threshold"), view)}
                    : bound_threshold(tests.threshold("bound_threshold") * highest_code, formats.bound_bits);
    }
    void make_table(const TestSettings&, const std::vector<TextureTriangle>& base,
                    PreparedScene& scene) const override {
        const datapath::Formats& formats = scene.registers.formats;
        scene.rank_tables =
            make_rank_tables(scene.map, base, formats, formats.rank_bits, formats.bound_bits, radius_scale(scene));
        remark_on_base(base, scene);
    }
    void write_table(const PreparedScene& scene, const TableSink& sink) const override {
        const datapath::TableLayout& layout = scene.registers.height_table;
        const RankTables& tables = scene.rank_tables;
        const datapath::Formats& formats = scene.registers.formats;
        write_rows(layout, sink, [&](std::uint32_t x, std::uint32_t y) {
            const std::size_t k = std::size_t{y} * layout.columns + x;
            const std::uint64_t rank = tables.rank.empty() ? 0 : tables.rank[k];
            const std::uint64_t bound = tables.bound.empty() ? 0 : tables.bound[k];
            const std::uint64_t radius = tables.radius.empty() ? 0 : tables.radius[k];
            return rank | (bound | radius << formats.bound_bits) << formats.rank_bits;
        });
    }
};

}  // namespace

template <>
const HeightTestHost& host_part<datapath::RankTest>() {
    static const RankHost host;
    return host;
}

}  // namespace tessera

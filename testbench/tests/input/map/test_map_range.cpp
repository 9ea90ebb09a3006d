#include <algorithm>
#include <catch2/catch.hpp>

#include "testbench/input/map/built_in_maps.h"
#include "testbench/input/map/map_range.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/setup/map_displacement.h"

// map.range on a map of 2 x 2 texels of 16-bit metres, 1000 to 1600 of 65535.

using namespace tessera;
using Catch::Contains;

namespace {

HeightMap metres() {
    HeightMap map;
    map.width = map.height = 2;
    map.source_units = 65535;
    for (const double value : {1000.0, 1200.0, 1500.0, 1600.0})
        map.values.push_back(static_cast<float>(value / 65535));
    return map;
}

/// Displacements of the four texels for scale 3 and bias 10, from the map's values.
std::vector<double> displacements(const HeightMap& map) {
    const MapDisplacement displacement = MapDisplacement::from({3, 10}, map);
    std::vector<double> result;
    for (const float value : map.values)
        result.push_back(displacement.of(static_cast<double>(value)));
    return result;
}

/// The same, from the machine's codes and registers.
std::vector<double> machine_displacements(HeightMap map, const MapRange& range, MachineSetup* out = nullptr,
                                          const DisplacementSettings& displacement = {3, 10}) {
    Job job;
    job.displacement = displacement;
    job.map.range = range;
    span_values(map, range);
    const BaseMesh mesh = make_plane(1, 1, 20, 20);
    const MachineSetup setup = make_setup(resolve_job(job, mesh, map).job, mesh, map);
    const double position = std::ldexp(1.0, -setup.registers.formats.position.fraction) / setup.model_scale.scale;
    std::vector<double> result;
    for (const std::uint16_t code : setup.map.codes)
        result.push_back((setup.registers.displacement.scale * std::ldexp(static_cast<double>(code), -16) +
                          setup.registers.displacement.bias) *
                         position);
    if (out != nullptr)
        *out = setup;
    return result;
}

void check_equal(const std::vector<double>& found, const std::vector<double>& expected, double margin) {
    REQUIRE(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k)
        CHECK(found[k] == Approx(expected[k]).margin(margin));
}

}  // namespace

TEST_CASE("full: the scale spans the source's range of values") {
    const std::vector<double> expected{10 + 3 * 1000 / 65535., 10 + 3 * 1200 / 65535., 10 + 3 * 1500 / 65535.,
                                       10 + 3 * 1600 / 65535.};
    check_equal(displacements(metres()), expected, 1e-6);
    MachineSetup setup;
    check_equal(machine_displacements(metres(), {}, &setup), expected, 2e-3);
    CHECK(setup.map.codes == std::vector<std::uint16_t>{1000, 1200, 1500, 1600});
    REQUIRE(setup.remarks.size() == 1);
    CHECK_THAT(setup.remarks.front(), Contains("the map's values, 1000 to 1600, are 0.92 % of the 0 to 65535") &&
                                          Contains("map.range = \"data\""));
}

TEST_CASE("full: values far beyond the range, and a map without relief, are said") {
    const auto remarks = [](const std::vector<float>& values, double scale = 3, const MapRange& range = {}) {
        HeightMap map = metres();
        map.source_units = 1;
        map.values = values;
        MachineSetup setup;
        machine_displacements(map, range, &setup, {scale, 10});
        return setup.remarks;
    };
    const std::vector<std::string> beyond = remarks({20, 20.5F, 21, 21.5F});
    REQUIRE(beyond.size() == 1);
    CHECK_THAT(beyond.front(),
               Contains("the map's values, 20 to 21.5, lie beyond the 0 to 1") && Contains("set map.range = \"data\""));
    INFO("values that vary much");
    const std::vector<float> elevations{300, 700, 1500, 2000};
    const std::vector<std::string> metres = remarks(elevations, 0.3);
    REQUIRE(metres.size() == 1);
    CHECK_THAT(metres.front(), Contains("the map's values, 300 to 2000, lie beyond the 0 to 1 that displacement.scale "
                                        "spans, and displace by 100 to 610 model units: set map.range = \"data\""));
    CHECK(remarks(elevations, 0.3, {MapRange::Kind::data}).empty());
    CHECK(remarks(elevations, 0.003).empty());  // a conversion of units
    CHECK(remarks({-1, 0, 1, 2}).empty());
    INFO("values in model units");
    CHECK(remarks(elevations, 1).empty());
    CHECK(remarks({20, 20.5F, 21, 21.5F}, 1).empty());
    CHECK(remarks({0.2F, 0.21F, 0.22F, 0.23F}, 1).empty());
    const std::vector<std::string> level = remarks({0.5F, 0.5F, 0.5F, 0.5F});
    REQUIRE(level.size() == 1);
    CHECK(level.front() == "every texel of the map holds 0.5: the surface has no relief");
    CHECK(remarks({0, 0.5F, 0.7F, 1}).empty());
}

TEST_CASE("data: the scale and the codes span the values that occur") {
    const MapRange range{MapRange::Kind::data};
    HeightMap map = metres();
    span_values(map, range);
    check_equal(displacements(map), {10, 11, 12.5, 13}, 1e-5);
    MachineSetup setup;
    check_equal(machine_displacements(metres(), range, &setup), {10, 11, 12.5, 13}, 1e-3);
    CHECK(setup.map.codes == std::vector<std::uint16_t>{0, 21845, 54613, 65535});  // thirds and sixths of 65535
    CHECK(setup.remarks.empty());
}

TEST_CASE("two ends: they are in the map's own units, and values beyond them are in proportion") {
    const MapRange range{MapRange::Kind::given, 1200, 1500};
    HeightMap map = metres();
    span_values(map, range);
    check_equal(displacements(map), {8, 10, 13, 14}, 1e-5);
    MachineSetup setup;
    check_equal(machine_displacements(metres(), range, &setup), {8, 10, 13, 14}, 1e-3);
    CHECK(setup.map.codes == std::vector<std::uint16_t>{0, 21845, 54613, 65535});
    CHECK(setup.remarks.empty());
}

TEST_CASE("a constant map is displaced by displacement.bias if the scale spans the data") {
    HeightMap flat = metres();
    std::fill(flat.values.begin(), flat.values.end(), 0.5F);
    span_values(flat, {MapRange::Kind::data});
    check_equal(displacements(flat), {10, 10, 10, 10}, 0);
    check_equal(machine_displacements(flat, {MapRange::Kind::data}), {10, 10, 10, 10}, 1e-3);
}

TEST_CASE("a map that uses less than an eighth of its range gets a remark") {
    const auto remarks = [](float high) {
        HeightMap map;
        map.width = 2;
        map.height = 1;
        map.values = {0, high};
        const BaseMesh mesh = make_plane(1, 1, 2, 2);
        return make_setup(resolve_job({}, mesh, map).job, mesh, map).remarks.size();
    };
    CHECK(remarks(0.125F) == 0);
    CHECK(remarks(0.124F) == 1);
    CHECK(remarks(0) == 1);  // no relief  // nothing to gain
}

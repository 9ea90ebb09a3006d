#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "modules/datapath/height_tests.h"
#include "modules/datapath/parameters.h"
#include "testbench/setup/key_range.h"
#include "testbench/setup/prepared_scene.h"
#include "testbench/setup/scene_settings.h"
#include "testbench/setup/tables/grid_points.h"
#include "testbench/setup/tables/rank_table.h"

namespace tessera {

/// Declaration of a threshold, a key of `[tests]` in a job.
struct HeightThresholdKey {
    const char* name;
    double value;  ///< default
    const char* unit;
    KeyRange range;
    std::string meaning;
};

/// The host's part of a height test: its thresholds with their registers, and its table.
class HeightTestHost {
  public:
    /// Thresholds worth trying, in the key's unit: the register's first step, and one above which hardly an edge splits.
    struct Range {
        double finest = 0, coarsest = 0;
    };

    HeightTestHost() = default;
    virtual ~HeightTestHost() = default;
    HeightTestHost(const HeightTestHost&) = delete;
    HeightTestHost& operator=(const HeightTestHost&) = delete;

    /// What an edge requests a split for, for the text of the key hardware.height_test.
    virtual const char* meaning() const = 0;
    /// In the order of the key reference.
    virtual const std::vector<HeightThresholdKey>& thresholds() const = 0;
    /// Throws InputError if a threshold is beyond its register, or below its step.
    virtual void set_thresholds(const TestSettings&, const datapath::Formats&, const ViewedScale&,
                                datapath::TestParameters&) const = 0;
    /// Makes what the table is written from, unless that is the map. base: the base triangles' texture coordinates.
    virtual void make_table(const TestSettings&, const std::vector<TextureTriangle>& /*base*/, PreparedScene&) const {}
    virtual void write_table(const PreparedScene& scene, const TableSink& sink) const = 0;

    /// The one of thresholds() that `tessera tune` searches; null: the test is not decided by one threshold.
    virtual const char* searched() const { return nullptr; }
    virtual Range range(const PreparedScene&, datapath::SummedHeightUnit) const { return {}; }
};

/// That of a test of the datapath.
template <class Test>
const HeightTestHost& host_part();
#define TESSERA_HOST_PART(Test) \
    template <>                 \
    const HeightTestHost& host_part<datapath::Test>();
TESSERA_FOR_EACH_HEIGHT_TEST(TESSERA_HOST_PART)
#undef TESSERA_HOST_PART

/// In the order of datapath::height_tests().
const std::vector<const HeightTestHost*>& height_test_hosts();
/// Adds that of the test added last to datapath::height_tests(), before any TestSettings are made. No other key of [tests]
/// may have its thresholds' names. Throws std::invalid_argument if that test has its part, or declares other thresholds.
void add_height_test_host(const HeightTestHost& host);

/// "summed_height: ...; rank: ...": all of them.
std::string meaning_of_height_tests();

/// The names of those that are decided by one threshold.
std::vector<std::string_view> searched_height_tests();

const HeightTestHost& host_of(datapath::HeightTest test);

/// Its range(). Throws InputError if that cannot be searched.
HeightTestHost::Range searched_range(datapath::HeightTest test, const PreparedScene& scene,
                                     datapath::SummedHeightUnit unit);

}  // namespace tessera

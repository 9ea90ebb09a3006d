#pragma once
#include <vector>

#include "modules/datapath/parameters.h"
#include "testbench/setup/prepared_scene.h"
#include "testbench/setup/scene_settings.h"
#include "testbench/setup/tables/grid_points.h"
#include "testbench/setup/tables/rank_table.h"

namespace tessera {

/// The host's part of a height test: the registers of its thresholds, and its table.
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

    /// Throws InputError if a threshold is beyond its register, or below its step.
    virtual void set_thresholds(const TestSettings&, const datapath::Formats&, const ViewedScale&,
                                datapath::TestParameters&) const = 0;
    /// Makes what the table is written from, unless that is the map. base: the base triangles' texture coordinates.
    virtual void make_table(const TestSettings&, const std::vector<TextureTriangle>& /*base*/, PreparedScene&) const {}
    virtual void write_table(const PreparedScene& scene, const TableSink& sink) const = 0;

    /// The key that `tessera tune` searches; null: the test is not decided by one threshold.
    virtual double TestSettings::*threshold() const { return nullptr; }
    virtual Range range(const PreparedScene&, datapath::SummedHeightUnit) const { return {}; }
};

/// One each, in files of their names.
const HeightTestHost& summed_height_host();
const HeightTestHost& rank_host();
const HeightTestHost& curvature_host();
const HeightTestHost& mipmap_host();

const HeightTestHost& host_of(datapath::HeightTest test);

}  // namespace tessera

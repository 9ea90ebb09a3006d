#pragma once
#include <array>

#include "modules/schedule/source.h"
#include "modules/schedule/stage.h"
#include "modules/schedule/table.h"
#include "modules/schedule/units.h"

namespace tessera::schedule {

/// A Tessellation Tests unit.
struct TestsPlan {
    StagePlan calculate_new_u, tex_coord_test, height_test, normal_test, view_test;
    InputPlan view_test_corners;
    std::array<InputPlan, 4> results;  ///< of Collect Tests, from the Normal, Tex Coord, height and View Tests
    InputPlan join_edges;              ///< of Pass or Tessellate
};

/// The units, buffers and memories of the machine.
struct Plan {
    SourcePlan source;
    PipelinePlan get_triangle;
    StagePlan calculate_new_p, displace_vertex, transform;
    unsigned tests_units = 1;  ///< 1 or 3
    std::array<TestsPlan, most_tests_units> tests;
    InputPlan join_triangles, join_parts;  ///< of Pass or Tessellate
    unsigned join_places = 1;              ///< for triangles that are not complete
    PipelinePlan join;
    InputPlan tessellation_input;
    PipelinePlan tessellation;
    StagePlan lighting;
    InputPlan rasteriser;
    TablePlan displacement_map, normal_map, height_table;
    TablePlan displacement_map_for_tests;        ///< second memory of the height test, if it has its own
    bool heights_from_displacement_map = false;  ///< the second memory is the displacement map itself
};

}  // namespace tessera::schedule

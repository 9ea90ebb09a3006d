#pragma once
#include <array>

#include "testbench/prove/schedule/source.h"
#include "testbench/prove/schedule/stage.h"
#include "testbench/prove/schedule/table.h"
#include "testbench/prove/schedule/units.h"

namespace tessera::schedule {

/// Tessellation Tests.
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
    TestsPlan tests;
    InputPlan join_triangles, join_parts;  ///< of Pass or Tessellate
    unsigned join_places = 1;              ///< for triangles that are not complete
    PipelinePlan join;
    InputPlan tessellation_input;
    PipelinePlan tessellation;
    StagePlan lighting;
    InputPlan rasteriser;
    TablePlan displacement_map, normal_map, height_table;
    TablePlan displacement_map_for_tests;  ///< second memory of the height test, if it has one
};

}  // namespace tessera::schedule

#include <catch2/catch.hpp>
#include <cstdint>

#include "testbench/check/invariants.h"

using namespace tessera;

TEST_CASE("each violation counts, what is explained or the input's does not") {
    for (std::uint64_t InvariantResult::*const violation :
         {&InvariantResult::t_vertices, &InvariantResult::cracks, &InvariantResult::duplicate_triangles,
          &InvariantResult::area_mismatches, &InvariantResult::areas_beyond_rounding,
          &InvariantResult::generation_violations, &InvariantResult::inconsistent_vertices,
          &InvariantResult::foreign_triangles, &InvariantResult::collapsed, &InvariantResult::turned_over}) {
        InvariantResult result;
        result.*violation = 3;
        CHECK(result.violations() == 3);
        CHECK_FALSE(result.passed());
    }
    InvariantResult result;
    result.collapsed = result.collapsed_explained = 5;
    result.turned_over = result.turned_over_explained = 4;
    result.displaced_collapsed = result.coincident_vertices = result.coincident_edges = 3;
    result.open_texture_seam_edges = result.open_crease_edges = 2;
    CHECK(result.passed());
    result.collapsed_explained = 3;
    result.turned_over_explained = 3;
    CHECK(result.violations() == 3);
}

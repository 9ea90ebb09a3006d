#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>

#include "testbench/check/mesh/invariants.h"

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

TEST_CASE("the figures are named and complete") {
    InvariantResult result;
    result.t_vertices = 1;
    result.cracks = 2;
    result.foreign_triangles = 4;
    result.collapsed = 11;
    result.collapsed_explained = 3;
    const auto figures = invariant_figures(result);
    std::uint64_t violations = 0;
    for (const auto& figure : figures) {
        CHECK(std::count_if(figures.begin(), figures.end(),
                            [&](const auto& other) { return std::string(other.name) == figure.name; }) == 1);
        violations += figure.kind == InvariantFigure::Kind::violation ? figure.value : 0;
    }
    CHECK(violations == 1 + 2 + 4 + 8);
    CHECK(violations == result.violations());
}

#pragma once
#include <array>
#include <cstdint>

#include "modules/schedule/facts.h"
#include "modules/schedule/source.h"
#include "modules/schedule/stage.h"
#include "modules/schedule/table.h"
#include "modules/schedule/units.h"

namespace tessera::schedule {

/// A Tessellation Tests unit.
struct TestsPlan {
    StagePlan calculate_new_u, tex_coord_test, height_test, normal_test, view_test;
    InputPlan view_test_corners;
    std::array<InputPlan, 4> results;  ///< of Collect Tests: Normal, Tex Coord, height and View Test
    InputPlan join_edges;              ///< of Pass or Tessellate
};

/// What the machine is built of.
struct Plan {
    SourcePlan source;
    PipelinePlan get_triangle;
    StagePlan calculate_new_p, displace_vertex, transform;
    unsigned tests_units = 1;  ///< 1 or 3
    std::array<TestsPlan, most_tests_units> tests;
    InputPlan join_triangles, join_parts;  ///< of Pass or Tessellate
    unsigned join_places = 1;              ///< triangles that are not complete
    PipelinePlan join;
    InputPlan tessellation_input;
    PipelinePlan tessellation;
    StagePlan lighting;
    InputPlan rasteriser;
    TablePlan displacement_map, normal_map, height_table;
    TablePlan displacement_map_for_tests;  ///< the height test's second memory, if it has one
};

/// What a unit did in a run.
struct Figures {
    const States* states = nullptr;
    std::uint64_t items = 0;
    std::uint64_t most = 0;
    std::uint64_t item_cycles = 0;
};

/// What a memory did besides.
struct TableFigures {
    const std::vector<std::uint64_t>& bank_slots;  ///< port slots taken of each bank
    std::uint64_t entries = 0;
    Cycle held_up = 0;  ///< cycles in which the oldest request waited for a port
};

/// When everything happens in the machine of triangles.
class Timetable {
  public:
    virtual ~Timetable() = default;

    /// The host has so many triangles more, from this cycle on.
    virtual void send(std::uint64_t triangles, Cycle cycle) = 0;
    /// The triangle that Get Triangle begins next. Call pass() for it before the next call.
    virtual const Source::Next& next() = 0;
    virtual void pass(const Facts& facts) = 0;

    /// The last cycle in which anything happened so far. Known when next() has none.
    virtual Cycle last() const = 0;
    /// At the end of a run, of so many cycles.
    virtual void finish(Cycle end) = 0;

    virtual Figures figures(Unit unit) const = 0;
    virtual TableFigures table_figures(Unit memory) const = 0;
    virtual void observe(Unit unit, ItemObserver* observer) = 0;
    virtual const Source& source() const = 0;
    /// Most triangles that waited for their first part, or for any, at the end of a cycle.
    virtual std::uint64_t most_ahead_of_parts() const = 0;
    /// To Calculate New P.
    virtual std::uint64_t parts_sent() const = 0;
    /// Of a Tessellation Tests unit: vertices taken by the View Test, and edges by Pass or Tessellate.
    virtual std::uint64_t corners(unsigned k) const = 0;
    virtual std::uint64_t edges(unsigned k) const = 0;
};

}  // namespace tessera::schedule

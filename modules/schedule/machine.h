#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "modules/schedule/facts.h"
#include "modules/schedule/source.h"
#include "modules/schedule/stage.h"
#include "modules/schedule/table.h"

namespace tessera::schedule {

/// The units' numbers; those of Tessellation Tests come last.
enum : Unit {
    get_triangle,
    calculate_new_p,
    displace_vertex,
    transform,
    pass_or_tessellate,
    tessellation,
    triangle_queue,
    lighting,
    displacement_map,
    displacement_map_for_tests,
    normal_map,
    height_table,
    rasteriser,
    calculate_new_u,
    tex_coord_test,
    height_test,
    normal_test,
    view_test,
    collect_tests,
    units
};

/// What the machine is built of.
struct Plan {
    SourcePlan source;
    PipelinePlan get_triangle;
    StagePlan calculate_new_p, displace_vertex, transform;
    StagePlan calculate_new_u, tex_coord_test, height_test, normal_test, view_test;
    InputPlan view_test_corners;
    std::array<InputPlan, 4> results;                  ///< of Collect Tests: Normal, Tex Coord, height and View Test
    InputPlan join_triangles, join_parts, join_edges;  ///< of Pass or Tessellate
    unsigned join_places = 1;                          ///< triangles that are not complete
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

/// When everything happens in the machine of triangles with one Tessellation Tests unit: each item's cycles follow from
/// those of the items before it (README.md).
class Machine {
  public:
    explicit Machine(const Plan& plan);

    /// The host has so many triangles more, from this cycle on.
    void send(std::uint64_t triangles, Cycle cycle) { source_.send(triangles, cycle); }
    /// The triangle that Get Triangle begins next. Call pass() for it before the next call.
    const Source::Next& next() { return next_ = source_.next(free_); }
    const Source::Next& begun() const { return next_; }
    void pass(const Facts& facts);

    /// The last cycle in which anything happened so far.
    Cycle last() const { return last_; }
    /// At the end of a run, of so many cycles.
    void finish(Cycle end);

    Figures figures(Unit unit) const;
    void observe(Unit unit, ItemObserver* observer);
    const Source& source() const { return source_; }
    const Table& table(Unit memory) const;
    /// Most triangles that waited for their first part, or for any, at the end of a cycle.
    std::uint64_t most_ahead_of_parts() const { return ahead_of_parts_.most(); }
    /// To Calculate New P.
    std::uint64_t parts_sent() const { return parts_sent_; }
    /// Vertices taken by the View Test, and edges by Pass or Tessellate.
    std::uint64_t corners() const { return corners_.taken(); }
    std::uint64_t edges() const { return join_edges_.taken(); }

  private:
    /// One of Get Triangle's outputs: the cycle of its next part, and of what it has sent of the triangle, when that was
    /// on offer.
    struct Branch {
        struct Offer {
            Cycle from, to;
        };
        Cycle next = 0;
        Cycle free = 0;
        unsigned count = 0;
        std::array<Offer, Facts::parts_of_a_triangle> offers;

        void begin(Cycle cycle, unsigned latency) {
            next = std::max(next, cycle + latency);
            free = cycle;
            count = 0;
        }
        Cycle send(unsigned interval) {
            const Cycle cycle = std::max(next, free);
            next = cycle + interval;
            return cycle;
        }
        void taken(Cycle from, Cycle to) {
            free = to;
            if (to > from)
                offers[count++] = {from, to};
        }
    };
    /// A triangle in Pass or Tessellate.
    struct Join {
        Cycle first_edge = 0;  ///< when one came before it had a place
        Cycle open = 0;
        Cycle geometry = 0, tests = 0;  ///< the last part of each branch
        Cycle start = 0, finish = 0, depart = 0;
        Unit to = nobody;
        bool has_edges = false;
    };

    template <class Machine, class Each>
    static void for_each_unit(Machine& machine, Each&& each);
    void geometry(unsigned part, const Facts& facts);
    void test(unsigned part, const Facts& facts);
    /// Returns when the last entry has come; reads[].requests > 0.
    Cycle read(Table& table, const PartReads& reads, Cycle start, Cycle& asked);
    void join(const Facts& facts);
    Cycle split(Cycle offer, const Facts& facts);
    void account_get_triangle(Cycle begin, Cycle joined);
    void account_joins(Cycle first_tested);

    Plan plan_;
    Source source_;
    Source::Next next_;
    Cycle free_ = 0;  // Get Triangle

    States get_triangle_states_;
    Level get_triangle_level_{1};
    Branch to_geometry_, to_tests_;
    Stage calculate_new_p_, displace_vertex_, transform_;
    Stage calculate_new_u_, tex_coord_test_, height_test_, normal_test_, view_test_;
    Input corners_;
    std::array<Input, 4> results_;
    Cycle collected_ = 0;  // the last edge has left Collect Tests
    States collect_states_;
    Level collect_level_{1};
    Table displacement_map_, displacement_map_for_tests_, normal_map_, height_table_;
    Cycle vertices_asked_ = 0, heights_asked_ = 0, normals_asked_ = 0;  // the last request was taken

    Input join_triangles_, join_parts_, join_edges_;
    History join_starts_;
    Pipeline join_;
    States join_states_;
    Level join_level_, ahead_of_parts_;
    Sequence<Join> joins_;  // that are not accounted for
    Join joining_;
    bool opened_ = false;                          // joining_
    Cycle arrived_ = 0;                            // the triangle itself
    Cycle corners_come_ = 0, corners_bumped_ = 0;  // of a base triangle

    Input tessellation_input_;
    Cycle tessellated_ = 0;  // the last child has been taken
    Cycle next_child_ = 0;   // may be sent
    States tessellation_states_;
    Level tessellation_level_{1};
    Stage lighting_;
    Input rasteriser_;
    Cycle last_ = 0;
    std::uint64_t parts_sent_ = 0;
};

}  // namespace tessera::schedule

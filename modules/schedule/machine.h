#pragma once
#include <array>
#include <cstdint>

#include "modules/schedule/sequence.h"
#include "modules/schedule/timetable.h"

namespace tessera::schedule {

/// Timetable of the triangle design in which each memory has one reader. The cycles of each item are computed from
/// those of the items before it (README.md).
class Machine final : public Timetable {
  public:
    explicit Machine(const Plan& plan);

    const Source::Next& next() override { return next_ = source_.next(free_); }
    void pass(const Facts& facts) override;
    void finish(Cycle end) override;
    std::uint64_t corners(unsigned) const override { return corners_.taken(); }
    std::uint64_t edges(unsigned) const override { return join_edges_.taken(); }

  private:
    /// One of Get Triangle's outputs: the cycle from which it may send its next part, and the cycles in which parts of
    /// the current triangle were on offer.
    struct Branch {
        struct Offer {
            Cycle from, to;
        };
        Cycle next = 0;
        Cycle free = 0;
        unsigned count = 0;
        std::array<Offer, parts_of_a_triangle> offers;

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
    void geometry(unsigned part, const Facts& facts);
    void test(unsigned part, const Facts& facts);
    /// Returns the cycle in which the last entry arrives. reads.requests must not be 0.
    Cycle read(Table& table, const PartReads& reads, Cycle start, Cycle& asked);
    void join(const Facts& facts);
    void account_get_triangle(Cycle begin, Cycle joined);
    void account_joins(Cycle first_edge);

    Cycle free_ = 0;  // Get Triangle
    Branch to_geometry_, to_tests_;
    Stage calculate_new_p_, displace_vertex_, transform_;
    Stage calculate_new_u_, tex_coord_test_, height_test_, normal_test_, view_test_;
    Input corners_;
    std::array<Input, 4> results_;
    Cycle collected_ = 0;  // in which the last edge left Collect Tests
    States collect_states_;
    Level collect_level_{1};
    Table displacement_map_, displacement_map_for_tests_, normal_map_, height_table_;
    Cycle vertices_asked_ = 0, heights_asked_ = 0, normals_asked_ = 0;  // last request accepted

    Input join_parts_, join_edges_;
    History join_starts_;
    Sequence<Join> joins_;  // not yet accounted for
    Join joining_;
    bool opened_ = false;                          // joining_ has a place
    Cycle arrived_ = 0;                            // of the triangle itself
    Cycle corners_come_ = 0, corners_bumped_ = 0;  // of the last corner of a base triangle
};

}  // namespace tessera::schedule

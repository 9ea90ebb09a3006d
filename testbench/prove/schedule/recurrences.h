#pragma once
#include <array>
#include <cstdint>

#include "testbench/prove/schedule/backend.h"
#include "testbench/prove/schedule/facts.h"
#include "testbench/prove/schedule/sequence.h"

namespace tessera::schedule {

/// What a unit did in a run.
struct Figures {
    const States* states = nullptr;
    std::uint64_t items = 0;
    std::uint64_t most = 0;
    std::uint64_t item_cycles = 0;
};

/// The cycles of all events in the paper's design. The cycles of each item are computed from those of the items before
/// it (README.md).
class Recurrences {
  public:
    explicit Recurrences(const Plan& plan);
    Recurrences(const Recurrences&) = delete;
    Recurrences& operator=(const Recurrences&) = delete;

    /// The host offers this many triangles, from cycle 0 on. Call once.
    void send(std::uint64_t triangles) { source_.send(triangles); }
    /// The triangle that Get Triangle begins next. Call pass() for it before the next call.
    const Source::Next& next() { return next_ = source_.next(free_); }
    void pass(const Facts& facts);

    /// The last cycle in which anything happened so far. Valid once next() returns none.
    Cycle last() const { return backend_.last(); }
    /// To be called at the end of a run; end: its number of cycles.
    void finish(Cycle end);

    Figures figures(Unit unit) const;
    const Ports& ports(Unit memory) const { return *ports_[memory]; }
    void observe(Unit unit, ItemObserver* observer);
    const Source& source() const { return source_; }
    /// Most triangles at Pass or Tessellate, at the end of a cycle, of which no part had arrived.
    std::uint64_t most_ahead_of_parts() const { return ahead_of_parts_.most(); }
    /// Parts sent to Calculate New P.
    std::uint64_t parts_sent() const { return parts_sent_; }
    /// Vertices accepted by the View Test, and edges accepted by Pass or Tessellate.
    std::uint64_t corners() const { return corners_.taken(); }
    std::uint64_t edges() const { return join_edges_.taken(); }

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
    /// Registers where a unit accounts for its states and items.
    void has(Unit unit, States& states, Level& level) { accounts_[unit] = {&states, &level}; }
    void has(Unit unit, Stage& stage) { has(unit, stage.states(), stage.level()); }
    void has(Unit memory, Ports& ports) {
        has(memory, ports.states(), ports.level());
        ports_[memory] = &ports;
    }
    void geometry(unsigned part, const Facts& facts);
    void test(unsigned part, const Facts& facts);
    /// Returns the cycle in which the last entry arrives. reads.requests must not be 0.
    Cycle read(Table& table, const PartReads& reads, Cycle start, Cycle& asked);
    void join(const Facts& facts);
    void account_get_triangle(Cycle begin, Cycle joined);
    void account_joins(Cycle first_edge);

    const Plan plan_;
    Source source_;
    Source::Next next_;
    Backend backend_;
    Cycle free_ = 0;  // Get Triangle
    std::uint64_t parts_sent_ = 0;
    States get_triangle_states_;
    Level get_triangle_level_{1};
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

    Input join_triangles_, join_parts_, join_edges_;  // of Pass or Tessellate
    Level ahead_of_parts_;
    History join_starts_;
    Sequence<Join> joins_;  // not yet accounted for
    Join joining_;
    bool opened_ = false;                          // joining_ has a place
    Cycle arrived_ = 0;                            // of the triangle itself
    Cycle corners_come_ = 0, corners_bumped_ = 0;  // of the last corner of a base triangle

    struct Account {
        States* states = nullptr;
        Level* level = nullptr;
    };
    std::array<Account, units> accounts_{};  // null: the Triangle Queue, which Source accounts for, and the rasteriser
    std::array<const Ports*, units> ports_{};
};

}  // namespace tessera::schedule

#pragma once
#include <array>
#include <cstdint>

#include "modules/schedule/backend.h"
#include "modules/schedule/facts.h"

namespace tessera::schedule {

/// What a unit did in a run.
struct Figures {
    const States* states = nullptr;
    std::uint64_t items = 0;
    std::uint64_t most = 0;
    std::uint64_t item_cycles = 0;
};

/// The cycles of all events in the triangle design. This base class has the source of the triangles, the units after
/// the decision, and the figures of all units. The units between are evaluated item by item if each memory has one
/// reader (machine.h), else cycle by cycle (stepped_machine.h).
class Timetable {
  public:
    explicit Timetable(const Plan& plan);
    Timetable(const Timetable&) = delete;
    Timetable& operator=(const Timetable&) = delete;
    virtual ~Timetable() = default;

    /// The host offers this many more triangles, from this cycle on.
    virtual void send(std::uint64_t triangles, Cycle cycle) { source_.send(triangles, cycle); }
    /// The triangle that Get Triangle begins next. Call pass() for it before the next call.
    virtual const Source::Next& next() = 0;
    virtual void pass(const Facts& facts) = 0;

    /// The last cycle in which anything happened so far. Valid once next() returns none.
    Cycle last() const { return backend_.last(); }
    /// To be called at the end of a run; end: its number of cycles.
    virtual void finish(Cycle end);

    Figures figures(Unit unit) const;
    const Ports& ports(Unit memory) const { return *ports_[memory]; }
    void observe(Unit unit, ItemObserver* observer);
    const Source& source() const { return source_; }
    /// Most triangles at Pass or Tessellate, at the end of a cycle, of which no part had arrived.
    std::uint64_t most_ahead_of_parts() const { return ahead_of_parts_.most(); }
    /// Parts sent to Calculate New P.
    std::uint64_t parts_sent() const { return parts_sent_; }
    /// For Tessellation Tests unit k: vertices accepted by its View Test, and its edges accepted by Pass or Tessellate.
    virtual std::uint64_t corners(unsigned k) const = 0;
    virtual std::uint64_t edges(unsigned k) const = 0;

  protected:
    /// Registers where a unit accounts for its states and items.
    void has(Unit unit, States& states, Level& level) { accounts_[unit] = {&states, &level}; }
    void has(Unit memory, Ports& ports) {
        has(memory, ports.states(), ports.level());
        ports_[memory] = &ports;
    }
    template <class It>
    void has(Unit unit, It& it) {
        has(unit, it.states(), it.level());
    }

    Plan plan_;
    Source source_;
    Source::Next next_;
    Backend backend_;
    Input join_triangles_;  // of Pass or Tessellate
    Level ahead_of_parts_;
    std::uint64_t parts_sent_ = 0;
    States get_triangle_states_;
    Level get_triangle_level_{1};

  private:
    struct Account {
        States* states = nullptr;
        Level* level = nullptr;
    };
    std::array<Account, of_tests(most_tests_units, calculate_new_u)> accounts_{};  // null: no such unit
    std::array<const Ports*, units_with_one> ports_{};
};

}  // namespace tessera::schedule

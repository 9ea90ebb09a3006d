#include "modules/schedule/timetable.h"

namespace tessera::schedule {

Timetable::Timetable(const Plan& plan)
    : plan_(plan),
      source_(plan.source),
      backend_(plan, source_),
      join_triangles_(plan.join_triangles),
      ahead_of_parts_(plan.join_triangles.depth) {
    has(get_triangle, get_triangle_states_, get_triangle_level_);
    backend_.for_each_unit([this](Unit unit, States& states, Level& level) { has(unit, states, level); });
}

void Timetable::finish(Cycle end) {
    source_.finish(end);
    for (const Account& account : accounts_)
        if (account.states != nullptr)
            account.states->until(end, State::starved);
}

Figures Timetable::figures(Unit unit) const {
    if (unit == triangle_queue)
        return {&source_.states(), source_.pushed(), source_.most(), source_.item_cycles()};
    const auto& [states, level] = accounts_[unit];
    return {states, level->items(), level->most(), level->item_cycles()};
}

void Timetable::observe(Unit unit, ItemObserver* observer) {
    if (unit == triangle_queue)
        source_.observe(observer);
    else
        accounts_[unit].level->observe(observer);
}

}  // namespace tessera::schedule

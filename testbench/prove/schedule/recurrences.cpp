#include "testbench/prove/schedule/recurrences.h"

#include <algorithm>

namespace tessera::schedule {

Recurrences::Recurrences(const Plan& plan)
    : plan_(plan),
      source_(plan.source),
      backend_(plan, source_),
      calculate_new_p_(plan.calculate_new_p),
      displace_vertex_(plan.displace_vertex),
      transform_(plan.transform),
      calculate_new_u_(plan.tests.calculate_new_u),
      tex_coord_test_(plan.tests.tex_coord_test),
      height_test_(plan.tests.height_test),
      normal_test_(plan.tests.normal_test),
      view_test_(plan.tests.view_test),
      corners_(plan.tests.view_test_corners),
      results_{Input(plan.tests.results[0]), Input(plan.tests.results[1]), Input(plan.tests.results[2]),
               Input(plan.tests.results[3])},
      displacement_map_(plan.displacement_map),
      displacement_map_for_tests_(plan.displacement_map_for_tests),
      normal_map_(plan.normal_map),
      height_table_(plan.height_table),
      join_triangles_(plan.join_triangles),
      join_parts_(plan.join_parts),
      join_edges_(plan.tests.join_edges),
      ahead_of_parts_(plan.join_triangles.depth),
      join_starts_(plan.join_places) {
    has(get_triangle, get_triangle_states_, get_triangle_level_);
    backend_.for_each_unit([this](Unit unit, States& states, Level& level) { has(unit, states, level); });
    has(calculate_new_p, calculate_new_p_);
    has(displace_vertex, displace_vertex_);
    has(transform, transform_);
    has(displacement_map, displacement_map_.ports());
    has(displacement_map_for_tests, displacement_map_for_tests_.ports());
    has(normal_map, normal_map_.ports());
    has(height_table, height_table_.ports());
    has(calculate_new_u, calculate_new_u_);
    has(tex_coord_test, tex_coord_test_);
    has(height_test, height_test_);
    has(normal_test, normal_test_);
    has(view_test, view_test_);
    has(collect_tests, collect_states_, collect_level_);
}

void Recurrences::pass(const Facts& facts) {
    const Cycle begin = next_.begin;
    joining_ = {};
    joining_.open = begin;
    opened_ = false;
    corners_come_ = corners_bumped_ = 0;
    arrived_ = join_triangles_.take(begin);
    to_geometry_.begin(begin, plan_.get_triangle.latency);
    to_tests_.begin(begin, plan_.get_triangle.latency);
    for (unsigned left = facts.parts; left != 0; left &= left - 1) {
        geometry(static_cast<unsigned>(__builtin_ctz(left)), facts);
        ++parts_sent_;
    }
    for (unsigned left = facts.tested ? facts.parts & (vertex_parts | edge_parts) : 0; left != 0; left &= left - 1)
        test(static_cast<unsigned>(__builtin_ctz(left)), facts);
    free_ = std::max({to_geometry_.free, to_tests_.free, arrived_});
    account_get_triangle(begin, arrived_);
    get_triangle_level_.stay(begin, free_);
    join(facts);
}

Cycle Recurrences::read(Table& table, const PartReads& reads, Cycle start, Cycle& asked) {
    asked = start;
    Cycle answer = 0;
    for (unsigned request = 0; request < reads.requests; ++request) {
        answer = table.request(asked, reads.banks_of(request), reads.entries_of(request));
        asked = table.taken();
    }
    return answer;
}

/// Get Triangle, Calculate New P, Displace Vertex, Transform, Pass or Tessellate.
void Recurrences::geometry(unsigned part, const Facts& facts) {
    const Cycle sent = to_geometry_.send(plan_.get_triangle.interval);
    to_geometry_.taken(sent, calculate_new_p_.take(sent));
    calculate_new_p_.start();
    calculate_new_p_.depart(displace_vertex_.take(calculate_new_p_.finish()), displace_vertex);

    const Cycle start = displace_vertex_.start(vertices_asked_);
    const PartReads& reads = facts.displace_vertex[part];
    if (reads.requests > 0)
        displace_vertex_.answer(read(displacement_map_, reads, start, vertices_asked_), displacement_map);
    displace_vertex_.depart(transform_.take(displace_vertex_.finish()), transform);

    transform_.start();
    const Cycle offer = transform_.finish();
    const Cycle taken = join_parts_.take(offer);
    if (!opened_) {
        opened_ = true;
        joining_.open = std::max({taken, arrived_, join_starts_[join_starts_.count() - plan_.join_places]});
        join_triangles_.pop(joining_.open);
        ahead_of_parts_.stay(arrived_, joining_.open);
    }
    joining_.geometry = std::max(taken, joining_.open);
    join_parts_.pop(joining_.geometry);
    transform_.blocked(taken, pass_or_tessellate);
    Cycle departs = taken;
    if ((vertex_parts >> part & 1) != 0) {
        corners_come_ = corners_.take(offer);
        corners_.pop(corners_come_);
        transform_.blocked(corners_come_, view_test);
        departs = std::max(departs, corners_come_);
    }
    transform_.depart(departs);
}

/// Get Triangle, Calculate New U, the tests, Collect Tests, Pass or Tessellate. A vertex goes no further than the
/// Normal Test.
void Recurrences::test(unsigned part, const Facts& facts) {
    const bool is_edge = part >= first_edge_part;
    const bool base = (facts.parts & vertex_parts) != 0;
    const Cycle sent = to_tests_.send(plan_.get_triangle.interval);
    to_tests_.taken(sent, calculate_new_u_.take(sent));
    calculate_new_u_.start();
    const Cycle offer = calculate_new_u_.finish();
    Cycle departs = normal_test_.take(offer);
    calculate_new_u_.blocked(departs, normal_test);
    const auto fork = [&](Stage& test, Unit its) {
        const Cycle taken = test.take(offer);
        calculate_new_u_.blocked(taken, its);
        departs = std::max(departs, taken);
    };
    if (is_edge) {
        fork(tex_coord_test_, tex_coord_test);
        fork(height_test_, height_test);
        fork(view_test_, view_test);
    }
    calculate_new_u_.depart(departs);

    const Cycle start = normal_test_.start(normals_asked_, is_edge && base ? corners_bumped_ : 0);
    const Cycle answer = read(normal_map_, facts.normal_test[part], start, normals_asked_);
    normal_test_.answer(answer, normal_map);
    const Cycle normal_offer = normal_test_.finish();
    if (!is_edge) {
        corners_bumped_ = answer;
        normal_test_.depart(normal_offer);
        return;
    }
    Cycle all = results_[0].take(normal_offer);
    normal_test_.depart(all, collect_tests);
    const auto result = [&](Stage& test, std::size_t input) {
        const Cycle taken = results_[input].take(test.finish());
        test.depart(taken, collect_tests);
        all = std::max(all, taken);
    };
    tex_coord_test_.start();
    result(tex_coord_test_, 1);
    const Cycle height_start = height_test_.start(heights_asked_);
    const PartReads& reads = facts.height_test[part];
    if (reads.requests > 0) {
        const Unit memory = reads.memory == 0 ? height_table : displacement_map_for_tests;
        Table& table = reads.memory == 0 ? height_table_ : displacement_map_for_tests_;
        height_test_.answer(read(table, reads, height_start, heights_asked_), memory);
    }
    result(height_test_, 2);
    view_test_.start(0, base ? corners_come_ : 0, transform);
    result(view_test_, 3);

    const Cycle collected = std::max(all, collected_);
    for (Input& input : results_)
        input.pop(collected);
    collected_ = join_edges_.take(collected);
    collect_states_.until(collected, State::starved);
    collect_states_.until(collected_, State::blocked, pass_or_tessellate);
    collect_level_.stay(collected, collected_);
    if (!joining_.has_edges)
        joining_.first_edge = collected_;
    joining_.has_edges = true;
    joining_.tests = std::max({joining_.tests, collected_, joining_.open});
    join_edges_.pop(joining_.tests);
}

/// Pass or Tessellate, once all parts have arrived.
void Recurrences::join(const Facts& facts) {
    joining_.start = backend_.start(std::max(joining_.geometry, joining_.tests));
    join_starts_.add(joining_.start);
    backend_.decide(joining_, facts);
    joins_.add(joining_);
    if (joining_.has_edges)
        account_joins(joining_.first_edge);
}

/// If several outputs are not free, the first is taken as the cause.
void Recurrences::account_get_triangle(Cycle begin, Cycle joined) {
    get_triangle_states_.until(begin, State::starved);
    unsigned geometry = 0, tests = 0;
    for (Cycle cycle = begin; cycle < free_;) {
        Unit by = nobody;
        Cycle end = free_;
        const auto look_at = [&](const Branch& branch, unsigned& k, Unit consumer) {
            while (k < branch.count && branch.offers[k].to <= cycle)
                ++k;
            if (by != nobody || k == branch.count)
                return;
            const auto [from, to] = branch.offers[k];
            if (from <= cycle)
                by = consumer;
            end = std::min(end, from <= cycle ? to : from);
        };
        look_at(to_geometry_, geometry, calculate_new_p);
        look_at(to_tests_, tests, calculate_new_u);
        if (by == nobody && cycle < joined) {
            by = pass_or_tessellate;
            end = std::min(end, joined);
        }
        get_triangle_states_.until(end, by == nobody ? State::busy : State::blocked, by);
        cycle = end;
    }
}

/// first_edge: the cycle in which the first edge of these triangles arrived.
void Recurrences::account_joins(Cycle first_edge) {
    for (std::uint64_t k = joins_.first(); k < joins_.count(); ++k)
        backend_.account(joins_[k], first_edge);
    joins_.forget_before(joins_.count());
}

void Recurrences::finish(Cycle end) {
    account_joins(end);
    source_.finish(end);
    for (const Account& account : accounts_)
        if (account.states != nullptr)
            account.states->until(end, State::starved);
}

Figures Recurrences::figures(Unit unit) const {
    if (unit == triangle_queue)
        return {&source_.states(), source_.pushed(), source_.most(), source_.item_cycles()};
    const auto& [states, level] = accounts_[unit];
    return {states, level->items(), level->most(), level->item_cycles()};
}

void Recurrences::observe(Unit unit, ItemObserver* observer) {
    if (unit == triangle_queue)
        source_.observe(observer);
    else
        accounts_[unit].level->observe(observer);
}

}  // namespace tessera::schedule

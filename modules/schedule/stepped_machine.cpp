#include "modules/schedule/stepped_machine.h"

#include <algorithm>

namespace tessera::schedule {

SteppedMachine::Tests::Tests(SteppedMachine& machine, const TestsPlan& plan, unsigned k)
    : calls(machine.calls_),
      input(calls, plan.calculate_new_u.input, get_triangle_call, of_tests_call(k, calculate_new_u_call)),
      to_normal_test(calls, plan.normal_test.input, of_tests_call(k, calculate_new_u_call),
                     of_tests_call(k, normal_test_call)),
      to_tex_coord_test(calls, plan.tex_coord_test.input, of_tests_call(k, calculate_new_u_call),
                        of_tests_call(k, tex_coord_test_call)),
      to_height_test(calls, plan.height_test.input, of_tests_call(k, calculate_new_u_call),
                     of_tests_call(k, height_test_call)),
      to_view_test(calls, plan.view_test.input, of_tests_call(k, calculate_new_u_call),
                   of_tests_call(k, view_test_call)),
      corners(calls, plan.view_test_corners, transform_call, of_tests_call(k, view_test_call)),
      results{Link(calls, plan.results[0], of_tests_call(k, normal_test_call), of_tests_call(k, collect_tests_call)),
              Link(calls, plan.results[1], of_tests_call(k, tex_coord_test_call), of_tests_call(k, collect_tests_call)),
              Link(calls, plan.results[2], of_tests_call(k, height_test_call), of_tests_call(k, collect_tests_call)),
              Link(calls, plan.results[3], of_tests_call(k, view_test_call), of_tests_call(k, collect_tests_call))},
      edges(calls, plan.join_edges, of_tests_call(k, collect_tests_call), join_call),
      calculate_new_u(calls, machine.passes_, of_tests_call(k, calculate_new_u_call), input,
                      plan.calculate_new_u.pipeline),
      tex_coord_test(calls, machine.passes_, of_tests_call(k, tex_coord_test_call), to_tex_coord_test,
                     plan.tex_coord_test.pipeline),
      height_test(calls, machine.passes_, of_tests_call(k, height_test_call), to_height_test,
                  plan.height_test.pipeline),
      normal_test(calls, machine.passes_, of_tests_call(k, normal_test_call), to_normal_test,
                  plan.normal_test.pipeline),
      view_test(calls, machine.passes_, of_tests_call(k, view_test_call), to_view_test, plan.view_test.pipeline) {
    calculate_new_u.delivers_to(to_normal_test, all_parts, of_tests(k, schedule::normal_test));
    calculate_new_u.delivers_to(to_tex_coord_test, edge_parts, of_tests(k, schedule::tex_coord_test));
    calculate_new_u.delivers_to(to_height_test, edge_parts, of_tests(k, schedule::height_test));
    calculate_new_u.delivers_to(to_view_test, edge_parts, of_tests(k, schedule::view_test));
    SteppedStage* const all[] = {&normal_test, &tex_coord_test, &height_test, &view_test};
    for (std::size_t test = 0; test < results.size(); ++test)
        all[test]->delivers_to(results[test], edge_parts, of_tests(k, collect_tests));
    normal_test.reads(&Facts::normal_test, machine.normal_map_, k, normal_map);
    normal_test.waits_for(&Pass::bumped, k);
    height_test.reads(&Facts::height_test, machine.height_table_, k, height_table);
    if (machine.plan_.heights_from_displacement_map)
        height_test.reads_second(machine.displacement_map_, 1 + k, displacement_map);  // Displace Vertex is the first
    else
        height_test.reads_second(machine.displacement_map_for_tests_, k, displacement_map_for_tests);
    view_test.waits_for(&Pass::on_screen, k, &corners, transform);
}

/// An edge goes on when all four tests have decided.
void SteppedMachine::Tests::collect() {
    for (Link& result : results)
        result.admit();
    for (;;) {
        if (leaves) {
            if (!edges.free())
                return;
            leaves = false;
            collect_states.until(calls.now(), State::blocked, pass_or_tessellate);
            collect_level.stay(collected, calls.now());
        }
        for (const Link& result : results)
            if (result.empty())
                return;
        collected = calls.now();
        collect_states.until(collected, State::starved);
        const Item edge = results[0].front();
        for (Link& result : results)
            result.pop();
        leaves = true;
        edges.send(edge);
    }
}

SteppedMachine::SteppedMachine(const Plan& plan)
    : Timetable(plan),
      passes_(plan.join_triangles.depth + plan.join_places + 1),
      displacement_map_(calls_, plan.displacement_map, displacement_map_call),
      displacement_map_for_tests_(calls_, plan.displacement_map_for_tests, displacement_map_for_tests_call),
      normal_map_(calls_, plan.normal_map, normal_map_call),
      height_table_(calls_, plan.height_table, height_table_call),
      to_calculate_new_p_(calls_, plan.calculate_new_p.input, get_triangle_call, calculate_new_p_call),
      to_displace_vertex_(calls_, plan.displace_vertex.input, calculate_new_p_call, displace_vertex_call),
      to_transform_(calls_, plan.transform.input, displace_vertex_call, transform_call),
      to_join_(calls_, plan.join_parts, transform_call, join_call),
      calculate_new_p_(calls_, passes_, calculate_new_p_call, to_calculate_new_p_, plan.calculate_new_p.pipeline),
      displace_vertex_(calls_, passes_, displace_vertex_call, to_displace_vertex_, plan.displace_vertex.pipeline),
      transform_(calls_, passes_, transform_call, to_transform_, plan.transform.pipeline) {
    const auto add = [this](Unit unit, unsigned call, SteppedStage& stage) {
        has(unit, stage);
        stages_[call] = &stage;
    };
    add(calculate_new_p, calculate_new_p_call, calculate_new_p_);
    add(displace_vertex, displace_vertex_call, displace_vertex_);
    add(transform, transform_call, transform_);
    has(displacement_map, displacement_map_.ports());
    has(displacement_map_for_tests, displacement_map_for_tests_.ports());
    has(normal_map, normal_map_.ports());
    has(height_table, height_table_.ports());
    calculate_new_p_.delivers_to(to_displace_vertex_, all_parts, displace_vertex);
    displace_vertex_.delivers_to(to_transform_, all_parts, transform);
    displace_vertex_.reads(&Facts::displace_vertex, displacement_map_, 0, displacement_map);
    transform_.delivers_to(to_join_, all_parts, pass_or_tessellate);
    branches_.push_back({&to_calculate_new_p_, all_parts, 0, 0, calculate_new_p});
    for (unsigned k = 0; k < plan.tests_units; ++k) {
        Tests& tests = *tests_.emplace_back(std::make_unique<Tests>(*this, plan.tests[k], k));
        add(of_tests(k, calculate_new_u), of_tests_call(k, calculate_new_u_call), tests.calculate_new_u);
        add(of_tests(k, tex_coord_test), of_tests_call(k, tex_coord_test_call), tests.tex_coord_test);
        add(of_tests(k, height_test), of_tests_call(k, height_test_call), tests.height_test);
        add(of_tests(k, normal_test), of_tests_call(k, normal_test_call), tests.normal_test);
        add(of_tests(k, view_test), of_tests_call(k, view_test_call), tests.view_test);
        has(of_tests(k, collect_tests), tests.collect_states, tests.collect_level);
        transform_.delivers_to(tests.corners, vertex_parts, of_tests(k, view_test));
        const unsigned of_edge = 1u << (first_edge_part + k) | 1u << k | 1u << (k + 1) % 3;
        const unsigned takes = plan.tests_units == 1 ? edge_parts | vertex_parts : of_edge;
        branches_.push_back({&tests.input, takes, 0, 0, of_tests(k, calculate_new_u)});
    }
}

void SteppedMachine::send(std::uint64_t triangles, Cycle cycle) {
    Timetable::send(triangles, cycle);
    calls_.wake_at(get_triangle_call, cycle);
}

const Source::Next& SteppedMachine::next() {
    do {
        while (calls_.any()) {
            const unsigned unit = calls_.next();
            if (stages_[unit] != nullptr)
                stages_[unit]->step();
            else if (unit != get_triangle_call)
                call(unit);
            else if (get_triangle_begins())
                return next_ = source_.next(calls_.now());
        }
    } while (calls_.advance());
    return next_ = {};
}

/// A unit that is neither a stage nor Get Triangle.
void SteppedMachine::call(unsigned unit) {
    switch (unit) {
        case displacement_map_call: return displacement_map_.step();
        case displacement_map_for_tests_call: return displacement_map_for_tests_.step();
        case normal_map_call: return normal_map_.step();
        case height_table_call: return height_table_.step();
        case join_call: return join();
        default: return tests_[(unit - first_tests_call) / calls_of_tests]->collect();
    }
}

void SteppedMachine::pass(const Facts& facts) {
    const Cycle now = calls_.now();
    const auto vertices = [](unsigned parts) {
        return static_cast<unsigned>(__builtin_popcount(parts & vertex_parts));
    };
    Pass& pass = passes_[begun_++];
    pass.facts = facts;
    pass.arrived = join_triangles_.take(now);
    pass.geometry_left = facts.parts;
    pass.tests_left = facts.parts & edge_parts;
    pass.join = {};
    begin_ = now;
    sending_ = true;
    for (Branch& branch : branches_) {
        branch.left = facts.parts & branch.takes;
        branch.next = std::max(branch.next, now + plan_.get_triangle.latency);
        calls_.wake_at(get_triangle_call, branch.next);
    }
    for (unsigned k = 0; k < plan_.tests_units; ++k) {
        Branch& branch = branches_[1 + k];
        if (!facts.tested)
            branch.left = 0;
        pass.bumped[k] = {vertices(branch.left), 0};
        pass.on_screen[k] = {vertices(facts.parts), 0};
    }
    parts_sent_ += static_cast<unsigned>(__builtin_popcount(facts.parts));
    set_get_triangle_state();
}

/// Get Triangle's call. Returns true if it can begin a triangle.
bool SteppedMachine::get_triangle_begins() {
    const Cycle now = calls_.now();
    if (sending_) {
        bool all = passes_[begun_ - 1].arrived <= now;
        for (Branch& branch : branches_)
            all = send_parts(branch) && all;
        if (all) {
            sending_ = false;
            get_triangle_level_.stay(begin_, now);
        }
    }
    if (!sending_) {
        const Cycle due = source_.due(now);
        if (due == now)
            return true;
        calls_.wake_at(get_triangle_call, due);
    }
    set_get_triangle_state();
    return false;
}

/// Returns true if nothing is left to send and nothing is on offer.
bool SteppedMachine::send_parts(Branch& branch) {
    if (branch.left == 0 || !branch.link->free())
        return branch.link->free();
    if (branch.next > calls_.now()) {
        calls_.wake_at(get_triangle_call, branch.next);
        return false;
    }
    const auto part = static_cast<unsigned>(__builtin_ctz(branch.left));
    branch.left &= branch.left - 1;
    branch.next = calls_.now() + plan_.get_triangle.interval;
    const bool taken = branch.link->send({begun_ - 1, part});
    if (branch.left != 0)
        calls_.wake_at(get_triangle_call, branch.next);
    return taken && branch.left == 0;
}

/// Sets the state from the present cycle on. If several outputs are not free, the first is taken as the cause.
void SteppedMachine::set_get_triangle_state() {
    get_triangle_states_.until(calls_.now(), get_triangle_state_, get_triangle_by_);
    get_triangle_by_ = nobody;
    const Cycle arrived = passes_[begun_ - 1].arrived;
    if (sending_ && arrived > calls_.now()) {
        get_triangle_by_ = pass_or_tessellate;
        calls_.wake_at(get_triangle_call, arrived);
    }
    for (std::size_t k = branches_.size(); k-- > 0;)
        if (!branches_[k].link->free())
            get_triangle_by_ = branches_[k].consumer;
    get_triangle_state_ = get_triangle_by_ != nobody ? State::blocked : sending_ ? State::busy : State::starved;
}

/// Pass or Tessellate, up to and including its decisions.
void SteppedMachine::join() {
    to_join_.admit();
    for (const auto& tests : tests_)
        tests->edges.admit();
    do
        take_parts();
    while (decide());
}

void SteppedMachine::take_parts() {
    const Cycle now = calls_.now();
    for (; !to_join_.empty(); to_join_.pop()) {
        const Item part = to_join_.front();
        if (part.pass() == opened_ && !open(part.pass()))
            break;
        Pass& pass = passes_[part.pass()];
        pass.geometry_left &= ~(1u << part.part());
        pass.join.geometry = now;
    }
    for (unsigned k = 0; k < plan_.tests_units; ++k) {
        Link& edges = tests_[k]->edges;
        for (; !edges.empty() && edges.front().pass() < opened_; edges.pop()) {
            Pass& pass = passes_[edges.front().pass()];
            pass.tests_left &= ~(1u << edges.front().part());
            pass.join.tests = pass.join.edges[k] = now;
        }
    }
}

/// Returns false if there is no place for the triangle, or the triangle itself has not arrived.
bool SteppedMachine::open(std::uint64_t number) {
    const Cycle now = calls_.now();
    Pass& pass = passes_[number];
    if (opened_ - joined_ == plan_.join_places)
        return false;
    if (pass.arrived > now) {
        calls_.wake_at(join_call, pass.arrived);
        return false;
    }
    pass.join.open = pass.join.first_edge = now;
    for (const auto& tests : tests_)
        if (!tests->edges.empty())
            pass.join.first_edge = std::min(pass.join.first_edge, tests->edges.since());
    join_triangles_.pop(now);
    ahead_of_parts_.stay(pass.arrived, now);
    ++opened_;
    return true;
}

/// Returns true if a triangle has left its place.
bool SteppedMachine::decide() {
    if (joined_ == opened_)
        return false;
    Pass& pass = passes_[joined_];
    if (pass.geometry_left != 0 || pass.tests_left != 0)
        return false;
    if (!complete_)
        pass.join.start = backend_.start(calls_.now());
    complete_ = pass.join.start > calls_.now();
    if (complete_) {
        calls_.wake_at(join_call, pass.join.start);
        return false;
    }
    backend_.decide(pass.join, pass.facts);
    backend_.account(pass.join, pass.join.first_edge);
    if (pass.facts.children > 0)
        calls_.wake(get_triangle_call);
    ++joined_;
    return true;
}

}  // namespace tessera::schedule

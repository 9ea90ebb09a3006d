#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "testbench/prove/schedule/source.h"
#include "testbench/prove/schedule/stage.h"
#include "testbench/prove/schedule/table.h"

// The recurrences of a schedule, each with cycles derived by hand.

using namespace tessera;
using namespace tessera::schedule;

namespace {

constexpr std::uint8_t no_banks[4] = {};

class Times : public ItemObserver {
  public:
    void item(Cycle cycle, bool came) override { (came ? in : out).push_back(cycle); }
    std::vector<Cycle> in, out;
};

}  // namespace

TEST_CASE("schedule: a history keeps the requested number of items, and 0 before the first") {
    History history(3);
    CHECK(history[std::uint64_t{0} - 3] == 0);
    for (Cycle cycle = 10; cycle < 20; ++cycle)
        history.add(cycle);
    CHECK(history.count() == 10);
    CHECK(history[9] == 19);
    CHECK(history[7] == 17);
}

TEST_CASE("schedule: an input with a full buffer takes an item when another leaves") {
    Input input({2, {}});
    CHECK(input.take(5) == 5);
    CHECK(input.take(5) == 5);
    input.pop(8);
    CHECK(input.take(6) == 8);
    input.pop(20);
    CHECK(input.take(30) == 30);
}

TEST_CASE("schedule: an input's stalls follow from the channel's name") {
    const StallParameters stalls{7, 1000, 9};
    RandomStalls expected(stalls, "channel");
    Input input({1, RandomStalls(stalls, "channel")});
    const Cycle stall = expected.next();
    CHECK(stall > 0);
    CHECK(input.take(100) == 100 + stall);
}

TEST_CASE("schedule: a pipeline starts one item per interval, and none while it is full") {
    Pipeline pipeline({6, 2, 1, 3});
    CHECK(pipeline.start(0) == 0);
    CHECK(pipeline.start(0) == 2);
    CHECK(pipeline.start(9) == 9);
    pipeline.depart(20);
    CHECK(pipeline.start(10) == 20);
}

TEST_CASE("schedule: parallel pipelines take turns") {
    Pipeline pipeline({20, 10, 2, 4});
    CHECK(pipeline.start(0) == 0);
    CHECK(pipeline.start(0) == 0);
    CHECK(pipeline.start(3) == 10);
    CHECK(pipeline.start(12) == 12);
}

TEST_CASE("schedule: cycles are summed by state, and shares are in the order of first occurrence") {
    States told;
    told.until(5, State::starved);
    told.until(9, State::blocked, 3);
    told.until(7, State::busy);  // in the past
    told.until(10, State::waiting_for_memory, 3);
    told.until(12, State::blocked, 3);
    CHECK(told.cycles_in(State::starved) == 5);
    CHECK(told.cycles_in(State::busy) == 0);
    CHECK(told.cycles_in(State::waiting_for_memory) == 1);
    CHECK(told.cycles_in(State::blocked) == 6);
    CHECK(told.shares()[0].state == State::blocked);
    CHECK(told.shares()[0].cycles == 6);
    CHECK(told.shares()[1].state == State::waiting_for_memory);
    CHECK(told.shares()[2].by == nobody);
}

TEST_CASE("schedule: a level is counted at the end of a cycle, and is at least one") {
    Level level(3);
    level.stay(4, 4);
    CHECK(level.most() == 1);
    level.stay(5, 9);
    level.stay(6, 10);
    CHECK(level.most() == 2);
    level.stay(9, 12);  // one leaves in the cycle in which it arrives
    CHECK(level.most() == 2);
    level.stay(9, 13);
    CHECK(level.most() == 3);
    CHECK(level.item_cycles() == 0 + 4 + 4 + 3 + 4);
}

TEST_CASE("schedule: a stage is starved, waiting for memory, busy, and blocked in turn") {
    Stage stage({{1, {}}, {3, 1, 1, 2}});
    CHECK(stage.take(4) == 4);
    CHECK(stage.start(0, 6, 9) == 6);  // lacks an operand for two cycles
    stage.answer(10, 7);
    CHECK(stage.finish() == 13);
    stage.blocked(15, 1);
    stage.depart(18, 2);
    const States& told = stage.states();
    CHECK(told.cycles_in(State::starved) == 6);
    CHECK(told.cycles_in(State::waiting_for_memory) == 4);
    CHECK(told.cycles_in(State::busy) == 3);
    CHECK(told.cycles_in(State::blocked) == 5);
    CHECK(told.shares()[0].by == 9);
    CHECK(told.shares()[3].by == 2);
    CHECK(told.shares()[3].cycles == 3);

    stage.take(6);
    CHECK(stage.start() == 7);    // one interval after the first
    CHECK(stage.finish() == 18);  // in order
    stage.depart(18, 1);
    CHECK(stage.level().most() == 2);
}

TEST_CASE("schedule: a stage with an item is busy while it waits for its interval") {
    Stage stage({{1, {}}, {1, 5, 1, 1}});
    stage.take(0);
    stage.start();
    stage.depart(stage.finish());
    stage.take(2);
    CHECK(stage.start() == 5);
    CHECK(stage.states().cycles_in(State::starved) == 1);
    CHECK(stage.states().cycles_in(State::busy) == 1 + 3);
}

TEST_CASE("schedule: a table with one port reads one entry per cycle, in order") {
    Table table({{1, {}}, 1, 1, 1, 3, 0, 4});
    CHECK(table.request(10, no_banks, 4) == 13 + 3);
    CHECK(table.taken() == 10);
    CHECK(table.request(10, no_banks, 1) == 14 + 3);
    CHECK(table.taken() == 10);
    CHECK(table.request(10, no_banks, 1) == 15 + 3);
    CHECK(table.taken() == 14);  // when the previous one is served
    CHECK(table.ports().held_up() == 5);
    CHECK(table.ports().bank_slots().front() == 6);
    CHECK(table.ports().level().most() == 3);
    CHECK(table.ports().states().cycles_in(State::busy) == 8);
}

TEST_CASE("schedule: a table's narrow port takes several cycles per entry") {
    Table table({{1, {}}, 1, 1, 4, 1, 0, 4});
    CHECK(table.request(0, no_banks, 2) == 8);
}

TEST_CASE("schedule: a request waits for a port of each of its banks") {
    Table table({{4, {}}, 1, 3, 1, 1, 0, 4});
    constexpr std::uint8_t first[] = {0, 0, 0}, both[] = {0, 1}, third[] = {2};
    CHECK(table.request(0, first, 3) == 3);
    CHECK(table.request(0, both, 2) == 4);
    CHECK(table.ports().held_up() == 3);
    CHECK(table.request(0, third, 1) == 4);  // its bank is free from cycle 0: served in 3, after the previous one
    CHECK(table.request(0, third, 1) == 5);
}

TEST_CASE("schedule: with a window requests overlap") {
    Table table({{4, {}}, 1, 2, 1, 1, 2, 4});
    constexpr std::uint8_t first[] = {0, 0, 0}, second[] = {1}, third[] = {1};
    CHECK(table.request(0, first, 3) == 3);
    CHECK(table.request(0, second, 1) == 3);  // read at once, answered in order
    CHECK(table.request(0, third, 1) == 4);   // two requests back, the last address was sent in cycle 2
}

namespace {

SourcePlan queue_of(bool newest_first, std::uint64_t watermark = 1) {
    SourcePlan plan;
    plan.newest_first = newest_first;
    plan.watermark = watermark;
    plan.get_triangle = 0;
    return plan;
}

}  // namespace

TEST_CASE("schedule: the queue's triangles have priority over the host's") {
    Source source(queue_of(false));
    source.send(3);
    Source::Next next = source.next(0);
    CHECK(next.from_host);
    CHECK(next.begin == 0);
    CHECK(source.offer(4, 40) == 4);
    CHECK(source.offer(5, 50) == 5);
    next = source.next(2);  // nothing waits yet
    CHECK(next.from_host);
    CHECK(next.begin == 2);
    next = source.next(5);  // the first is in transit: starts in 4, arrives in 5
    CHECK_FALSE(next.from_host);
    CHECK(next.place == 40);
    CHECK(next.begin == 5);
    next = source.next(5);
    CHECK(next.place == 50);
    CHECK(next.begin == 6);
    CHECK(source.next(7).from_host);
    CHECK_FALSE(source.next(8).any);
}

TEST_CASE("schedule: below the watermark the host's triangles do not wait for the queue's") {
    struct Row {
        std::uint64_t watermark;
        Cycle free;
        bool from_host;
        Cycle begin;
    };
    // The queue's triangle arrives in cycle 13, in which it has priority.
    for (const Row& row : {Row{1, 5, false, 13}, Row{2, 5, true, 5}, Row{2, 12, true, 12}, Row{2, 13, false, 13}}) {
        SourcePlan plan = queue_of(false, row.watermark);
        plan.queue.latency = 10;
        Source source(plan);
        source.send(2);
        source.next(0);
        source.offer(3, 30);
        const Source::Next next = source.next(row.free);
        CHECK(next.from_host == row.from_host);
        CHECK(next.begin == row.begin);
    }
}

TEST_CASE("schedule: last in first out, the newest triangle present leaves the store") {
    Source source(queue_of(true));
    source.send(1);
    source.next(0);
    source.offer(4, 40);  // leaves the store in 4
    source.offer(5, 50);  // in 5
    source.offer(6, 60);
    source.offer(7, 70);
    CHECK(source.next(20).place == 40);  // waits in Get Triangle's buffer
    CHECK(source.next(22).place == 50);  // waits at the queue's output
    // Get Triangle takes 50 in cycle 20 into its buffer; the next leaves the store then.
    CHECK(source.next(24).place == 70);
    CHECK(source.next(26).place == 60);
}

TEST_CASE("schedule: in each cycle the queue outputs before it takes a triangle from Tessellation") {
    // Until cycle 20 Get Triangle's buffer of one place holds triangle 1, and the queue's output triangle 2. In cycle
    // 20 a third leaves the store, and with an interval of 2 a fourth in cycle 22.
    SourcePlan plan = queue_of(true);
    plan.queue.interval = 2;
    Source source(plan);
    source.send(1);
    source.next(0);
    for (std::uint32_t place = 1; place <= 4; ++place)
        source.offer(2 * place, place);
    const auto begun = [&](Cycle free) { return source.next(free).place; };
    SECTION("a triangle sent in the same cycle is not the newest") {
        CHECK(begun(20) == 1);
        CHECK(begun(21) == 2);
        source.offer(22, 5);
        CHECK(begun(30) == 4);
        CHECK(begun(31) == 3);
        CHECK(begun(40) == 5);
    }
    SECTION("a triangle sent in the cycle before is the newest") {
        CHECK(begun(20) == 1);
        source.offer(21, 5);
        CHECK(begun(21) == 2);
        CHECK(begun(30) == 4);
        CHECK(begun(31) == 5);
    }
    SECTION("a triangle sent earlier that enters the store in the same cycle is the newest") {
        source.offer(20, 5);  // before Get Triangle has room
        source.offer(21, 6);  // an interval later, in cycle 22
        CHECK(begun(20) == 1);
        CHECK(begun(21) == 2);
        CHECK(begun(30) == 5);
        CHECK(begun(31) == 6);
    }
}

TEST_CASE("schedule: the queue's levels and item times") {
    Source source(queue_of(false));
    Times times;
    source.observe(&times);
    source.send(1);
    source.next(0);
    source.offer(4, 1);
    source.offer(5, 2);
    source.offer(6, 3);
    for (int k = 0; k < 3; ++k)
        source.next(10);
    source.finish(20);
    CHECK(source.pushed() == 3);
    CHECK(times.in == std::vector<Cycle>{4, 5, 6});
    // Get Triangle's buffer of one place takes the second when it begins the first; then the third leaves the store.
    CHECK(times.out == std::vector<Cycle>{5, 10, 11});
    CHECK(source.item_cycles() == 1 + 5 + 5);
    CHECK(source.highest() == 2);
    CHECK(source.history().highest()[6] == 2);
    CHECK(source.states().cycles_in(State::blocked) == 4);
}

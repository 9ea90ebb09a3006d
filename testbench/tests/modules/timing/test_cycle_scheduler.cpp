#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "testbench/tests/support/timed_modules.h"

// The clock of timed mode alone: which processes are called when, and in which order.

using namespace tessera;
using sc_core::SC_PS;
using sc_core::sc_time;
using tessera::testing::Caller;
using tessera::testing::error_of;
using Calls = std::vector<std::pair<char, std::uint64_t>>;

namespace {

/// Three callers on a clock of 10 ps, attached in the order a, b, c; each records its calls.
struct Three {
    CycleScheduler clock{"clock", sc_time(10, SC_PS)};
    Caller a{clock}, b{clock}, c{clock};
    Calls calls;

    Three() {
        a.on_step = [this] { note('a'); };
        b.on_step = [this] { note('b'); };
        c.on_step = [this] { note('c'); };
    }
    void note(char who) { calls.emplace_back(who, clock.cycle()); }
};

}  // namespace

TEST_CASE("clock: within a cycle units are called in the order of attachment") {
    Three t;
    t.clock.wake_at(t.c, 5);
    t.clock.wake_at(t.a, 5);
    t.clock.wake_at(t.b, 5);
    t.clock.wake_at(t.a, 5);  // requested twice, called once
    t.clock.wake_at(t.b, 2);
    sc_core::sc_start();
    CHECK(t.calls == Calls{{'b', 2}, {'a', 5}, {'b', 5}, {'c', 5}});
    CHECK(t.clock.last_cycle() == 5);
    CHECK(sc_core::sc_time_stamp() == sc_time(50, SC_PS));
}

TEST_CASE("clock: a unit woken in the current cycle is called in it, units attached earlier first") {
    Three t;
    int woken = 0;
    t.b.on_step = [&] {
        t.note('b');
        if (woken++ == 0) {
            t.clock.wake(t.c);
            t.clock.wake(t.a);
            t.clock.wake_at(t.a, 3);  // the present cycle instead, since it has passed
            t.clock.wake_at(t.b, 8);
        }
    };
    t.clock.wake_at(t.b, 7);
    sc_core::sc_start();
    CHECK(t.calls == Calls{{'b', 7}, {'a', 7}, {'c', 7}, {'b', 8}});
}

TEST_CASE("clock: cycles without a wake-up are skipped, near and far") {
    Three t;
    // the table covers 1024 cycles from the first; both sides of its limit, and of the second turn's
    const std::vector<std::uint64_t> asked{0, 1, 63, 64, 65, 1022, 1023, 1024, 1025, 2047, 2048, 5000, 1'000'000};
    for (const std::uint64_t cycle : asked)
        t.clock.wake_at(t.a, cycle);
    t.clock.wake_at(t.b, 5000);
    sc_core::sc_start();
    Calls expected;
    for (const std::uint64_t cycle : asked) {
        expected.emplace_back('a', cycle);
        if (cycle == 5000)
            expected.emplace_back('b', cycle);
    }
    CHECK(t.calls == expected);
    CHECK(sc_core::sc_time_stamp() == sc_time(10'000'000, SC_PS));
}

TEST_CASE("clock: wake-ups from within a cycle work at every distance") {
    // each call requests the next, a given distance ahead; a distant request must not be called one turn of the table
    // early, nor be lost when it comes within the table's range
    Three t;
    const std::vector<std::uint64_t> distances{1, 2, 64, 960, 1023, 1024, 1025, 2048, 3000, 1, 1023, 4096};
    std::size_t next = 0;
    Calls expected{{'a', 3}};
    for (const std::uint64_t distance : distances)
        expected.emplace_back('a', expected.back().second + distance);
    t.a.on_step = [&] {
        t.note('a');
        if (next < distances.size())
            t.clock.wake_at(t.a, t.clock.cycle() + distances[next++]);
    };
    t.clock.wake_at(t.a, 3);
    sc_core::sc_start();
    CHECK(t.calls == expected);
}

TEST_CASE("clock: many far wake-ups of several units come in order") {
    Three t;
    Calls expected;
    std::uint64_t cycle = 10'000;
    for (int k = 0; k < 100; ++k) {
        cycle += 1 + static_cast<unsigned>(k) * 37 % 900;
        expected.emplace_back("abc"[k % 3], cycle);
    }
    for (std::size_t k = 0; k < expected.size();
         ++k) {  // asked for in another order: 41 and 100 have no factor in common
        const auto& [who, when] = expected[k * 41 % 100];
        t.clock.wake_at(who == 'a' ? t.a : who == 'b' ? t.b : t.c, when);
    }
    sc_core::sc_start();
    CHECK(t.calls == expected);
}

TEST_CASE("clock: a unit woken from outside a cycle is called in the first cycle that begins at or after now") {
    Three t;
    sc_core::sc_start(sc_time(41, SC_PS));  // within the fifth cycle: number 4 began at 40
    CHECK(t.calls.empty());
    CHECK(t.clock.idle());
    CHECK(t.clock.cycle() == 5);
    t.clock.wake(t.a);
    t.clock.wake_at(t.b, 2);  // past: likewise
    CHECK_FALSE(t.clock.idle());
    sc_core::sc_start(sc_time(9, SC_PS));  // to 50, where cycle 5 begins
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    CHECK(t.calls == Calls{{'a', 5}, {'b', 5}});
    CHECK(t.clock.idle());
    t.clock.wake_at(t.c, 9);
    t.clock.wake_at(t.a, 7);  // earlier than the scheduled cycle
    sc_core::sc_start();
    CHECK(t.calls == Calls{{'a', 5}, {'b', 5}, {'a', 7}, {'c', 9}});
}

TEST_CASE("clock: after a long pause near and far wake-ups from outside come in their cycles") {
    Three t;
    t.clock.wake_at(t.a, 3);
    sc_core::sc_start(sc_time(50'000, SC_PS));  // cycle 5000: several turns of the table after the last call
    t.clock.wake_at(t.b, 7500);                 // also beyond the table's current range
    t.clock.wake_at(t.c, 5010);
    t.clock.wake_at(t.a, 6023);
    t.clock.wake_at(t.b, 6024);
    sc_core::sc_start();
    CHECK(t.calls == Calls{{'a', 3}, {'c', 5010}, {'a', 6023}, {'b', 6024}, {'b', 7500}});
}

TEST_CASE("clock: delays are counted in cycles, rounded up") {
    Three t;
    CHECK(t.clock.cycles(sc_core::SC_ZERO_TIME) == 0);
    CHECK(t.clock.cycles(sc_time(1, SC_PS)) == 1);
    CHECK(t.clock.cycles(sc_time(10, SC_PS)) == 1);
    CHECK(t.clock.cycles(sc_time(11, SC_PS)) == 2);
    CHECK(t.clock.period() == sc_time(10, SC_PS));
}

TEST_CASE("clock: two units that wake one another for ever are an error, not a hang") {
    Three t;
    t.a.on_step = [&] { t.clock.wake(t.b); };
    t.b.on_step = [&] { t.clock.wake(t.a); };
    t.clock.wake_at(t.a, 1);
    CHECK_THAT(error_of([] { sc_core::sc_start(); }), Catch::Contains("a cycle does not end"));
}

TEST_CASE("clock: a busy cycle below the bound of calls is not an error") {
    Three t;
    unsigned calls = 0;
    t.a.on_step = [&] {
        if (++calls < CycleScheduler::calls_in_a_cycle)
            t.clock.wake(t.a);
    };
    t.clock.wake_at(t.a, 1);
    CHECK(error_of([] { sc_core::sc_start(); }).empty());
    CHECK(calls == CycleScheduler::calls_in_a_cycle);
}

TEST_CASE("clock: it stops the simulation after the bound without progress, and not before") {
    Three t;
    // progress in cycle 100, none later; b is woken in every cycle and would continue for ever
    t.clock.halt_without_progress_for(50);
    t.b.on_step = [&] {
        if (t.clock.cycle() == 40 || t.clock.cycle() == 80 || t.clock.cycle() == 100)
            t.clock.progress();
        t.clock.wake_at(t.b, t.clock.cycle() + 1);
    };
    t.clock.wake_at(t.b, 0);
    sc_core::sc_start();
    CHECK(t.clock.stalled());
    CHECK(t.clock.last_cycle() == 151);  // the first with more than 50 cycles since 100
}

TEST_CASE("clock: running out of work is not a lack of progress") {
    Three t;
    t.clock.halt_without_progress_for(50);
    t.clock.wake_at(t.a, 50);
    sc_core::sc_start();
    CHECK_FALSE(t.clock.stalled());
    CHECK(t.clock.idle());
}

TEST_CASE(
    "clock: ahead of simulated time it calls the same units, waits for other processes, and ends at the same time") {
    struct Other : sc_core::sc_module {
        const Three& t;
        std::vector<std::pair<sc_time, std::size_t>> calls;  // the time, and how many calls of units had been made

        Other(const sc_core::sc_module_name& name, const Three& units) : sc_module(name), t(units) {
            SC_HAS_PROCESS(Other);
            SC_METHOD(note);
            dont_initialize();
            sensitive << event << t.clock.quiet();
        }
        void note() { calls.emplace_back(sc_core::sc_time_stamp(), t.calls.size()); }
        sc_core::sc_event event;
    };
    Three t;
    Other other("other", t);
    std::vector<sc_time> times;
    t.clock.run_ahead(4);
    t.a.on_step = [&] {
        t.note('a');
        times.push_back(sc_core::sc_time_stamp());
        if (t.calls.size() < 20)
            t.clock.wake_at(t.a, t.clock.cycle() + 2);
    };
    t.clock.wake_at(t.a, 0);
    other.event.notify(sc_time(125, SC_PS));
    sc_core::sc_start();
    REQUIRE(t.calls.size() == 20);
    CHECK(t.calls.back() == std::pair<char, std::uint64_t>('a', 38));
    // Five calls without a return to the kernel, two before the other process, then groups of five.
    std::vector<sc_time> expected;
    for (const auto& [cycle, calls] : {std::pair{0, 5}, {10, 2}, {14, 5}, {24, 5}, {34, 3}})
        expected.insert(expected.end(), static_cast<std::size_t>(calls), sc_time(10 * cycle, SC_PS));
    CHECK(times == expected);
    CHECK(other.calls ==
          std::vector<std::pair<sc_time, std::size_t>>{{sc_time(125, SC_PS), 7}, {sc_time(380, SC_PS), 20}});
}

TEST_CASE("clock: a period of zero is an error") {
    CHECK_THAT(error_of([] { CycleScheduler clock("clock", sc_core::SC_ZERO_TIME); }),
               Catch::Contains("period is zero"));
}

namespace {

/// A clock with sixteen cycles in SystemC's range of time.
struct LongClock {
    CycleScheduler clock{"clock", sc_time::from_value(std::uint64_t{1} << 60)};
    Caller a{clock}, b{clock};
    std::vector<std::uint64_t> called;

    LongClock() {
        b.on_step = [this] { called.push_back(clock.cycle()); };
    }
};

}  // namespace

TEST_CASE("clock: a cycle beyond the end of simulated time stops the simulation, and is not called early") {
    LongClock t;
    t.a.on_step = [&] {
        t.clock.wake_at(t.b, 15);
        t.clock.wake_at(t.b, 16);
    };
    t.clock.wake_at(t.a, 1);
    sc_core::sc_start();
    CHECK(t.called == std::vector<std::uint64_t>{15});
    CHECK(t.clock.out_of_time());
    CHECK_FALSE(t.clock.stalled());
}

TEST_CASE("clock: a cycle beyond the end of simulated time cannot be requested from outside a cycle") {
    LongClock t;
    t.clock.wake_at(t.b, 16);
    CHECK(t.clock.idle());
    CHECK(t.clock.out_of_time());
}

TEST_CASE("clock: idle without pending wake-ups, and not within a cycle") {
    Three t;
    CHECK(t.clock.idle());
    t.clock.wake_at(t.a, 3);
    CHECK_FALSE(t.clock.idle());
    bool idle_within = true;
    t.a.on_step = [&] { idle_within = t.clock.idle(); };
    sc_core::sc_start();
    CHECK_FALSE(idle_within);
    CHECK(t.clock.idle());
}

TEST_CASE("clock: 64 units are attached, and the next is an error") {
    CycleScheduler clock("clock", sc_time(10, SC_PS));
    std::vector<std::unique_ptr<Caller>> callers;
    std::vector<int> order;
    for (int k = 0; k < 64; ++k) {
        callers.push_back(std::make_unique<Caller>(clock));
        callers.back()->on_step = [&order, k] { order.push_back(k); };
    }
    CHECK_THAT(error_of([&] { Caller next(clock); }), Catch::Contains("more than 64"));
    for (int k = 63; k >= 0; --k)
        clock.wake_at(*callers[static_cast<std::size_t>(k)], 1);
    sc_core::sc_start();
    REQUIRE(order.size() == 64);
    CHECK(std::is_sorted(order.begin(), order.end()));
}

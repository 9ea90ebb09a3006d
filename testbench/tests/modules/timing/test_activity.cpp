#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "modules/stage/fork.h"
#include "modules/stage/per_triangle.h"
#include "modules/stage/signals.h"
#include "modules/timing/activity.h"
#include "modules/timing/all_units.h"
#include "modules/timing/level_history.h"
#include "modules/unit_numbers.h"
#include "modules/units/triangle_store.h"
#include "testbench/tests/support/expect_section.h"
#include "testbench/tests/support/timed_modules.h"

// The records that units keep of their activity and their items.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

using Levels = std::vector<std::uint64_t>;

struct Neighbour : sc_core::sc_module {
    explicit Neighbour(const sc_core::sc_module_name& name) : sc_module(name) {}
};

/// Outputs in a module, as in a unit; their consumers take nothing.
struct ForkBench : sc_core::sc_module {
    std::vector<std::unique_ptr<StreamOutput<int>>> outputs;
    std::vector<std::unique_ptr<BareTarget<int>>> targets;
    Fork<int> fork;

    explicit ForkBench(const sc_core::sc_module_name& name) : sc_module(name) {
        for (int k = 0; k < 5; ++k) {
            const std::string number = std::to_string(k);
            outputs.push_back(std::make_unique<StreamOutput<int>>(("out_" + number).c_str()));
            targets.push_back(std::make_unique<BareTarget<int>>(("target_" + number).c_str()));
            outputs.back()->bind(targets.back()->in);
        }
    }
};

}  // namespace

TEST_CASE("activity: cycles by state, and by the neighbour that blocks or is awaited") {
    Neighbour a("a"), b("b");
    Activity activity;
    activity.set(10, State::blocked, &a);
    activity.set(13, State::waiting_for_memory, &a);
    activity.set(17, State::blocked, &b);
    activity.set(18, State::blocked, &a);
    activity.set(20, State::busy);
    activity.finish(25);
    CHECK(activity.cycles_in(State::starved) == 10);
    CHECK(activity.cycles_in(State::blocked) == 6);
    CHECK(activity.cycles_in(State::waiting_for_memory) == 4);
    CHECK(activity.cycles_in(State::busy) == 5);
    const auto share = [&](State state, const Neighbour& by) {
        std::uint64_t cycles = 0;
        for (const Activity::Share& it : activity.shares())
            if (it.state == state && it.by == &by)
                cycles += it.cycles;
        return cycles;
    };
    CHECK(share(State::blocked, a) == 5);
    CHECK(share(State::blocked, b) == 1);
    CHECK(share(State::waiting_for_memory, a) == 4);
    CHECK(share(State::waiting_for_memory, b) == 0);
}

TEST_CASE("activity: an item counts from its arrival to its departure, or to the end of the run") {
    Activity activity;
    activity.item_in(3);
    activity.item_in(5);
    activity.item_out(9);
    CHECK(activity.high_water_mark() == 2);
    activity.finish(20);
    CHECK(activity.item_cycles() == (9 - 3) + (20 - 5));
    activity.finish(22);
    CHECK(activity.item_cycles() == (9 - 3) + (22 - 5));
    activity.item_out(25);
    activity.finish(30);
    CHECK(activity.item_cycles() == (9 - 3) + (25 - 5));
}

TEST_CASE("activity: more neighbours than the limit are an error, none is counted as another") {
    std::vector<std::unique_ptr<Neighbour>> neighbours;
    Activity activity;
    const auto visit_all = [&] {
        std::uint64_t cycle = 0;
        for (const auto& it : neighbours)
            activity.set(cycle++, State::blocked, it.get());
        activity.finish(cycle);
    };
    for (std::size_t k = 0; k <= Activity::most_shares; ++k)
        neighbours.push_back(std::make_unique<Neighbour>(("n" + std::to_string(k)).c_str()));
    CHECK_THAT(error_of(visit_all), Contains("more neighbours"));
    for (const Activity::Share& share : activity.shares())
        CHECK(share.cycles == 1);
}

TEST_CASE("level history: the highest level of each stretch, stretches double in length") {
    LevelHistory history;
    history.finish(0);
    CHECK(history.highest().empty());
    history.set(2, 7);
    history.set(4, 3);
    history.finish(6);
    CHECK(history.stretch() == 1);
    CHECK(history.highest() == Levels{0, 0, 7, 7, 7, 3});
    history.finish(2000);
    CHECK(history.stretch() == 2);
    REQUIRE(history.highest().size() == 1000);
    CHECK(history.highest()[0] == 0);
    CHECK(history.highest()[1] == 7);
    CHECK(history.highest()[2] == 7);
    CHECK(history.highest()[3] == 3);
    CHECK(history.highest().back() == 3);
}

TEST_CASE("fork: reports the consumer that blocks it, and has at most four outputs") {
    ForkBench bench("bench");
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    for (std::size_t k = 0; k < 4; ++k)
        bench.fork.add(*bench.outputs[k]);
    CHECK_THAT(error_of([&] { bench.fork.add(*bench.outputs[4]); }), Contains("more than four"));
    CHECK(bench.fork.blocked_by() == nullptr);
    for (const std::size_t k : {0u, 1u, 3u}) {
        bench.targets[k]->status = tlm::TLM_UPDATED;
        bench.targets[k]->phase_back = tlm::END_REQ;
    }
    int item = 5;
    CHECK_FALSE(bench.fork.deliver(item));
    CHECK(bench.fork.blocked_by() == bench.targets[2].get());
    for (const auto& target : bench.targets)
        target->status = tlm::TLM_COMPLETED;  // a second offer would be a violation
    CHECK_FALSE(bench.fork.deliver(item));
    bench.targets[2]->send_back(item, tlm::END_REQ, sc_core::SC_ZERO_TIME);
    CHECK(bench.fork.deliver(item));
}

TEST_CASE("fork: an output gets only its parts, and only the fields it needs, in both modes") {
    struct Bench : sc_core::sc_module {
        StreamOutput<ScreenPoint> all{"all"}, edges{"edges"}, moved{"moved"};
        StreamOutput<ScreenCorner> vertices{"vertices"};
        Fork<ScreenPoint> fork;
        explicit Bench(const sc_core::sc_module_name& name) : sc_module(name) {
            fork.add(all);
            fork.add(edges, edge_parts);
            const auto corner = +[](const ScreenPoint& point) { return ScreenCorner{point.tag, point.screen}; };
            fork.add(vertices, corner, vertex_parts);
            const auto move = +[](const ScreenPoint& point) {
                ScreenPoint made = point;
                ++made.screen.x;
                return made;
            };
            fork.add(moved, move, all_parts);
        }
    } bench("bench");
    CycleScheduler clock("clock", sc_core::sc_time(10, sc_core::SC_PS));
    Sink<ScreenPoint> all("all", clock), edges("edges", clock), moved("moved", clock);
    Sink<ScreenCorner> vertices("vertices", clock);
    bench.all.bind(all.in);
    bench.edges.bind(edges.in);
    bench.vertices.bind(vertices.in);
    bench.moved.bind(moved.in);
    const auto parts_of_items = [](const auto& sink) {
        std::vector<int> parts;
        for (const auto& item : sink.items)
            parts.push_back(item.tag.part);
        return parts;
    };
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    ScreenPoint point;
    point.screen.x = 5;
    for (const int part : {7, 4, 2}) {
        point.tag.part = static_cast<std::uint8_t>(part);
        CHECK(bench.fork.deliver(point));
        sc_core::sc_start(sc_core::sc_time(10, sc_core::SC_PS));
    }
    sc_core::sc_time delay;
    for (const int part : {6, 3, 0}) {
        point.tag.part = static_cast<std::uint8_t>(part);
        bench.fork.transport(point, delay);
    }
    CHECK(parts_of_items(all) == std::vector<int>{7, 4, 2, 6, 3, 0});
    CHECK(parts_of_items(edges) == std::vector<int>{7, 6});
    CHECK(parts_of_items(vertices) == std::vector<int>{2, 0});
    CHECK(vertices.items.front().screen.x == 5);
    CHECK(all.items.front().screen.x == 5);
    CHECK(parts_of_items(moved) == parts_of_items(all));
    for (const ScreenPoint& made : moved.items)
        CHECK(made.screen.x == 6);
}

TEST_CASE("per triangle: entries are found by tag, closed in any order, and the store grows") {
    PerTriangle<int> kept(2);
    CHECK(kept.find(7) == nullptr);
    kept.open(7) = 70;
    kept.find_or_open(8) = 80;
    CHECK(kept.full());
    kept.find_or_open(9) = 90;
    CHECK(kept.size() == 3);
    CHECK(kept.find_or_open(8) == 80);
    kept.close(8);
    kept.close(8);  // has left
    CHECK(kept.size() == 2);
    CHECK(kept.oldest() == 70);
    CHECK(*kept.find(9) == 90);
    kept.close_oldest();
    CHECK(kept.oldest() == 90);
    CHECK(kept.find(7) == nullptr);
    CHECK(kept.find_or_open(7) == 0);  // opened again
}

TEST_CASE("the table of units in modules/README.md is the units' own") {
    std::string rows;
    const auto row = [&](const auto&... cells) {
        ((rows += fmt::format("| {} ", cells)), ...);
        rows += "|\n";
    };
    for (const UnitSpec& unit : all_units) {
        if (unit.timing == nullptr)
            row(unit.title, unit.work, unit.arithmetic, "-");
        else if (unit.name != std::string(height_test_unit))
            row(unit.title, unit.work, unit.arithmetic, (Timing().*unit.timing).latency);
        else
            for (const datapath::HeightTestFunctions* const test : datapath::height_tests())
                row(test->title(),
                    (test == datapath::height_tests().front()
                         ? ""
                         : fmt::format("replaces it with `height_test = \"{}\"`: ", test->name)) +
                        test->work,
                    test->arithmetic, test->latency);
    }
    expect_section("modules/README.md", "| unit | work | arithmetic | latency |\n| --- | --- | --- | --- |\n", rows,
                   SectionEnd::empty_line);
}

TEST_CASE("unit numbers: a machine's units have their own, any other object is other, null is nobody") {
    Neighbour transform("transform"), stranger("stranger");
    struct Machine : sc_core::sc_module {
        Neighbour lighting{"lighting"};
        Neighbour host{"a_host"};
        struct Inner : sc_core::sc_module {
            Neighbour lighting{"lighting"};
            explicit Inner(const sc_core::sc_module_name& name) : sc_module(name) {}
        } inner{"inner"};
        Neighbour lookalike{"xlighting"};
        explicit Machine(const sc_core::sc_module_name& name) : sc_module(name) {}
    } machine("machine");
    const auto number_of = [](const std::string& name) {
        for (const UnitNumbers::Entry& entry : numbered_units())
            if (entry.name == name)
                return entry.number;
        return ~0u;
    };
    UnitNumbers numbers(numbered_units());
    CHECK(numbers.of(nullptr) == UnitNumbers::nobody);
    CHECK(numbers.of(&transform) == number_of("transform"));
    CHECK(numbers.of(&machine.lighting) == number_of("lighting"));
    CHECK(numbers.of(&machine.lighting) == number_of("lighting"));  // known by now
    for (const Neighbour* other : {&stranger, &machine.host, &machine.lookalike, &machine.inner.lighting})
        CHECK(numbers.of(other) == UnitNumbers::other);
}

TEST_CASE("triangle store: grows at either end, and keeps the order") {
    TriangleStore store(TriangleOrder::fifo);
    datapath::Triangle triangle;
    const auto numbered = [&](std::uint32_t number) -> const datapath::Triangle& {
        triangle.base = number;
        return triangle;
    };
    for (std::uint32_t k = 0; k < 1500; ++k) {
        store.push_oldest(numbered(2999 - k));
        store.push(numbered(3000 + k));
    }
    CHECK(store.size() == 3000);
    for (std::uint32_t k = 1500; k < 4500; ++k)
        REQUIRE(store.pop().base == k);
    CHECK(store.empty());
    TriangleStore other(TriangleOrder::lifo);
    for (std::uint32_t k = 0; k < 3000; ++k)
        other.push_oldest(numbered(k));
    for (std::uint32_t k = 2999; k >= 2000; --k)
        REQUIRE(other.pop_oldest().base == k);
    for (std::uint32_t k = 0; k < 2000; ++k)
        REQUIRE(other.pop().base == k);
    CHECK(other.empty());
}

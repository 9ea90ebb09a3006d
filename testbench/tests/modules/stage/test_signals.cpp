#include <catch2/catch.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "modules/stage/signals.h"
#include "testbench/tests/support/timed_modules.h"

// A unit's signals: each value reaches the signal that was declared with its name, in any order of calls.

using namespace tessera;
using namespace tessera::testing;

namespace {

struct Values : SignalSink {
    std::vector<std::string> names;
    std::map<std::string, std::uint64_t> values;

    Signal add(const std::string& scope, const std::string& name, unsigned) override {
        names.push_back(scope + "." + name);
        return static_cast<Signal>(names.size() - 1);
    }
    void set(Signal signal, std::uint64_t value) override { values[names.at(signal)] = value; }
    void pulse(Signal signal) override { values[names.at(signal)] = 1; }
};

struct Vectors {
    datapath::Direction first, second;
};

}  // namespace

TEST_CASE("signals are found by scope, name and component, in another order than declared") {
    Values sink;
    const std::vector<UnitNumbers::Entry> none;
    UnitNumbers numbers(none);
    Signals signals(sink, numbers, "unit");
    const auto show = [&](bool backwards, const Vectors& vectors, std::uint64_t count) {
        if (!backwards)
            signals.value("count", 8, count);
        signals.direction(backwards ? "second" : "first", backwards ? vectors.second : vectors.first);
        signals.direction(backwards ? "first" : "second", backwards ? vectors.first : vectors.second);
        if (backwards)
            signals.value("count", 8, count);
    };
    signals.begin(true);
    show(false, {}, 0);
    for (const bool backwards : {false, true}) {
        signals.begin(false);
        show(backwards, {{1, 2, 3}, {4, 5, 6}}, 7);
        CHECK(sink.values == std::map<std::string, std::uint64_t>{{"unit.count", 7},
                                                                  {"unit.first_x", 1},
                                                                  {"unit.first_y", 2},
                                                                  {"unit.first_z", 3},
                                                                  {"unit.second_x", 4},
                                                                  {"unit.second_y", 5},
                                                                  {"unit.second_z", 6}});
        sink.values.clear();
    }
}

TEST_CASE("a value of a signal that was not declared is an error that names the unit and the signal") {
    Values sink;
    const std::vector<UnitNumbers::Entry> none;
    UnitNumbers numbers(none);
    Signals signals(sink, numbers, "unit");
    signals.begin(true);
    signals.value("count", 8, 0);
    signals.begin(false);
    CHECK(error_of([&] { signals.value("sum", 8, 0); }) == "unit: traces sum, which is not declared");
}

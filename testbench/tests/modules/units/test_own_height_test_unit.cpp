// The unit of a height test of one's own: what it does against its declarations is an error, in both modes.
#include <catch2/catch.hpp>
#include <systemc>

#include "modules/datapath/table_shapes.h"
#include "modules/stage/signals.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/units/edge_tests/height_test.h"
#include "testbench/tests/setup/own_height_test.h"

using namespace tessera;
using namespace tessera::testing;

namespace {

struct Probe : HeightTestUnit {
    using HeightTestUnit::HeightTestUnit;
    using HeightTestUnit::process;
    using HeightTestUnit::reads;
    using HeightTestUnit::trace_processed;
};

struct LastValue : SignalSink {
    std::uint64_t value = 0;
    Signal add(const std::string&, const std::string&, unsigned) override { return 0; }
    void set(Signal, std::uint64_t shown) override { value = shown; }
    void pulse(Signal) override {}
};

template <class Action>
std::string sc_error_of(Action action) {
    try {
        action();
    } catch (const sc_core::sc_report& report) {
        return report.get_msg();
    }
    return "";
}

}  // namespace

TEST_CASE("an own height test's unit: other reads than declared, and values cut in waveforms, are errors") {
    static OwnTest test;
    datapath::Registers registers;
    registers.formats.height_test = datapath::add_height_test(test);
    shape_tables(registers);
    Design design;
    CycleScheduler clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
    Probe unit("unit", UnitContext{clock, registers, design});
    const auto error_of_reads = [&] {
        return sc_error_of([&] {
            Reads reads;
            unit.reads({}, reads);
        });
    };
    CHECK(error_of_reads().empty());
    test.adds = [](Reads& reads, const datapath::TableLayout& table) {
        reads.add(table.base);
        reads.add(table.base);
    };
    CHECK(error_of_reads() == "unit: height test own: reads() adds 2 requests, but requests = 1 is declared");
    registers.tests.summed_height_test = false;
    CHECK(error_of_reads().empty());
    registers.tests.summed_height_test = true;

    LastValue sink;
    const std::vector<UnitNumbers::Entry> none;
    UnitNumbers numbers(none);
    Signals signals(sink, numbers, "unit");
    signals.begin(true);
    unit.trace_processed(signals, {}, {});
    signals.begin(false);
    const auto error_of_value = [&](std::uint64_t value) {
        return sc_error_of([&] { unit.trace_processed(signals, {}, unit.process({}, {value})); });
    };
    CHECK(error_of_value(4095).empty());
    CHECK(sink.value == 4095);
    CHECK(error_of_value(4096) == "unit: height test own: the value value is 4096, but 12 bits are declared");
    CHECK(sink.value == 4095);
}

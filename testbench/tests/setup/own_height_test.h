#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "modules/datapath/height_tests.h"
#include "testbench/setup/height_tests/height_test_host.h"

namespace tessera::testing {

/// A height test of one's own that reads one entry of 12 bits from a table of 4 x 2 entries, and whose parts a test
/// case makes wrong.
struct OwnTest : datapath::HeightTestFunctions {
    std::array<Threshold, 2> registers{{{"own_threshold", 12, false, "codes"}}};
    int bits = 12;
    std::function<void(datapath::Reads&, const datapath::TableLayout&)> adds =
        [](datapath::Reads& reads, const datapath::TableLayout& table) { reads.add(table.base); };

    explicit OwnTest(const char* its_name = "own", unsigned its_requests = 1)
        : HeightTestFunctions(its_name, its_requests) {
        values = {{{"value", 12}}};
        compared = 0;
    }

    int entry_bits(const datapath::Formats&) const override { return bits; }
    void shape(const datapath::Registers&, datapath::TableLayout& table) const override {
        table.columns = 4;
        table.rows = 2;
    }
    std::array<Threshold, 2> thresholds(const datapath::Formats&) const override { return registers; }
    std::uint64_t limit(std::uint64_t, const datapath::TestParameters& tests) const override {
        return tests.height_threshold();
    }
    void reads(const datapath::HeightEdge&, const datapath::Registers& r, datapath::Reads& reads) const override {
        adds(reads, r.height_table);
    }
    void decide(const datapath::HeightEdge&, const datapath::Entries& entries, const datapath::Registers& r,
                datapath::HeightDecision& decision) const override {
        decision.values[0] = entries[0];
        decision.asks = entries[0] > limit(1, r.tests);
    }
};

struct OwnHost : HeightTestHost {
    std::vector<HeightThresholdKey> keys{{"own_threshold", 0.5, "full scale", between(0, 1), "a threshold"}};
    std::function<void(const datapath::TableLayout&, const TableSink&)> writes = [](const datapath::TableLayout&,
                                                                                    const TableSink&) {};
    const char* its_searched = "own_threshold";
    Range its_range{0.001, 1};

    const char* meaning() const override { return "a test"; }
    const std::vector<HeightThresholdKey>& thresholds() const override { return keys; }
    void set_thresholds(const TestSettings& tests, const datapath::Formats&, const ViewedScale&,
                        datapath::TestParameters& registers) const override {
        registers.height_thresholds[0] = static_cast<std::int64_t>(tests.threshold("own_threshold") * 4095);
    }
    void write_table(const PreparedScene& scene, const TableSink& sink) const override {
        writes(scene.registers.height_table, sink);
    }
    const char* searched() const override { return its_searched; }
    Range range(const PreparedScene&, datapath::SummedHeightUnit) const override { return its_range; }
};

}  // namespace tessera::testing

// A height test of one's own that is wrong: which error says so.
#include <catch2/catch.hpp>
#include <cmath>

#include "modules/datapath/table_shapes.h"
#include "testbench/setup/height_tests/table_rows.h"
#include "testbench/tests/setup/own_height_test.h"
#include "testbench/tests/support/refusals.h"

using namespace tessera;
using namespace tessera::testing;

TEST_CASE("an own height test's table: bytes outside it, and entries wider than its format, are refused") {
    static const OwnTest test;
    static OwnHost host;
    PreparedScene scene;
    scene.registers.formats.height_test = datapath::add_height_test(test);
    add_height_test_host(host);
    shape_tables(scene.registers);
    scene.registers.height_table.base = 0x3000;
    std::size_t written = 0;
    const auto error = [&] {
        return input_error_of([&] {
            write_height_table(scene,
                               [&](std::uint64_t, const unsigned char*, std::size_t count) { written += count; });
        });
    };
    const auto rows_of = [](std::uint64_t value) {
        return [=](const datapath::TableLayout& table, const TableSink& sink) {
            write_rows(table, sink, [&](std::uint32_t x, std::uint32_t y) { return x == 3 && y == 1 ? value : 0; });
        };
    };
    const auto bytes_at = [](std::int64_t offset, std::size_t count) {
        return [=](const datapath::TableLayout& table, const TableSink& sink) {
            const std::vector<unsigned char> zeros(count);
            sink(table.base + static_cast<std::uint64_t>(offset), zeros.data(), count);
        };
    };
    host.writes = rows_of(0xfff);
    CHECK(error().empty());
    CHECK(written == 16);
    host.writes = bytes_at(14, 2);
    CHECK(error().empty());
    written = 0;
    host.writes = rows_of(0x1000);
    CHECK(error() ==
          "height test own: write_table() writes an entry in which a bit above entry_bits() = 12 is set: entry 7");
    host.writes = rows_of(0x10000);
    CHECK(error() == "height test own: entry (3, 1) of a table is 65536, but an entry has 2 bytes");
    CHECK(written == 16);  // the first rows
    host.writes = bytes_at(15, 2);
    CHECK(error() == "height test own: write_table() writes 2 bytes from byte 15 on, but the table has 16 bytes");
    host.writes = bytes_at(-4, 2);
    CHECK(error() == "height test own: write_table() writes 2 bytes from byte -4 on, but the table has 16 bytes");
    CHECK(written == 16);
}

TEST_CASE("an own height test's two parts that declare different thresholds are refused") {
    static OwnTest test;
    static OwnHost host;
    datapath::add_height_test(test);
    const auto refusal = [&]() -> std::string {
        try {
            add_height_test_host(host);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    const HeightThresholdKey key = host.keys[0];
    host.keys = {key, key};
    host.keys[1].name = "second_threshold";
    CHECK(refusal() ==
          "height test own: the key second_threshold of the host's part has no register: there are own_threshold, at "
          "most two");
    host.keys = {key};
    test.registers[1] = {"second_threshold", 12, false, "codes"};
    CHECK(refusal() == "height test own: the register of second_threshold has no key in the host's part");
    test.registers[1] = {};
    host.its_searched = "third_threshold";
    CHECK(refusal() == "height test own: searched() is third_threshold, but the host's keys are own_threshold");
    host.its_searched = "own_threshold";
    test.compared = -1;
    CHECK(refusal() == "height test own: searched() is own_threshold, but compared = -1: no value is compared with it");
    test.compared = 0;
    CHECK(refusal().empty());
    CHECK(refusal() == "the host's part belongs to the height test that was added last");
}

TEST_CASE("an own height test's range() that cannot be searched is refused") {
    static const OwnTest test;
    static OwnHost host;
    const datapath::HeightTest added = datapath::add_height_test(test);
    add_height_test_host(host);
    const PreparedScene scene;
    const auto error = [&](double finest, double coarsest) {
        host.its_range = {finest, coarsest};
        return input_error_of([&] { searched_range(added, scene, datapath::SummedHeightUnit::sum); });
    };
    CHECK(error(0.001, 1).empty());
    CHECK(error(0, 1) == "height test own: range() is 0 to 1, but 0 < finest < coarsest <= 1 is needed");
    CHECK(error(0.5, 0.5) == "height test own: range() is 0.5 to 0.5, but 0 < finest < coarsest <= 1 is needed");
    CHECK(error(0.5, 2) == "height test own: range() is 0.5 to 2, but 0 < finest < coarsest <= 1 is needed");
    CHECK(error(std::nan(""), 1) == "height test own: range() is nan to 1, but 0 < finest < coarsest <= 1 is needed");
}

// A height test of one's own that is wrong: which error says so.
#include <catch2/catch.hpp>

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

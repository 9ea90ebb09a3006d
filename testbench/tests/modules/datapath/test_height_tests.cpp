// The four height tests as the unit and the models call them: what an edge reads, and how it is decided.
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

#include "modules/datapath/height_tests.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/table_shapes.h"
#include "modules/units/edge_tests/declared_reads.h"
#include "testbench/common/random.h"
#include "testbench/prove/random_edges/edge_machine.h"

using namespace tessera;
using namespace tessera::datapath;

namespace {

/// A map of 48 x 32 texels that repeats along u.
Registers registers_of(HeightTest test, bool codes = false) {
    Registers r;
    r.formats.height_test = test;
    r.formats.codes = codes;
    r.map = {48, 32, AddressMode::repeat, AddressMode::clamp};
    r.covered = {48, 32};
    r.displacement_map.base = 0x10000;
    r.height_table.base = 0x20000;
    shape_tables(r);
    return r;
}

HeightEdge edge_of(const TexCoord& i, const TexCoord& j, bool codes_known = false) {
    return {i, j, midpoint(i, j), codes_known, 0, 0, {}};
}

/// In whole texels from the middle of texel (column, row), along u.
HeightEdge edge_along_u(std::uint32_t column, std::uint32_t row, std::uint32_t texels, bool codes_known = false) {
    const TexCoord i{(column << 12) + 2048, (row << 12) + 2048};
    return edge_of(i, {i.u + (texels << 12), i.v}, codes_known);
}

Reads reads_of(const HeightEdge& edge, const Registers& r) {
    Reads reads;
    functions_of(r.formats.height_test).reads(edge, r, reads);
    return reads;
}

std::vector<std::uint64_t> addresses_of(const Reads& reads) {
    return {reads.addresses(), reads.addresses() + reads.entries()};
}

}  // namespace

TEST_CASE("height tests: a Summed Height Test reads three rectangles, or for a short edge the midpoint's code") {
    const Registers table = registers_of(HeightTest::summed_height),
                    codes = registers_of(HeightTest::summed_height, true);
    const HeightEdge edge = edge_along_u(10, 10, 8);  // rectangles of 4 x 1 texels
    const Reads three = reads_of(edge, table);
    REQUIRE(three.requests() == 3);
    CHECK(three.last_port() == 0);
    const auto corner = [&](std::uint64_t x, std::uint64_t y) { return 0x20000 + (y * 49 + x) * 4; };
    CHECK(std::vector<std::uint64_t>(three.addresses(), three.addresses() + 4) ==
          std::vector<std::uint64_t>{corner(12, 11), corner(8, 11), corner(12, 10), corner(8, 10)});
    CHECK(three.count(1) == 4);
    CHECK(reads_of(edge_along_u(47, 10, 8), table).count(0) == 6);  // wraps

    const HeightEdge short_edge = edge_along_u(10, 10, 2, true);
    const Reads code = reads_of(short_edge, codes);
    CHECK(code.requests() == 1);
    CHECK(code.port(0) == 1);
    CHECK(addresses_of(code) == std::vector<std::uint64_t>{0x10000 + (10 * 48 + 11) * 2});
    CHECK(reads_of(edge_along_u(10, 10, 2, false), codes).last_port() == 0);  // the ends are not displaced yet
    CHECK(reads_of(edge_along_u(10, 10, 8, true), codes).last_port() == 0);   // longer
    CHECK(reads_of(short_edge, table).last_port() == 0);                      // a design without codes
}

TEST_CASE("height tests: a Rank Test reads the midpoint's entry, and nothing if it is no lattice point") {
    const Registers r = registers_of(HeightTest::rank);
    CHECK(addresses_of(reads_of(edge_along_u(10, 10, 8), r)) == std::vector<std::uint64_t>{0x20000 + 10 * 48 + 14});
    const Reads none = reads_of(edge_along_u(10, 10, 3), r);
    CHECK(none.requests() == 0);
    CHECK(none.last_port() == 0);
}

TEST_CASE("height tests: a Curvature Test reads one cell, or for a short edge three codes") {
    const Registers r = registers_of(number_of<CurvatureTest>());
    const Reads cell = reads_of(edge_along_u(10, 10, 8), r);
    CHECK(cell.requests() == 1);
    CHECK(cell.entries() == 1);
    CHECK(cell.port(0) == 0);
    const Reads codes = reads_of(edge_along_u(10, 10, 2), r);
    CHECK(codes.requests() == 1);
    CHECK(codes.port(0) == 1);
    const auto code = [](std::uint64_t x) { return 0x10000 + (10 * 48 + x) * 2; };
    CHECK(addresses_of(codes) == std::vector<std::uint64_t>{code(10), code(12), code(11)});
}

TEST_CASE("height tests: a Mipmap Test reads the blocks of both ends and of the midpoint, a request each") {
    const Registers r = registers_of(number_of<MipmapTest>());
    const Reads three = reads_of(edge_along_u(10, 10, 2), r);
    CHECK(three.requests() == 3);
    const auto block = [](std::uint64_t x) { return 0x20000 + (10 * 48 + x) * 2; };
    CHECK(addresses_of(three) == std::vector<std::uint64_t>{block(10), block(12), block(11)});
}

TEST_CASE("height tests: an edge asks for a split if the compared value exceeds the limit") {
    Random random(3);
    for (std::size_t kind = 0; kind < height_tests().size(); ++kind) {
        const HeightTestFunctions& test = *height_tests()[kind];
        Registers r = registers_of(static_cast<HeightTest>(kind));
        CHECK(&functions_of(r.formats.height_test) == &test);
        if (test.compared < 0) {
            CHECK(test.limit(7, r.tests) == 0);
            continue;
        }
        int asked = 0;
        for (int k = 0; k < 2000; ++k) {
            r.tests.summed_height_unit = random.coin() ? SummedHeightUnit::sum : SummedHeightUnit::area;
            r.tests.height_thresholds[0] = random.natural(0, 80000);
            const TexCoord i{random.natural(0, 40 << 12), random.natural(0, 30 << 12)};
            const HeightEdge edge = edge_of(i, {i.u + random.natural(0, 16 << 12), i.v + random.natural(0, 2 << 12)});
            Entries entries{};
            for (std::uint64_t& entry : entries)
                entry = random.natural(0, 65535);
            HeightDecision decision;
            test.decide(edge, entries, r, decision);
            const std::uint64_t value = decision.values[static_cast<std::size_t>(test.compared)];
            CHECK(decision.asks == (value > test.limit(test.weight(decision), r.tests)));
            asked += decision.asks ? 1 : 0;
            // With a limit of the value itself, and of one less.
            r.tests.summed_height_unit = SummedHeightUnit::sum;
            for (const std::uint64_t below : {std::uint64_t{0}, std::uint64_t{1}}) {
                if (value < below)
                    continue;
                r.tests.height_thresholds[0] = static_cast<std::int64_t>(value - below);
                HeightDecision exact;
                test.decide(edge, entries, r, exact);
                CHECK(exact.asks == (below == 1));
            }
        }
        CHECK(asked > 50);
        CHECK(asked < 1950);
    }
}

namespace {

/// Declares one request of one entry, or for codes three, and adds what a case says.
struct AnyReads : HeightTestFunctions {
    using Adds = void (*)(Reads&, const Registers&);
    Adds adds;

    explicit AnyReads(Adds its_adds, unsigned its_requests = 1)
        : HeightTestFunctions("any", its_requests), adds(its_adds) {}
    int entry_bits(const Formats&) const override { return 16; }
    void shape(const Registers&, TableLayout& table) const override { table.columns = table.rows = 4; }
    std::array<Threshold, 2> thresholds(const Formats&) const override { return {}; }
    void reads(const HeightEdge&, const Registers& r, Reads& reads) const override { adds(reads, r); }
    void decide(const HeightEdge&, const Entries&, const Registers&, HeightDecision&) const override {}
};

}  // namespace

TEST_CASE("height tests: reads that are not as declared are named with their limit") {
    const auto add = [](Reads& reads, unsigned requests, unsigned entries) {
        for (unsigned k = 0; k < requests; ++k) {
            reads.add_request();
            for (unsigned l = 0; l < entries; ++l)
                reads.add_entry(0);
        }
    };
    struct Row {
        unsigned requests, codes;
        bool rectangles;
        unsigned port, added, of_entries;
        std::string says;  // nothing: as declared
    };
    for (const Row& row : {
             Row{1, 0, false, 0, 1, 1, ""},
             {3, 0, true, 0, 3, 9, ""},
             {2, 3, false, 1, 1, 3, ""},
             {3, 0, false, 0, 4, 1, "adds 4 requests, but at most 3 are kept"},
             {3, 0, false, 0, 2, 1, "adds 2 requests, but requests = 3 is declared"},
             {1, 0, false, 0, 0, 0, "adds 0 requests, but requests = 1 is declared, and may_read_nothing = false"},
             {1, 0, false, 0, 1, 2, "adds 2 entries to a request, but with rectangles = false the range is 1 to 1"},
             {1, 0, true, 0, 1, 28, "adds 28 entries to a request, but with rectangles = true the range is 1 to 9"},
             {2, 0, true, 0, 2, 0, "adds 0 entries to a request, but with rectangles = true the range is 1 to 9"},
             {2, 3, false, 1, 2, 3, "adds 2 requests, but codes are read in 1"},
             {2, 3, false, 1, 1, 2, "adds 2 entries to a request, but with codes = 3 the range is 3 to 3"},
             {1, 0, false, 1, 1, 1, "goes through port 1, but the last port is 0: in this design no edge reads codes"},
             {1, 3, false, 2, 1, 1, "goes through port 2, but the last port is 1"},
         }) {
        AnyReads test(nullptr, row.requests);
        test.codes = row.codes;
        test.rectangles = row.rectangles;
        Reads reads;
        reads.through(row.port);
        add(reads, row.added, row.of_entries);
        INFO(row.says);
        CHECK(as_declared(test, reads, {}) == row.says.empty());
        if (!row.says.empty())
            CHECK(fault_of(test, reads, {}) == "height test any: reads() " + row.says);
    }
    AnyReads test(nullptr, 2);
    test.codes = 1;
    Reads mixed, early;
    mixed.add(0);
    mixed.through(1);
    mixed.add(0);
    test.requests = 2;
    CHECK_FALSE(as_declared(test, mixed, {}));
    mixed.through(0);
    CHECK_FALSE(as_declared(test, mixed, {}));
    CHECK(fault_of(test, mixed, {}) == "height test any: reads() adds requests through both ports");
    early.add_entry(0);
    early.add(0);
    early.add(0);
    CHECK_FALSE(as_declared(test, early, {}));
    CHECK(fault_of(test, early, {}) == "height test any: reads() adds an entry before the first request");
}

TEST_CASE("height tests: the bare machine refuses reads that are not as declared, or outside the table") {
    const auto said = [](const char* name, AnyReads::Adds adds) -> std::string {
        static std::deque<AnyReads> added;  // for the rest of the process, as add_height_test() requires
        AnyReads& test = added.emplace_back(adds);
        test.name = name;
        Registers r = registers_of(add_height_test(test));
        Tables tables = make_tables(r, std::vector<std::uint32_t>(48 * 32), {});
        const EdgeMachine machine(r, std::move(tables));
        try {
            machine.test_heights(edge_along_u(10, 10, 8));
        } catch (const std::logic_error& error) {
            return error.what();
        }
        return "";
    };
    CHECK(said("last", [](Reads& reads, const Registers& r) { reads.add(r.height_table.base + 30); }).empty());
    CHECK(said("after", [](Reads& reads, const Registers& r) { reads.add(r.height_table.base + 32); }) ==
          "height test after: reads() adds byte 32 of a table of 32 bytes");
    CHECK(said("before", [](Reads& reads, const Registers& r) { reads.add(r.height_table.base - 2); }) ==
          "height test before: reads() adds byte -2 of a table of 32 bytes");
    CHECK(said("many", [](Reads& reads, const Registers& r) {
              for (int k = 0; k < 100; ++k)
                  reads.add(r.height_table.base);
          }) == "height test many: reads() adds 100 requests, but at most 3 are kept");
}

TEST_CASE("height tests: one whose declarations are wrong is not added, by a library or by a program") {
    struct Declared : AnyReads {
        int bits = 16;
        std::array<Threshold, 2> its_thresholds{};
        Declared() : AnyReads(nullptr) {
            name = "declared";
            values = {{{"value", 16}}};
        }
        int entry_bits(const Formats&) const override { return bits; }
        std::array<Threshold, 2> thresholds(const Formats&) const override { return its_thresholds; }
    };
    const auto refusal = [](void (*make_wrong)(Declared&)) -> std::string {
        Declared test;
        make_wrong(test);
        const std::size_t before = height_tests().size();
        try {
            add_height_test(test);
        } catch (const std::invalid_argument& error) {
            CHECK(height_tests().size() == before);
            return error.what();
        }
        return "";
    };
    const std::string other =
        "\": choose a name of lower-case letters, digits and _, other than base, both, generation, highlight, normal, "
        "tex_coord, view";
    CHECK(refusal([](Declared& t) { t.name = nullptr; }) == "a height test is called \"" + other);
    CHECK(refusal([](Declared& t) { t.name = "view"; }) == "a height test is called \"view" + other);
    CHECK(refusal([](Declared& t) { t.name = "2nd"; }) == "a height test is called \"2nd" + other);
    CHECK(refusal([](Declared& t) { t.name = "a test"; }) == "a height test is called \"a test" + other);
    CHECK(refusal([](Declared& t) { t.name = "rank"; }) == "there is another height test rank: choose another name");
    const std::string its = "height test declared: ";
    CHECK(refusal([](Declared& t) { t.latency = 0; }) == its + "latency = 0, but the range is 1 to 1000000");
    CHECK(refusal([](Declared& t) { t.latency = 1000001; }) ==
          its + "latency = 1000001, but the range is 1 to 1000000");
    CHECK(refusal([](Declared& t) { t.requests = 4; }) == its + "requests = 4, but the range is 0 to 3");
    CHECK(refusal([](Declared& t) { t.codes = 10; }) == its + "codes = 10, but the range is 0 to 9");
    CHECK(refusal([](Declared& t) { t.compared = 1; }) == its + "compared = 1, but the range is -1 to 0");
    CHECK(refusal([](Declared& t) { t.bits = 65; }) == its + "entry_bits() = 65, but the range is 1 to 64");
    CHECK(refusal([](Declared& t) { t.values[0].bits = 65; }) ==
          its + "bits of the value value = 65, but the range is 1 to 64");
    CHECK(refusal([](Declared& t) {
              t.its_thresholds[0] = {"limit", 64};
          }) == its + "bits of the threshold limit = 64, but the range is 0 to 63");
    CHECK(refusal([](Declared& t) { t.feature = 12; }) == its + "feature = 12, but the range is 13 to 15");
    static Declared right;
    right.feature = 13;
    const HeightTest added = add_height_test(right);
    CHECK(&functions_of(added) == &right);
    CHECK(refusal([](Declared&) {}) == "there is another height test declared: choose another name");
    CHECK(refusal([](Declared& t) {
              t.name = "second";
              t.feature = 13;
          }) == "height test second: feature = 13 is that of the height test declared");
}

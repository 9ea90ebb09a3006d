#include <catch2/catch.hpp>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "modules/memories/table_cache.h"
#include "modules/memories/table_memory.h"
#include "testbench/common/random.h"
#include "testbench/tests/modules/memories/memory_reader.h"
#include "testbench/tests/support/case_table.h"

// A table in off-chip memory behind a cache, cycle by cycle: fills, hits on pending lines, eviction, the channel.

using namespace tessera;
using namespace tessera::testing;
using sc_core::SC_PS;
using sc_core::sc_time;
using Cycles = std::vector<std::uint64_t>;
using Reads = std::vector<std::vector<std::uint32_t>>;

namespace {

const sc_time period(10, SC_PS);
const datapath::TableLayout layout{4096, 16, 16, 4};

/// A table whose entry k holds 3 * k + 1, 20 cycles away at 16 bytes per cycle; its cache, and a reader.
struct Bench {
    CycleScheduler clock{"clock", period};
    Channel channel;
    TableMemory table;
    TableCache cache;
    MemoryReader reader;

    explicit Bench(const MemoryTiming& timing, const StallParameters& stalls = {}, bool direct_access = false)
        : channel({20, 16, 4}),
          table("table", clock, layout, timing, stalls, &channel),
          cache("cache", clock, layout, timing, stalls),
          reader("reader", clock, 64, direct_access) {
        clock.attach(table);
        clock.attach(cache);
        cache.table.bind(table);
        reader.port.bind(cache);
        reader.base = layout.base;
        reader.entry_bytes = 4;
    }

    void run() {
        sc_core::sc_start(sc_core::SC_ZERO_TIME);
        reader.fill(256);
        sc_core::sc_start();
        reader.check_values();
        CHECK(cache.entries_read() == reader.values.size());
        CHECK(cache.fills() == table.activity().items_in());
        CHECK(cache.bytes_fetched() == cache.fills() * cache.table.entry_bytes());
        CHECK(cache.describe_contents().empty());
        CHECK(table.describe_contents().empty());
    }
};

MemoryTiming behind(const CacheTiming& cache, unsigned banks = 1) {
    MemoryTiming timing;
    timing.banks = banks;
    timing.buffer = 4;
    timing.cache = cache;
    return timing;
}

struct Row {
    std::string name;
    MemoryTiming timing;
    Reads reads;
    Cycles answers;
    std::uint64_t fills;
};

// A line of 64 bytes holds 16 entries and occupies the channel for four cycles. The first is requested in cycle 10,
// leaves the channel in 14 and arrives in 34. Its entries are then read one per cycle, each answered a cycle later.
const CaseTable answers(
    "cache: ",
    {
        Row{"a missing line is fetched", behind({256, 64, 2, 4}), {{0}}, {35}, 1},
        {"entries of a pending line wait for it, and cause no fill", behind({256, 64, 2, 4}), {{0}, {1}}, {35, 36}, 1},
        // the second line leaves the channel in 18 and arrives in 38
        {"two lines follow each other on the channel", behind({256, 64, 2, 4}), {{0}, {16}}, {35, 39}, 2},
        {"a gather waits for its last line", behind({256, 64, 2, 4}), {{0, 16, 1, 17}}, {42}, 2},
        // {16} is looked up when the first is answered, in 34, and arrives in 58. {0} is found in 34 and read in 36.
        {"no more requests are looked up than may be in flight",
         behind({256, 64, 2, 2}),
         {{0}, {1}, {16}, {0}},
         {35, 36, 59, 59},
         2},
        // one line: 16 replaces 0 in 34, 0 replaces 16 in 58
        {"a cache of one line evicts it", behind({1, 64, 4, 4}), {{0}, {16}, {0}}, {35, 59, 83}, 3},
        {"one line serves a gather from two lines, one after the other", behind({1, 64, 4, 4}), {{0, 16}}, {60}, 2},
        // lines 0 and 3 share a set of one line
        {"a full set evicts, another does not", behind({128, 64, 1, 4}), {{0}, {16}, {48}, {16}}, {35, 39, 59, 59}, 3},
        // Only 8 of 10 bytes are whole entries: 1 cycle of the channel
        {"a line holds whole entries", behind({256, 10, 2, 4}), {{0, 1}, {2}}, {33, 34}, 2},
    },
    [](const Row& row) {
        Bench bench(row.timing);
        bench.reader.reads = row.reads;
        bench.run();
        CHECK(bench.reader.answered == row.answers);
        CHECK(bench.cache.fills() == row.fills);
    });

struct RandomRow {
    std::string name;
    unsigned seed;
};

const CaseTable random_gathers(
    "cache: any gathers, sizes and stalls give the table's entries in order, seed ",
    {RandomRow{"0", 0},
     {"1", 1},
     {"2", 2},
     {"3", 3},
     {"4", 4},
     {"5", 5},
     {"6", 6},
     {"7", 7},
     {"8", 8},
     {"9", 9},
     {"10", 10},
     {"11", 11}},
    [](const RandomRow& row) {
        Random random(row.seed);
        MemoryTiming timing = behind({random.one_of({1U, 64U, 100U, 1024U}), random.one_of({1U, 16U, 64U, 100U}),
                                      random.natural(1, 4), random.natural(1, 12)},
                                     random.natural(1, 4));
        timing.latency = random.natural(0, 3);
        timing.buffer = random.natural(1, 4);
        StallParameters stalls;
        if (random.coin())
            stalls = {row.seed, 300, 9};
        Bench bench(timing, stalls);
        std::set<std::uint64_t> lines;
        for (int k = 0; k < 200; ++k) {
            std::vector<std::uint32_t> read;
            for (std::int64_t entry = random.integer(1, 9); entry > 0; --entry) {
                read.push_back(random.natural(0, 255));
                lines.insert(std::uint64_t{read.back()} * 4 / bench.cache.table.entry_bytes());
            }
            bench.reader.reads.push_back(read);
        }
        bench.run();
        CHECK(bench.cache.fills() >= lines.size());
        CHECK(bench.channel.occupied_cycles() == bench.cache.fills() * ((bench.cache.table.entry_bytes() + 15) / 16));
        CHECK(bench.table.occupied_cycles() == bench.channel.occupied_cycles());
    });

struct FunctionalRow {
    std::string name;
    bool direct_access;
    std::uint64_t transactions;
};

// With direct access only the first read is a transaction.
const CaseTable functional_reads("cache: functional reads bypass it, ",
                                 {FunctionalRow{"by transaction", false, 256}, {"directly", true, 1}},
                                 [](const FunctionalRow& row) {
                                     Bench bench(behind({64, 64, 1, 1}), {}, row.direct_access);
                                     sc_core::sc_start(sc_core::SC_ZERO_TIME);
                                     bench.reader.fill(256);
                                     sc_time delay;
                                     for (std::uint32_t entry = 0; entry < 256; ++entry)
                                         CHECK(bench.reader.port.read(layout.base + std::uint64_t{entry} * 4, delay) ==
                                               3 * entry + 1);
                                     CHECK(delay == 256 * period);
                                     CHECK(bench.cache.fills() == 0);
                                     CHECK(bench.table.transactions() == row.transactions);
                                 });

}  // namespace

TEST_CASE("cache: a write is refused") {
    Bench bench(behind({64, 64, 1, 1}));
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    std::uint32_t value = 7;
    MemoryRequest request{tlm::TLM_WRITE_COMMAND, 1, 4, {layout.base}, reinterpret_cast<unsigned char*>(&value)};
    sc_time delay;
    bench.reader.port.socket->b_transport(request, delay);
    CHECK(request.response == tlm::TLM_COMMAND_ERROR_RESPONSE);
}

TEST_CASE("cache: its requests and pending lines are described") {
    Bench bench(behind({64, 64, 1, 2}));
    bench.reader.reads = {{0}, {1}, {2}};
    sc_core::sc_start(sc_time(20 * 10, SC_PS));
    CHECK(bench.cache.describe_contents() == "3 requests, 1 line being fetched");
    sc_core::sc_start();
    CHECK(bench.cache.describe_contents().empty());
}

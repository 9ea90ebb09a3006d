#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "modules/memories/table_memory.h"
#include "testbench/common/random.h"
#include "testbench/tests/modules/memories/memory_reader.h"
#include "testbench/tests/support/case_table.h"

// A table's memory, cycle by cycle: requests at its ports and banks, latency, arbitration, back-pressure.

using namespace tessera;
using namespace tessera::testing;
using sc_core::SC_PS;
using sc_core::sc_time;
using Cycles = std::vector<std::uint64_t>;

namespace {

const sc_time period(10, SC_PS);
const datapath::TableLayout layout{4096, 16, 16, 4};

/// A memory whose entry k holds 3 * k + 1, and its readers.
struct Bench {
    CycleScheduler clock{"clock", period};
    TableMemory memory;
    std::vector<std::unique_ptr<MemoryReader>> readers;

    explicit Bench(const MemoryTiming& timing, unsigned count = 1, const StallParameters& stalls = {},
                   std::size_t most_under_way = 64)
        : memory("memory", clock, layout, timing, stalls) {
        clock.attach(memory);
        for (unsigned k = 0; k < count; ++k) {
            readers.push_back(
                std::make_unique<MemoryReader>(("reader_" + std::to_string(k)).c_str(), clock, most_under_way, false));
            readers.back()->base = layout.base;
            readers.back()->entry_bytes = readers.back()->port.entry_bytes();
            readers.back()->port.bind(memory);
        }
    }
    MemoryReader& reader(std::size_t k = 0) { return *readers[k]; }

    void run() {
        sc_core::sc_start(sc_core::SC_ZERO_TIME);
        reader().fill(256);
        sc_core::sc_start();
        memory.activity().finish(clock.last_cycle() + 1);
        for (const auto& reader : readers)
            reader->check_values();
        CHECK(memory.activity().items_in() == memory.activity().items_out());
        CHECK(memory.describe_contents().empty());
    }
};

/// `count` reads of one entry each: 0, 1, 2 ...
std::vector<std::vector<std::uint32_t>> single_reads(std::uint32_t count) {
    std::vector<std::vector<std::uint32_t>> reads;
    for (std::uint32_t k = 0; k < count; ++k)
        reads.push_back({k});
    return reads;
}

/// `count` gathers of `entries` entries.
std::vector<std::vector<std::uint32_t>> gathers(std::uint32_t count, std::uint32_t entries) {
    std::vector<std::vector<std::uint32_t>> reads(count);
    for (std::uint32_t k = 0; k < count; ++k)
        for (std::uint32_t entry = 0; entry < entries; ++entry)
            reads[k].push_back((17 * k + 5 * entry) % 256);
    return reads;
}

/// first, first + step, ...
Cycles every(std::uint64_t first, std::uint64_t step, std::size_t count) {
    Cycles cycles;
    for (std::size_t k = 0; k < count; ++k)
        cycles.push_back(first + step * k);
    return cycles;
}

MemoryTiming timing(unsigned ports, unsigned banks, unsigned latency, unsigned width = 0, unsigned buffer = 1) {
    return {ports, banks, latency, width, buffer};
}

MemoryTiming windowed(unsigned banks, unsigned window) {
    MemoryTiming timing;
    timing.banks = banks;
    timing.window = window;
    return timing;
}

struct Row {
    std::string name;
    MemoryTiming timing;
    std::vector<std::vector<std::uint32_t>> reads;
    Cycles answers;
};

// Request k of one entry takes the port in cycle 10 + k; its data arrive `latency` cycles later. What the ports alone
// decide is in test_arbiters.cpp.
const CaseTable answers(
    "memory: ",
    {
        Row{"one port takes an address a cycle, data arrive a latency later", timing(1, 1, 1), single_reads(20),
            every(11, 1, 20)},
        {"latency 0 answers in the cycle of the address", timing(1, 1, 0), single_reads(20), every(10, 1, 20)},
        {"latency 2000 is beyond the clock's table", timing(1, 1, 2000), single_reads(3), every(2010, 1, 3)},
        // addresses in cycles 10 to 13, 14 to 17 ...; the last address's data complete the response
        {"a gather of four keeps one port for four cycles", timing(1, 1, 1), gathers(10, 4), every(14, 4, 10)},
        // nine slots, four per cycle: gather k ends in slot 9 k + 8, in cycle 10 + floor((9 k + 8) / 4)
        {"four ports and gathers of nine share cycles", timing(4, 1, 1), gathers(6, 9), {13, 15, 17, 19, 22, 24}},
        // 4 bytes at 2 per cycle: entries 0 and 1 in cycles 10 and 11, one on each port
        {"two narrow ports read two entries in parts, and no entry in one cycle",
         timing(2, 1, 1, 2),
         single_reads(6),
         {12, 12, 14, 14, 16, 16}},
        // Entries 0, 1, 2, 3 lie in banks 0, 1, 2, 3: one cycle; 0, 4, 8, 12 all in bank 0: four. Gather 2 occupies
        // bank 0 in cycles 12 to 15. Requests are served in order, as soon as any bank is free: gather 3 from cycle 13
        // to 14, in banks 1 (twice), 2, 3. Responses stay in order: gather 2's is in 16, gather 3's follows.
        {"entries in different banks are read at the same time",
         timing(1, 4, 1),
         {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 4, 8, 12}, {1, 2, 3, 5}},
         {11, 12, 16, 16}},
        // Bank 0 in 10, 11, 12; without a window {0, 1} waits for it until 13, and {1, 2} for both its banks until 14.
        {"a request waits for each of its banks", timing(1, 4, 1), {{0, 4, 8}, {0, 1}, {1, 2}}, {13, 14, 15}},
        // {0, 1} takes bank 1 in 10 and bank 0 in 13; {1, 2} starts in 13, when the first is complete.
        {"with a window of two it waits for the request before the last",
         windowed(4, 2),
         {{0, 4, 8}, {0, 1}, {1, 2}},
         {13, 14, 14}},
    },
    [](const Row& row) {
        Bench bench(row.timing);
        bench.reader().reads = row.reads;
        bench.run();
        CHECK(bench.reader().answered == row.answers);
        std::uint64_t entries = 0;
        for (const auto& read : row.reads)
            entries += read.size();
        CHECK(bench.memory.transactions() == entries);
        CHECK(bench.reader().port.reads() == entries);
    });

}  // namespace

TEST_CASE("memory: a request for an idle bank does not overtake one for a busy bank") {
    // all in bank 0 of two: one per cycle, as with one bank; the buffer (1) leaves the rest waiting at the inputs
    Bench bench(timing(1, 2, 1), 1, {}, 2);
    for (std::uint32_t k = 0; k < 10; ++k)
        bench.reader().reads.push_back({2 * k, 2 * k + 4, 2 * k + 8});
    bench.run();
    CHECK(bench.reader().answered == every(13, 3, 10));
    CHECK(bench.memory.occupied_cycles() == 30);
    CHECK(bench.memory.cycles_held_up() > 20);
}

TEST_CASE("memory: three readers take turns, none starves") {
    // One port, 30 reads each. In cycle 10 the reader called first takes the free port, then the buffer, and is the
    // first to wait: its data arrive in 11, 12, 13. From then on all three wait at their inputs and each is served
    // every third cycle, until the first reader has completed its 30, in 94; the other two share the rest.
    Bench bench(timing(1, 1, 1), 3);
    for (const auto& reader : bench.readers)
        reader->reads = single_reads(30);
    bench.run();
    const auto joined = [](Cycles a, const Cycles& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    };
    CHECK(bench.reader(0).answered == joined({11, 12}, every(13, 3, 28)));
    CHECK(bench.reader(1).answered == joined(every(14, 3, 28), {97, 99}));
    CHECK(bench.reader(2).answered == joined(every(15, 3, 28), {98, 100}));
}

TEST_CASE("memory: its requests are described") {
    Bench bench(timing(1, 1, 1), 3);
    for (const auto& reader : bench.readers)
        reader->reads = single_reads(30);
    sc_core::sc_start(sc_time(20 * 10, SC_PS));
    // one being read, one in the buffer, one from each reader at an input
    CHECK(bench.memory.describe_contents() == "2 requests, 3 waiting at the inputs");
    sc_core::sc_start();
    CHECK(bench.memory.describe_contents().empty());
}

TEST_CASE("memory: a late reader waits for at most one request of each other reader and the buffer's") {
    Bench bench(timing(1, 1, 1), 3);
    bench.reader(0).reads = gathers(20, 4);
    bench.reader(1).reads = gathers(20, 4);
    bench.reader(2).reads = single_reads(1);
    bench.reader(2).from = 40;
    bench.run();
    // at worst one gather is being read, one is in the buffer, and one from each other reader goes first
    CHECK(bench.reader(2).answered[0] <= 40 + 4 * 4 + 1 + 1);
    CHECK(bench.reader(2).answered[0] > 41);
}

TEST_CASE("memory: a full buffer withholds END_REQ") {
    // buffer 1, gathers of four: in cycle 10 the first is served, the second waits in the buffer, and the third is
    // offered until the first's four cycles are over
    Bench bench(timing(1, 1, 1));
    bench.reader().reads = gathers(6, 4);
    bench.run();
    CHECK(bench.reader().offered == Cycles{10, 10, 10, 14, 18, 22});
}

TEST_CASE("memory: a buffer of four takes four more requests") {
    Bench bench(timing(1, 1, 1, 0, 4));
    bench.reader().reads = gathers(8, 4);
    bench.run();
    // one served, four in the buffer, the sixth offered; each served gather makes room for one more
    CHECK(bench.reader().offered == Cycles{10, 10, 10, 10, 10, 10, 14, 18});
    CHECK(bench.reader().answered == every(14, 4, 8));
}

TEST_CASE("memory: a reader has no more requests in flight than its limit") {
    // two in flight, latency 10: a pair in cycles 10 and 11, answered in 20 and 21, each replaced at once
    Bench bench(timing(1, 1, 10), 1, {}, 2);
    bench.reader().reads = single_reads(6);
    bench.run();
    CHECK(bench.reader().answered == Cycles{20, 21, 30, 31, 40, 41});
}

TEST_CASE("memory: busy from the first address to the last answer, a port only while it takes addresses") {
    Bench bench(timing(1, 1, 7), 2);
    bench.reader(0).reads = gathers(9, 4);
    bench.reader(1).reads = single_reads(11);
    bench.reader(1).from = 300;
    bench.run();
    CHECK(bench.memory.slots_taken() == 9 * 4 + 11);
    // twice, for cycle 300 begins anew, the last address waits 7 cycles for its data, the first of them its port's
    CHECK(bench.memory.activity().cycles_in(State::busy) == 9 * 4 + 6 + 11 + 6);
    CHECK(bench.memory.occupied_cycles() == 9 * 4 + 11);
}

TEST_CASE("memory: the mean occupancy is throughput times latency") {
    // Little's law: 40 reads, each in the memory for `latency` cycles from its address to its data, none waits
    Bench bench(timing(1, 1, 25));
    bench.reader().reads = single_reads(1);
    bench.run();
    CHECK(bench.memory.activity().item_cycles() == 25);
    CHECK(bench.memory.activity().high_water_mark() == 1);
}

// Gathers of four from entry k. Each side works as if alone: 4 cycles per gather, latency 3 on the second side.
TEST_CASE("memory: two sides share one table, and neither side's readers wait for the other's") {
    Bench bench(timing(1, 1, 1));
    TableMemory second("second_side", bench.clock, bench.memory, layout, timing(1, 1, 3), {});
    bench.clock.attach(second);
    MemoryReader reader("reader_of_second_side", bench.clock, 64, true);
    reader.base = layout.base;
    reader.entry_bytes = reader.port.entry_bytes();
    reader.port.bind(second);
    bench.reader().reads = gathers(10, 4);
    reader.reads = gathers(12, 4);
    bench.run();
    reader.check_values();
    CHECK(bench.reader().answered == every(14, 4, 10));
    CHECK(reader.answered == every(16, 4, 12));
    CHECK(bench.memory.transactions() == 40);
    CHECK(second.transactions() == 48);
    CHECK(second.slots_taken() == 48);
    // functional mode: first by a transaction, then by DMI, the data written through the first side
    sc_time delay;
    for (const std::uint32_t entry : {77u, 78u})
        CHECK(reader.port.read(layout.base + 4 * entry, delay) == 3 * entry + 1);
    CHECK(second.transactions() == 49);
}

TEST_CASE("memory: random stalls delay answers but do not change them") {
    Bench bench(timing(2, 2, 3), 3, {9, 400, 12});
    for (const auto& reader : bench.readers)
        reader->reads = gathers(200, 4);
    bench.run();
    // 2400 entries over four slots a cycle would take 600 cycles
    CHECK(bench.clock.last_cycle() > 10 + 600 + 100);
    for (const auto& reader : bench.readers)
        CHECK(std::is_sorted(reader->answered.begin(), reader->answered.end()));
}

TEST_CASE("memory: b_transport adds the latency to the delay it is given, and counts the read") {
    Bench bench(timing(1, 1, 6));
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    bench.reader().fill(256);
    sc_time delay(33, SC_PS);
    CHECK(bench.reader().port.read(layout.base + 4 * 77, delay) == 3 * 77 + 1);
    CHECK(delay == sc_time(33 + 60, SC_PS));
    CHECK(bench.memory.transactions() == 1);
    CHECK(bench.reader().port.reads() == 1);
}

namespace {

struct PortOwner : sc_core::sc_module {
    MemoryPort port;
    PortOwner(const sc_core::sc_module_name& name, std::size_t entry_bytes)
        : sc_module(name), port("port", entry_bytes, true) {}
};

/// A memory whose reader makes requests, and one like it that tells its reader their cycles.
struct TwoMemories {
    TableMemory requested, prompt;
    MemoryReader reader;
    PortOwner owner;
    MemoryPort& port = owner.port;

    TwoMemories(const std::string& name, CycleScheduler& clock, const MemoryTiming& timing)
        : requested((name + "_requested").c_str(), clock, layout, timing, {}),
          prompt((name + "_prompt").c_str(), clock, layout, timing, {}),
          reader((name + "_reader").c_str(), clock, 64, true),
          owner((name + "_owner").c_str(), 4) {
        clock.attach(requested);
        reader.base = layout.base;
        reader.entry_bytes = reader.port.entry_bytes();
        reader.port.bind(requested);
        port.bind(prompt);
    }

    /// Makes the reader's requests, each as early as possible, of the prompt memory.
    void read_promptly() {
        std::uint64_t offered = reader.from;
        for (std::size_t k = 0; k < reader.reads.size(); ++k) {
            std::vector<std::uint64_t> addresses, values(reader.reads[k].size());
            for (const std::uint32_t entry : reader.reads[k])
                addresses.push_back(layout.base + 4 * entry);
            CHECK(reader.offered.at(k) == offered);
            const PromptMemory::Times times =
                port.read_promptly(addresses.data(), static_cast<unsigned>(addresses.size()), values.data(), offered);
            CHECK(reader.answered.at(k) == times.answered);
            for (std::size_t entry = 0; entry < values.size(); ++entry)
                REQUIRE(values[entry] == 3 * reader.reads[k][entry] + 1);
            offered = times.accepted;
        }
    }

    void compare(std::uint64_t cycles) {
        requested.activity().finish(cycles);
        prompt.activity().finish(cycles);
        const Activity &a = requested.activity(), &b = prompt.activity();
        CHECK(a.items_in() == b.items_in());
        CHECK(a.items_out() == b.items_out());
        CHECK(a.item_cycles() == b.item_cycles());
        CHECK(a.high_water_mark() == b.high_water_mark());
        for (std::size_t state = 0; state < states; ++state)
            CHECK(a.cycles_in(static_cast<State>(state)) == b.cycles_in(static_cast<State>(state)));
        CHECK(requested.transactions() == prompt.transactions());
        CHECK(requested.slots_taken() == prompt.slots_taken());
        CHECK(requested.occupied_cycles() == prompt.occupied_cycles());
        CHECK(requested.cycles_held_up() == prompt.cycles_held_up());
    }
};

}  // namespace

TEST_CASE("memory: a prompt memory tells the cycles that requests take, and has the same figures") {
    Random random(11);
    CycleScheduler clock("clock", period);
    std::vector<std::unique_ptr<TwoMemories>> pairs;
    for (int k = 0; k < 20; ++k) {
        MemoryTiming its = timing(random.natural(1, 4), 1u << random.natural(0, 4), random.natural(0, 9),
                                  random.natural(0, 4), random.natural(1, 4));
        its.interleave = random.coin() ? Interleave::entry : Interleave::exclusive_or;
        its.window = random.coin() ? random.natural(1, 9) : 0;
        pairs.push_back(std::make_unique<TwoMemories>("pair_" + std::to_string(k), clock, its));
        for (int request = 0; request < 60; ++request) {
            std::vector<std::uint32_t> entries(random.natural(1, 9));
            for (std::uint32_t& entry : entries)
                entry = random.natural(0, 255);
            pairs.back()->reader.reads.push_back(entries);
        }
    }
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    for (const auto& pair : pairs) {
        pair->reader.fill(256);
        for (std::uint32_t entry = 0; entry < 256; ++entry) {
            const std::uint32_t value = 3 * entry + 1;
            REQUIRE(pair->port.load(layout.base + 4 * entry, reinterpret_cast<const unsigned char*>(&value), 4));
        }
    }
    sc_core::sc_start();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        INFO(k);
        REQUIRE(pairs[k]->port.is_prompt());
        pairs[k]->reader.check_values();
        pairs[k]->read_promptly();
        pairs[k]->compare(clock.last_cycle() + 1);
    }
}

TEST_CASE("memory: prompt reads return entries of every size, and refuse addresses outside") {
    struct Sized {
        unsigned bytes;
        TableMemory memory;
        PortOwner owner;
        MemoryPort& port = owner.port;
        Sized(CycleScheduler& clock, unsigned entry_bytes)
            : bytes(entry_bytes),
              memory(("memory_" + std::to_string(bytes)).c_str(), clock, {4096, 16, 16, bytes}, {}, {}),
              owner(("owner_" + std::to_string(bytes)).c_str(), bytes) {
            port.bind(memory);
        }
    };
    CycleScheduler clock("clock", period);
    std::vector<std::unique_ptr<Sized>> sizes;
    for (const unsigned bytes : {1u, 2u, 3u, 4u, 5u, 6u, 8u})
        sizes.push_back(std::make_unique<Sized>(clock, bytes));
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    for (const auto& its : sizes) {
        INFO(its->bytes);
        std::vector<unsigned char> ones(256 * its->bytes, 0xff);
        REQUIRE(its->port.load(4096, ones.data(), 256 * its->bytes));
        std::uint64_t value = 0;
        const auto read = [&](std::uint64_t address) { its->port.read_promptly(&address, 1, &value, 0); };
        for (const std::uint64_t entry : {0u, 255u}) {
            read(4096 + entry * its->bytes);
            CHECK(value == ~std::uint64_t{0} >> (64 - 8 * its->bytes));
        }
        for (const std::uint64_t outside : {std::uint64_t{4095}, 4096 + std::uint64_t{256} * its->bytes})
            CHECK_THAT(error_of([&] { read(outside); }), Catch::Contains(its->port.socket.name()) &&
                                                             Catch::Contains("answered TLM_ADDRESS_ERROR_RESPONSE"));
    }
}

TEST_CASE("memory: it is prompt for a single reader, on chip and without stalls only") {
    CycleScheduler clock("clock", period);
    TableMemory shared("shared", clock, layout, {}, {}), stalled("stalled", clock, layout, {}, {1, 10, 4});
    MemoryTiming cached;
    cached.cache.bytes = 256;
    TableMemory off_chip("off_chip", clock, layout, cached, {});
    PortOwner one("one", 4), other("other", 4), third("third", 4), fourth("fourth", 4);
    one.port.bind(shared);
    other.port.bind(shared);
    third.port.bind(stalled);
    fourth.port.bind(off_chip);
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    for (const PortOwner* const owner : {&one, &other, &third, &fourth})
        CHECK_FALSE(owner->port.is_prompt());
}

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "modules/memories/banked_ports.h"
#include "modules/memories/channel.h"
#include "modules/memories/storage.h"

// When a memory serves a request, and what it contains: plain C++, without a simulation kernel.

using namespace tessera;
using Addresses = std::vector<std::uint64_t>;

namespace {

const datapath::TableLayout layout{4096, 16, 16, 4};

/// Ports from which entries are requested by number.
struct Ports {
    BankedPorts ports;

    explicit Ports(const MemoryTiming& timing) : ports(timing, layout) {}
    static Addresses at(const std::vector<unsigned>& entries) {
        Addresses addresses;
        for (const unsigned entry : entries)
            addresses.push_back(layout.base + std::uint64_t{4} * entry);
        return addresses;
    }
    std::uint64_t ready(const std::vector<unsigned>& entries) const {
        return ports.ready(at(entries).data(), static_cast<unsigned>(entries.size()));
    }
    std::uint64_t serve(const std::vector<unsigned>& entries, std::uint64_t cycle) {
        return ports.serve(at(entries).data(), static_cast<unsigned>(entries.size()), cycle);
    }
};

}  // namespace

TEST_CASE("banked ports: one port takes one address a cycle") {
    Ports p({1, 1, 3});
    CHECK(p.ready({7}) == 0);
    CHECK(p.serve({7}, 10) == 13);
    CHECK(p.ready({8}) == 11);
    CHECK(p.serve({8, 9, 10, 11}, 11) == 14 + 3);  // 11 to 14
    CHECK(p.ready({7}) == 15);
    CHECK(p.serve({7}, 100) == 103);  // idle in between
    CHECK(p.ports.slots_taken() == 6);
    CHECK(p.ports.slots_per_cycle() == 1);
    CHECK(p.ports.occupied_cycles() == 6);
}

TEST_CASE("banked ports: several ports of a bank share a request") {
    Ports p({2, 1, 1});
    CHECK(p.serve({0, 1, 2}, 10) == 11 + 1);  // two in cycle 10, one in 11
    CHECK(p.ready({3}) == 11);                // the other port in cycle 11
    CHECK(p.serve({3}, 11) == 12);
    CHECK(p.ready({3}) == 12);
    CHECK(p.ports.slots_per_cycle() == 2);
    CHECK(p.ports.occupied_cycles() == 2);
}

TEST_CASE("banked ports: entry k is in bank k mod banks, and banks work independently") {
    Ports p({1, 4, 1});
    CHECK(p.serve({0, 1, 2, 3}, 10) == 11);
    CHECK(p.serve({0, 4, 8}, 11) == 13 + 1);  // all in bank 0: 11, 12, 13
    CHECK(p.ready({12}) == 14);
    CHECK(p.ready({1}) == 11);
    CHECK(p.ready({1, 16}) == 14);  // ready when all of its banks are
    CHECK(p.ports.slots_per_cycle() == 4);
    CHECK(p.ports.slots_taken() == 7);
    CHECK(p.ports.occupied_cycles() == 4);  // bank 0's
}

// The busiest bank's ports, not the mean of all banks: it alone limits what the table can serve.
TEST_CASE("banked ports: the occupied cycles are the busiest bank's slots by its ports") {
    Ports two_by_four({2, 4, 1, 2});  // two ports in each of four banks, two cycles per entry
    two_by_four.serve({0, 4, 8, 12}, 0);
    two_by_four.serve({1, 5, 2, 3}, 10);
    two_by_four.serve({16, 20}, 20);
    CHECK(two_by_four.ports.slots_taken() == 2 * (4 + 4 + 2));
    CHECK(two_by_four.ports.occupied_cycles() == 2 * 6 / 2);
    Ports even({1, 4, 1});
    for (std::uint64_t k = 0; k < 5; ++k)
        even.serve({0, 1, 2, 3}, k);
    CHECK(even.ports.occupied_cycles() == 5);
    Ports exclusive({3, 2, 1, 0, 1, Interleave::exclusive_or});
    for (std::uint64_t k = 0; k < 6; ++k)
        exclusive.serve({0, 1, 16, 17}, 10 * k);  // columns 0 and 1 of rows 0 and 1: two in each bank
    CHECK(exclusive.ports.slots_taken() == 24);
    CHECK(exclusive.ports.occupied_cycles() == 12 / 3);
}

TEST_CASE("banked ports: a window lets requests start while others wait for a bank") {
    Ports p({1, 2, 1, 0, 1, Interleave::entry, 2});
    CHECK(p.serve({0, 2, 4}, 10) == 12 + 1);  // bank 0: 10, 11, 12
    CHECK(p.ready({6}) == 0);                 // one of two is in progress
    CHECK(p.serve({6, 1}, 10) == 13 + 1);     // bank 0 in 13, bank 1 in 10
    CHECK(p.ready({3}) == 13);                // the first has sent its last address
    CHECK(p.serve({3}, 13) == 14);            // bank 1
    CHECK(p.ready({3}) == 14);                // the second
}

TEST_CASE("banked ports: with exclusive ORs an entry's column and row select its bank") {
    Ports p({1, 4, 1, 0, 1, Interleave::exclusive_or, 0});
    const auto bank = [](unsigned entry) { return BankOfEntry::of(entry % 16, entry / 16, 4); };
    CHECK(p.serve({37}, 10) == 11);
    for (unsigned entry = 0; entry < 256; ++entry)
        CHECK(p.ready({entry}) == (bank(entry) == bank(37) ? 11 : 0));
}

TEST_CASE("banked ports: exclusive-or banks hold equal shares of any table, and each entry has a place of its own") {
    for (const unsigned banks : {2U, 4U, 8U, 16U, 32U, 64U}) {
        CAPTURE(banks);
        std::vector<unsigned> held(banks);
        std::set<std::array<std::uint64_t, 3>> places;  // bank, the column's other bits, row
        for (std::uint32_t row = 0; row < 256; ++row)
            for (std::uint32_t column = 0; column < 256; ++column) {
                const std::size_t bank = BankOfEntry::of(column, row, banks);
                REQUIRE(bank < banks);
                ++held[bank];
                places.insert({bank, column / banks, row});
            }
        CHECK(held == std::vector<unsigned>(banks, 65536 / banks));
        CHECK(places.size() == 65536);
    }
}

namespace {

/// Average cycles for the four corners of a rectangle of each size up to `most`, at 64 positions each.
template <class Bank>
double cycles_a_rectangle(unsigned banks, std::uint32_t most, bool powers_of_two, Bank bank) {
    unsigned rectangles = 0, cycles = 0;
    for (std::uint32_t width = 1; width <= most; width += powers_of_two ? width : 1)
        for (std::uint32_t height = 1; height <= most; height += powers_of_two ? height : 1)
            for (std::uint32_t place = 0; place < 64; ++place) {
                const std::uint32_t x = 37 * place % 101, y = 53 * place % 89;
                std::vector<unsigned> reads(banks);
                for (const auto& [dx, dy] : {std::pair{0U, 0U}, {width, 0U}, {0U, height}, {width, height}})
                    ++reads[bank(x + dx, y + dy)];
                cycles += *std::max_element(reads.begin(), reads.end());
                ++rectangles;
            }
    return double(cycles) / rectangles;
}

}  // namespace

TEST_CASE(
    "banked ports: exclusive-or banks conflict less than random ones, banks by entry more for sides of powers of 2") {
    // Four corners in random banks of `banks`: the mean count of the fullest bank.
    for (const auto& [banks, chance] : {std::pair{4U, 2.125}, {8U, 1.65}, {16U, 1.35}}) {
        CAPTURE(banks);
        const auto exclusive_or = [banks = banks](std::uint32_t x, std::uint32_t y) {
            return BankOfEntry::of(x, y, banks);
        };
        const auto entry = [banks = banks](std::uint32_t x, std::uint32_t y) { return (y * 257 + x) % banks; };
        CHECK(cycles_a_rectangle(banks, 32, true, exclusive_or) < chance);
        CHECK(cycles_a_rectangle(banks, 32, false, exclusive_or) < chance);
        CHECK(cycles_a_rectangle(banks, 32, true, entry) > 1.15 * chance);
    }
}

TEST_CASE("banked ports: a port narrower than an entry takes ceil(bytes / width) cycles for it") {
    for (const auto& [width, cycles] :
         std::array<std::array<unsigned, 2>, 6>{{{1, 4}, {2, 2}, {3, 2}, {4, 1}, {64, 1}, {0, 1}}}) {
        CAPTURE(width);
        Ports p({1, 1, 5, width});
        CHECK(p.serve({0, 1}, 10) == 10 + 2 * cycles - 1 + 5);
        CHECK(p.ready({2}) == 10 + 2 * cycles);
        CHECK(p.ports.slots_taken() == 2 * cycles);
    }
}

TEST_CASE("channel: a request takes ceil(bytes / bandwidth) cycles, its answer comes a latency after the last byte") {
    Channel channel({20, 5, 4});
    CHECK(channel.ready() == 0);
    CHECK(channel.serve(32, 10) == 10 + 7 + 20);
    CHECK(channel.ready() == 17);
    CHECK(channel.serve(5, 17) == 17 + 1 + 20);
    CHECK(channel.serve(6, 30) == 30 + 2 + 20);
    CHECK(channel.ready() == 32);
    CHECK(channel.occupied_cycles() == 7 + 1 + 2);
    CHECK(channel.latency() == 20);
}

TEST_CASE("storage: unwritten bytes are 0, written bytes are kept, and addresses outside are not covered") {
    Storage storage(100, 50);
    for (const auto& [address, length, covered] :
         std::vector<std::array<std::uint64_t, 3>>{{100, 50, 1},
                                                   {149, 1, 1},
                                                   {100, 51, 0},
                                                   {149, 2, 0},
                                                   {150, 1, 0},
                                                   {99, 1, 0},
                                                   {0, 1, 0},
                                                   {~std::uint64_t{0}, 1, 0},
                                                   {~std::uint64_t{0}, 200, 0}}) {
        CAPTURE(address, length);
        CHECK(storage.covers(address, length) == (covered == 1));
    }
    std::array<unsigned char, 4> bytes{1, 2, 3, 4};
    storage.write(110, bytes.data(), 4);
    const auto read = [&](std::uint64_t address) {
        std::array<unsigned char, 4> result{9, 9, 9, 9};
        storage.read(address, result.data(), 4);
        return result;
    };
    CHECK(read(110) == bytes);
    CHECK(read(108) == std::array<unsigned char, 4>{0, 0, 1, 2});
    CHECK(read(112) == std::array<unsigned char, 4>{3, 4, 0, 0});  // half of it beyond the written bytes
    CHECK(read(146) == std::array<unsigned char, 4>{0, 0, 0, 0});
    storage.write(146, bytes.data(), 4);
    CHECK(read(146) == bytes);
    CHECK(read(110) == bytes);
    const unsigned char* const all = storage.all();
    CHECK(all[10] == 1);
    CHECK(all[49] == 4);
}

TEST_CASE("a table with another number of columns uses the banks of its new layout") {
    MemoryTiming timing;
    timing.banks = 4;
    timing.interleave = Interleave::exclusive_or;
    BankOfEntry moved(timing, layout);
    datapath::TableLayout other = layout;
    other.columns = 11;
    const BankOfEntry made(timing, other);
    unsigned different = 0;
    for (std::uint64_t address = layout.base; address < layout.base + layout.bytes(); address += 4)
        different += moved(address) != made(address) ? 1u : 0u;
    CHECK(different > 0);
    moved.lay_out(11);
    for (std::uint64_t address = layout.base; address < layout.base + layout.bytes(); address += 4)
        CHECK(moved(address) == made(address));
}

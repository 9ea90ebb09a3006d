#include <catch2/catch.hpp>
#include <vector>

#include "testbench/common/distinct_table.h"

using namespace tessera;

TEST_CASE("distinct table: items are numbered in order of arrival, for any hashes") {
    const std::uint64_t hashes = GENERATE(1u, 7u, 1'000'000u);  // number of different hashes
    const auto hash = [&](std::uint64_t item) { return mix_hash(0, item % hashes); };
    DistinctTable table;
    std::vector<std::uint64_t> items;
    const auto number_of = [&](std::uint64_t item) {
        const std::uint32_t number = table.number_of(
            hash(item), [&](std::uint32_t k) { return items[k] == item; },
            [&](std::uint32_t k) { return hash(items[k]); });
        if (number == items.size())
            items.push_back(item);
        return number;
    };
    // More items than the initial slots, each looked up again after the table has grown.
    for (std::uint32_t k = 0; k < 1500; ++k) {
        REQUIRE(number_of(3 * k) == k);
        REQUIRE(number_of(3 * (k / 2)) == k / 2);
    }
    CHECK(table.size() == 1500);
}

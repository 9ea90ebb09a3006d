#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <list>
#include <set>
#include <vector>

#include "modules/memories/line_cache.h"
#include "testbench/common/random.h"

// A cache's lines: which are present, and which is evicted.

using namespace tessera;
using State = LineCache::State;

namespace {

/// Looks up a line and fills it at once if it is absent. Returns whether it was present.
bool access(LineCache& cache, std::uint64_t number) {
    if (cache.find(number) != nullptr)
        return true;
    LineCache::Line* const line = cache.allocate(number);
    REQUIRE(line != nullptr);
    REQUIRE(line->state == State::filling);
    line->state = State::present;
    return false;
}

}  // namespace

// A table of 100 x 100 entries.
TEST_CASE("line cache: its shape is in whole entries, lines and sets, and no more than the table") {
    struct Row {
        CacheTiming asked;
        unsigned entry_bytes, line_bytes;
        std::uint64_t ways, sets;
    };
    const auto asked = [](unsigned bytes, unsigned line_bytes, unsigned ways) {
        return CacheTiming{bytes, line_bytes, ways, 16};
    };
    for (const Row& row : std::vector<Row>{{asked(1, 64, 4), 4, 64, 1, 1},
                                           {asked(64, 64, 4), 4, 64, 1, 1},
                                           {asked(128, 64, 4), 4, 64, 2, 1},
                                           {asked(320, 64, 4), 4, 64, 4, 1},
                                           {asked(448, 64, 4), 4, 64, 4, 1},
                                           {asked(1000, 64, 4), 4, 64, 4, 3},
                                           {asked(1024, 64, 4), 4, 64, 4, 4},
                                           {asked(1024, 64, 64), 4, 64, 16, 1},
                                           {asked(1000, 64, 4), 6, 60, 4, 4},
                                           {asked(1000, 3, 4), 4, 4, 4, 62},
                                           {asked(39999, 4, 1), 4, 4, 1, 9999},
                                           {asked(40000, 64, 4), 4, 64, 1, 625},
                                           {asked(1 << 30, 64, 4), 4, 64, 1, 625},
                                           {asked(1 << 30, 64, 64), 6, 60, 1, 1000}}) {
        CAPTURE(row.asked.bytes, row.asked.line_bytes, row.asked.ways, row.entry_bytes);
        const CacheShape shape(row.asked, {0, 100, 100, row.entry_bytes});
        CHECK(shape.line_bytes == row.line_bytes);
        CHECK(shape.ways == row.ways);
        CHECK(shape.sets == row.sets);
        CHECK(shape.bytes() == row.line_bytes * row.ways * row.sets);
        CHECK(shape.whole_table == (row.ways * row.sets * row.line_bytes >= 10000 * row.entry_bytes));
    }
}

TEST_CASE("line cache: with a set for each line no line evicts another") {
    LineCache cache(625, 1, 64);
    for (std::uint64_t number = 0; number < 625; ++number)
        CHECK_FALSE(access(cache, number));
    for (std::uint64_t number = 0; number < 625; ++number)
        CHECK(access(cache, number));
}

TEST_CASE("line cache: hits match a least-recently-used list per set") {
    Random random(7);
    for (const auto& [sets, ways] :
         std::vector<std::pair<std::uint64_t, unsigned>>{{1, 1}, {1, 4}, {8, 1}, {4, 2}, {5, 3}}) {
        CAPTURE(sets, ways);
        LineCache cache(sets, ways, 16);
        std::vector<std::list<std::uint64_t>> expected(sets);
        unsigned hits = 0;
        for (int k = 0; k < 5000; ++k) {
            const std::uint64_t number = random.natural(0, static_cast<unsigned>(3 * sets * ways));
            std::list<std::uint64_t>& set = expected[(number ^ number / sets ^ number / (sets * sets)) % sets];
            const auto found = std::find(set.begin(), set.end(), number);
            const bool hit = found != set.end();
            if (hit)
                set.erase(found);
            else if (set.size() == ways)
                set.pop_back();
            set.push_front(number);
            hits += hit ? 1 : 0;
            REQUIRE(access(cache, number) == hit);
        }
        CHECK(hits > 500);
    }
}

TEST_CASE("line cache: a column of a table whose pitch is a power of two uses all sets") {
    constexpr std::uint64_t sets = 64;
    for (const std::uint64_t pitch : {1U, 2U, 8U, 16U, 32U, 64U, 128U}) {
        CAPTURE(pitch);
        std::set<std::uint64_t> seen;
        for (std::uint64_t row = 0; row < sets; ++row)
            seen.insert(LineCache::set_number(row * pitch, sets));
        CHECK(seen.size() == sets);
    }
}

TEST_CASE("line cache: a line being filled is found, and is not evicted") {
    LineCache cache(1, 2, 16);
    LineCache::Line* const first = cache.allocate(10);
    CHECK(cache.find(10) == first);
    CHECK(cache.find(11) == nullptr);
    CHECK(cache.allocate(11) != first);
    CHECK(cache.allocate(12) == nullptr);
    first->state = State::present;
    CHECK(cache.allocate(12) == first);
    CHECK(cache.find(10) == nullptr);
}

TEST_CASE("a cleared cache has no lines") {
    LineCache cache(4, 2, 64);
    for (std::uint64_t number = 0; number < 8; ++number)
        CHECK_FALSE(access(cache, number));
    CHECK(cache.find(7) != nullptr);
    cache.clear();
    for (std::uint64_t number = 0; number < 8; ++number)
        CHECK(cache.find(number) == nullptr);
}

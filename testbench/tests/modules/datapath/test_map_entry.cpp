#include <catch2/catch.hpp>
#include <cstdint>

#include "modules/datapath/map_entry.h"
#include "testbench/common/random.h"

using namespace tessera::datapath;
using tessera::Random;

TEST_CASE("normal map entry: unpacking restores the packed normal, every width from 4 to 21") {
    Random random(19);
    for (int bits = 4; bits <= 21; ++bits) {
        const std::int64_t low = -(std::int64_t{1} << (bits - 1)), high = -low - 1;
        const auto check = [&](const Direction& n) {
            const std::uint64_t entry = pack_normal(n, bits);
            if (!(unpack_normal(entry, bits) == n) || entry >> (3 * bits) != 0)
                FAIL(bits << " bits: " << n.x << " " << n.y << " " << n.z);
            // bits of the word beyond the entry must not matter
            if (bits < 21 && !(unpack_normal(entry | ~std::uint64_t{0} << (3 * bits), bits) == n))
                FAIL(bits << " bits, with ones above: " << n.x << " " << n.y << " " << n.z);
        };
        if (bits <= 6) {
            for (std::int64_t x = low; x <= high; ++x)
                for (std::int64_t y = low; y <= high; ++y)
                    for (std::int64_t z = low; z <= high; ++z)
                        check(
                            {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)});
        } else {
            for (int k = 0; k < 20'000; ++k)
                check({random.integer32(low, high), random.integer32(low, high), random.integer32(low, high)});
        }
        for (const std::int64_t x : {low, high})
            for (const std::int64_t y : {low, high})
                for (const std::int64_t z : {low, high})
                    check({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)});
    }
}

TEST_CASE("normal map entry: x is in the lowest bits") {
    CHECK(pack_normal({1, 2, 3}, 8) == 0x030201);
    CHECK(pack_normal({-1, 0, 0}, 16) == 0xffff);
    CHECK(pack_normal({0, 0, -32768}, 16) == 0x800000000000);
    CHECK(unpack_normal(0x0302ff, 8) == Direction{-1, 2, 3});
}

TEST_CASE("entry bytes: bits are rounded up to whole bytes") {
    CHECK(entry_bytes(1) == 1);
    CHECK(entry_bytes(8) == 1);
    CHECK(entry_bytes(9) == 2);
    CHECK(entry_bytes(48) == 6);
    CHECK(entry_bytes(54) == 7);
    CHECK(entry_bytes(63) == 8);
}

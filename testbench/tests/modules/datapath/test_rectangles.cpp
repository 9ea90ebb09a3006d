#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <utility>
#include <vector>

#include "testbench/common/random.h"
#include "testbench/prove/random_edges/datapath_edge.h"

using namespace tessera::datapath;
using namespace tessera::testing;
using tessera::Random;

namespace {

constexpr std::array<AddressMode, 2> both_modes{AddressMode::clamp, AddressMode::repeat};

/// The texel that the address mode selects for `index`, which may be outside the map.
std::uint32_t wrapped(std::int64_t index, std::uint32_t size, AddressMode mode) {
    if (mode == AddressMode::clamp)
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(index, 0, std::int64_t{size} - 1));
    const std::int64_t rest = index % size;
    return static_cast<std::uint32_t>(rest < 0 ? rest + size : rest);
}

/// The sum, texel by texel.
std::uint64_t brute_force(const std::vector<std::uint32_t>& codes, const Rectangle& r, const MapGeometry& map) {
    std::uint64_t sum = 0;
    for (std::uint32_t y = r.first_row; y < r.last_row; ++y)
        for (std::uint32_t x = r.first_column; x < r.last_column; ++x)
            sum += codes[std::size_t{wrapped(y, map.height, map.address_v)} * map.width +
                         wrapped(x, map.width, map.address_u)];
    return sum;
}

/// Equal size, inside the map (clamp) or starting inside (repeat), and placed as in golden/ALGORITHM.md 4.2, by floor
/// division.
bool placed_right(std::uint32_t centre, std::uint32_t first, std::uint32_t extent, std::uint32_t size,
                  AddressMode mode) {
    const std::int64_t wanted = std::int64_t{centre} - extent / 2;
    if (mode == AddressMode::repeat)
        return first < size && first == wrapped(wanted, size, mode);
    return first + extent <= size && first == static_cast<std::uint32_t>(std::clamp<std::int64_t>(
                                                  wanted, 0, std::int64_t{size} - std::int64_t{extent}));
}

bool placed_right(const TexCoord& t, const Rectangle& r, const RectangleSize& size, const MapGeometry& map,
                  const Formats& formats) {
    return r.last_column - r.first_column == size.width && r.last_row - r.first_row == size.height &&
           placed_right(t.u >> formats.texture.fraction, r.first_column, size.width, map.width, map.address_u) &&
           placed_right(t.v >> formats.texture.fraction, r.first_row, size.height, map.height, map.address_v);
}

std::uint32_t expected_side(std::uint32_t a, std::uint32_t b, std::uint32_t divisor, std::uint32_t size,
                            const Formats& formats) {
    const std::uint32_t texels = (std::max(a, b) - std::min(a, b)) / (divisor << formats.texture.fraction);
    return std::clamp<std::uint32_t>(texels, 1, size);
}

std::vector<std::uint32_t> random_codes(std::uint32_t width, std::uint32_t height, Random& random) {
    std::vector<std::uint32_t> codes(std::size_t{width} * height);
    for (std::uint32_t& code : codes)
        code = random.natural(0, 65535);
    return codes;
}

EdgeMachine machine_of(std::uint32_t width, std::uint32_t height, AddressMode u, AddressMode v, int bits,
                       const std::vector<std::uint32_t>& codes) {
    Registers registers;
    registers.map = {width, height, u, v};
    registers.formats.summed_height = Format::make_unsigned(bits, 0);
    registers.tests.height_thresholds[0] = 0;
    Tables tables = make_tables(registers, codes, std::vector<Direction>(codes.size()));
    return EdgeMachine(registers, std::move(tables));
}

/// S of the rectangle about t, from the Summed Height Table.
std::uint64_t sum_around(const EdgeMachine& machine, const TexCoord& t, const RectangleSize& size) {
    const Registers& r = machine.registers;
    return rectangle_sum(centred_rectangle(t, size, r.map, r.formats), r.map, r.height_table, r.formats,
                         [&](std::uint64_t address) { return machine.height_entry(address - r.height_table.base); });
}

/// Every rectangle of a small map, or samples of a large map, against the sum texel by texel.
void check_sums(std::uint32_t width, std::uint32_t height, int bits, const std::vector<std::uint32_t>& codes,
                Random& random) {
    for (const AddressMode u : both_modes) {
        for (const AddressMode v : both_modes) {
            const EdgeMachine machine = machine_of(width, height, u, v, bits, codes);
            const MapGeometry& map = machine.registers.map;
            const auto check = [&](std::uint32_t x, std::uint32_t y, const RectangleSize& size) {
                const TexCoord t{x << 12, y << 12};
                const Rectangle r = centred_rectangle(t, size, map, machine.registers.formats);
                const std::uint64_t expected = brute_force(codes, r, map);
                if (expected >> bits != 0)
                    return;
                if (sum_around(machine, t, size) != expected || !placed_right(t, r, size, map, Formats{}))
                    FAIL(width << " x " << height << " map, " << bits << " bits, rectangle of " << size.width << " x "
                               << size.height << " about " << x << ", " << y << ": " << sum_around(machine, t, size)
                               << " for " << expected);
            };
            if (width * height <= 256) {
                for (std::uint32_t h = 1; h <= height; ++h)
                    for (std::uint32_t w = 1; w <= width; ++w)
                        for (std::uint32_t y = 0; y <= height; ++y)
                            for (std::uint32_t x = 0; x <= width; ++x)
                                check(x, y, {w, h});
                // repeated meshes: several periods away
                check(3 * width + width / 2, 5 * height, {width, height});
            } else {
                check(0, 0, {width, height});
                check(width, height, {width, height});
                for (int k = 0; k < 300; ++k) {
                    const std::uint32_t x = random.natural(0, 4 * width), y = random.natural(0, 4 * height);
                    check(x, y, {random.natural(1, width), random.natural(1, k % 2 == 0 ? height : 8)});
                }
            }
        }
    }
}

constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 8> sizes{
    {{1, 1}, {1, 6}, {6, 1}, {2, 3}, {5, 7}, {12, 19}, {16, 16}, {336, 459}}};

}  // namespace

TEST_CASE("rectangles: size by division, at least one texel, at most the map, commutative") {
    Random random(14);
    for (int k = 0; k < 1'000'000; ++k) {
        Formats formats;
        const int fraction = static_cast<int>(random.integer(0, 12));
        formats.texture = Format::make_unsigned(12 + fraction + 1, fraction);
        MapGeometry map;
        map.width = random.natural(1, 4096);
        map.height = random.natural(1, 4096);
        const auto coordinate = [&] {
            return static_cast<std::uint32_t>(
                std::abs(random.any_size(std::int64_t{1} << random.integer(0, 12 + fraction))));
        };
        const TexCoord a{coordinate(), coordinate()}, b{coordinate(), coordinate()};
        const RectangleSize size = rectangle_size(a, b, map, formats), other = rectangle_size(b, a, map, formats);
        if (size.width != expected_side(a.u, b.u, 2, map.width, formats) ||
            size.height != expected_side(a.v, b.v, 4, map.height, formats) || other.width != size.width ||
            other.height != size.height)
            FAIL(a.u << ", " << a.v << " to " << b.u << ", " << b.v << " gives " << size.width << " x " << size.height);
        for (const auto& [u, v] : {std::pair{AddressMode::clamp, AddressMode::clamp},
                                   {AddressMode::clamp, AddressMode::repeat},
                                   {AddressMode::repeat, AddressMode::clamp},
                                   {AddressMode::repeat, AddressMode::repeat}}) {
            map.address_u = u;
            map.address_v = v;
            const RectangleSize here = rectangle_size(a, b, map, formats);
            if (here.width != size.width || here.height != size.height)
                FAIL("the size depends on the address mode");
            for (const TexCoord& t : {a, b, midpoint(a, b)})
                if (!placed_right(t, centred_rectangle(t, size, map, formats), size, map, formats))
                    FAIL("rectangle of " << size.width << " x " << size.height << " about " << t.u << ", " << t.v
                                         << " on " << map.width << " x " << map.height);
        }
    }
}

TEST_CASE("rectangles: four reads give the sum over the texels") {
    Random random(15);
    for (const auto& [width, height] : sizes) {
        check_sums(width, height, 48, random_codes(width, height, random), random);
        check_sums(width, height, 48, std::vector<std::uint32_t>(std::size_t{width} * height, 65535), random);
    }
}

TEST_CASE("rectangles: entries that wrap around give the right sum whenever the sum fits") {
    Random random(16);
    for (const auto& [width, height] : sizes) {
        const std::vector<std::uint32_t> codes = random_codes(width, height, random);
        check_sums(width, height, 32, codes, random);
        check_sums(width, height, 20, codes, random);  // entries of 336 x 459 wrap 4000 times
        check_sums(width, height, 17, codes, random);
        std::vector<std::uint32_t> low(codes);
        for (std::uint32_t& code : low)
            code &= 15;
        check_sums(width, height, 8, low, random);
    }
}

TEST_CASE("rectangles: four reads inside the map, six across one border, nine across two") {
    Registers registers;
    registers.map = {6, 4, AddressMode::repeat, AddressMode::repeat};
    const auto reads = [&](const Rectangle& r) {
        int count = 0;
        rectangle_entries(r, registers.map, registers.height_table, [&](std::uint64_t, bool) { ++count; });
        return count;
    };
    // columns, then rows; a rectangle that ends on the border does not cross it
    CHECK(reads({0, 6, 0, 4}) == 4);
    CHECK(reads({2, 5, 1, 3}) == 4);
    CHECK(reads({4, 7, 1, 3}) == 6);
    CHECK(reads({4, 7, 1, 4}) == 6);
    CHECK(reads({2, 5, 3, 5}) == 6);
    CHECK(reads({2, 6, 3, 5}) == 6);
    CHECK(reads({4, 7, 3, 5}) == 9);
}

TEST_CASE("rectangles: a constant map never splits, every edge of small maps, any value, every address mode") {
    // 1 fraction bit: whole and half texels, every pair of them
    constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 7> small{
        {{1, 1}, {1, 7}, {7, 1}, {2, 2}, {3, 5}, {8, 4}, {9, 3}}};
    for (const auto& [width, height] : small) {
        for (const std::uint32_t value : {0u, 1u, 40000u, 65535u}) {
            for (const AddressMode u : both_modes) {
                for (const AddressMode v : both_modes) {
                    EdgeMachine machine = machine_of(width, height, u, v, 32,
                                                     std::vector<std::uint32_t>(std::size_t{width} * height, value));
                    machine.registers.formats.texture = Format::make_unsigned(14, 1);
                    for (std::uint32_t iu = 0; iu <= 2 * width; ++iu)
                        for (std::uint32_t iv = 0; iv <= 2 * height; ++iv)
                            for (std::uint32_t ju = 0; ju <= 2 * width; ++ju)
                                for (std::uint32_t jv = 0; jv <= 2 * height; ++jv)
                                    if (machine.summed_height({iu, iv}, {ju, jv}))
                                        FAIL(width << " x " << height << " of " << value << ": " << iu << ", " << iv
                                                   << " to " << ju << ", " << jv);
                }
            }
        }
    }
}

TEST_CASE("rectangles: a constant map never splits, long edges of odd-sized maps, modulo 2^32 and 2^40") {
    Random random(18);
    for (const auto& [width, height] : sizes) {
        const std::vector<std::uint32_t> codes(std::size_t{width} * height, 65535);
        for (const AddressMode u : both_modes) {
            for (const AddressMode v : both_modes) {
                for (const int bits : {32, 40}) {
                    const EdgeMachine machine = machine_of(width, height, u, v, bits, codes);
                    for (int k = 0; k < 20'000; ++k) {
                        const TexCoord i{random.natural(0, width << 12), random.natural(0, height << 12)};
                        const TexCoord j{random.natural(0, width << 12), random.natural(0, height << 12)};
                        if (machine.summed_height(i, j))
                            FAIL(width << " x " << height << ", edge " << i.u << ", " << i.v << " to " << j.u << ", "
                                       << j.v);
                    }
                }
            }
        }
    }
}

// Codes are squares along one axis. An edge over the whole map has rectangles of four texels along that axis: about its
// ends texels 0 to 3 and the last four (clamp), or the last two and the first two (repeat); in the middle four texels.
TEST_CASE("rectangles: with a threshold per area, each axis has its own address mode") {
    for (const AddressMode u : both_modes) {
        for (const AddressMode v : both_modes) {
            const auto splits = [&, u = u, v = v](bool along_u, std::uint64_t threshold) {
                const std::uint32_t width = along_u ? 8 : 3, height = along_u ? 3 : 16;
                std::vector<std::uint32_t> codes;
                for (std::uint32_t y = 0; y < height; ++y)
                    for (std::uint32_t x = 0; x < width; ++x)
                        codes.push_back(along_u ? x * x : y * y);
                EdgeMachine machine = machine_of(width, height, u, v, 32, codes);
                machine.registers.tests.summed_height_unit = SummedHeightUnit::area;
                machine.registers.tests.height_thresholds[0] = static_cast<std::int64_t>(threshold);
                return machine.summed_height({0, 0}, {(along_u ? 8u : 3u) << 12, (along_u ? 3u : 16u) << 12});
            };
            INFO((u == AddressMode::repeat) << (v == AddressMode::repeat));
            // 2 * 54 - 14 - 126, or - 2 * 86, of 4 texels
            const std::uint64_t in_u = (u == AddressMode::clamp ? 32 : 64) / 4;
            CHECK(splits(true, in_u - 1));
            CHECK_FALSE(splits(true, in_u));
            // 2 * 230 - 14 - 734, or - 2 * 422
            const std::uint64_t in_v = (v == AddressMode::clamp ? 288 : 384) / 4;
            CHECK(splits(false, in_v - 1));
            CHECK_FALSE(splits(false, in_v));
        }
    }
}

TEST_CASE("rectangles: the largest table address is the last entry") {
    const EdgeMachine machine =
        machine_of(5, 3, AddressMode::repeat, AddressMode::clamp, 40, std::vector<std::uint32_t>(15, 1));
    const TableLayout& table = machine.registers.height_table;
    CHECK(table.columns == 6);
    CHECK(table.rows == 4);
    CHECK(table.entry_bytes == 5);
    CHECK(table.bytes() == 120);
    CHECK(table.address(0, 0) == table.base);
    CHECK(table.address(2, 1) == table.base + 40);
    CHECK(table.address(5, 3) == table.base + table.bytes() - 5);
}

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "modules/datapath/bilinear.h"
#include "testbench/common/random.h"
#include "testbench/tests/modules/datapath/datapath_reference.h"

using namespace tessera;
using namespace tessera::datapath;
using namespace tessera::testing;

namespace {

Formats formats_of(int integer, int fraction, int displacement, int normal = 16) {
    Formats formats;
    formats.texture = Format::make_unsigned(integer + fraction + 1, fraction);
    formats.displacement = Format::make_unsigned(displacement, displacement);
    formats.normal = Format::make_signed(normal, normal - 2);
    formats.filter = MapFilter::bilinear;
    return formats;
}

/// A map whose entries are its texels' values, one per byte address.
struct TestMap {
    MapGeometry geometry;
    std::vector<std::uint64_t> entries;

    TableLayout layout() const { return {0, geometry.width, geometry.height, 1}; }
    std::uint64_t at(Wide x, Wide y) const {
        return entries[static_cast<std::size_t>(inside(y, geometry.height, geometry.address_v) * geometry.width +
                                                inside(x, geometry.width, geometry.address_u))];
    }
    static Wide inside(Wide index, Wide size, AddressMode mode) {
        return mode == AddressMode::clamp ? clamped(index, 0, size - 1) : (index % size + size) % size;
    }
    std::array<std::uint64_t, 4> read(const TexCoord& t, const Formats& formats) const {
        std::array<std::uint64_t, 4> read{};
        std::size_t count = 0;
        map_entries(t, layout(), geometry, formats,
                    [&](std::uint64_t address) { read.at(count++) = entries.at(static_cast<std::size_t>(address)); });
        REQUIRE(count == map_entry_count(formats));
        return read;
    }
    /// Mirrored along u.
    TestMap mirrored() const {
        TestMap mirror = *this;
        for (std::uint32_t y = 0; y < geometry.height; ++y)
            std::reverse_copy(entries.begin() + y * geometry.width, entries.begin() + (y + 1) * geometry.width,
                              mirror.entries.begin() + y * geometry.width);
        return mirror;
    }
    /// With u and v exchanged.
    TestMap transposed() const {
        TestMap result{{geometry.height, geometry.width, geometry.address_v, geometry.address_u}, {}};
        for (std::uint32_t x = 0; x < geometry.width; ++x)
            for (std::uint32_t y = 0; y < geometry.height; ++y)
                result.entries.push_back(entries[y * geometry.width + x]);
        return result;
    }
};

/// 4^(fraction + 1) times the bilinear surface through the texels' centres, as a sum over the whole neighbourhood. On
/// each axis a texel's weight is one texel minus the distance of t from its centre, or 0.
template <class Value>
Wide exact(const TestMap& map, const TexCoord& t, int fraction, Value value) {
    const Wide texel = Wide{2} << fraction;
    const auto share = [&](std::uint32_t coordinate, Wide index) {
        const Wide off = 2 * Wide{coordinate} - index * texel - texel / 2;
        return std::max<Wide>(0, texel - (off < 0 ? -off : off));
    };
    const Wide x = t.u >> fraction, y = t.v >> fraction;
    Wide sum = 0;
    for (Wide row = y - 1; row <= y + 1; ++row)
        for (Wide column = x - 1; column <= x + 1; ++column)
            sum += share(t.u, column) * share(t.v, row) * value(map.at(column, row));
    return sum;
}

constexpr std::array<AddressMode, 2> modes{AddressMode::clamp, AddressMode::repeat};

/// Every map size up to 4 x 3 with random codes, with both address modes on both axes.
template <class Check>
void each_map(Random& random, std::uint64_t highest, std::uint32_t most, Check check) {
    for (std::uint32_t width = 1; width <= most; ++width)
        for (std::uint32_t height = 1; height <= std::min(most, 3u); ++height)
            for (const AddressMode u : modes)
                for (const AddressMode v : modes) {
                    TestMap map{{width, height, u, v}, {}};
                    for (std::uint32_t k = 0; k < width * height; ++k)
                        map.entries.push_back(random.chance(30) ? (random.coin() ? highest : 0)
                                                                : random.natural(0, static_cast<unsigned>(highest)));
                    check(map);
                }
}

template <class Check>
void each_coordinate(const TestMap& map, const Formats& formats, Check check) {
    // A repeated map is addressed beyond its first period, up to the limit of the format.
    const std::uint32_t border = 1u << (formats.texture.bits - 1);
    const auto most = [&](std::uint32_t size, AddressMode mode) {
        return mode == AddressMode::repeat ? border : std::min(border, size << formats.texture.fraction);
    };
    for (std::uint32_t u = 0; u <= most(map.geometry.width, map.geometry.address_u); ++u)
        for (std::uint32_t v = 0; v <= most(map.geometry.height, map.geometry.address_v); ++v)
            check(TexCoord{u, v});
}

}  // namespace

TEST_CASE("bilinear: a code is the exact value, rounded once, at every coordinate of narrow formats") {
    Random random(3);
    for (int fraction = 0; fraction <= 5; ++fraction)
        for (const int bits : {1, 3, 8, 16}) {
            const Formats formats = formats_of(2, fraction, bits);
            const int kept = code_fraction(formats);
            CHECK(kept == std::min(8, std::max(2, 2 * fraction)));
            each_map(random, static_cast<std::uint64_t>(formats.displacement.highest), 4, [&](const TestMap& map) {
                each_coordinate(map, formats, [&](const TexCoord& t) {
                    const auto entries = map.read(t, formats);
                    const Wide expected =
                        nearest(exact(map, t, fraction, [](std::uint64_t code) { return Wide{code}; }),
                                2 * fraction + 2 - kept);
                    if (map_code(t, entries.data(), formats) != expected)
                        FAIL("fraction " << fraction << ", t " << t.u << ", " << t.v << " gives "
                                         << map_code(t, entries.data(), formats));
                    const std::uint64_t under = map.at(t.u >> fraction, t.v >> fraction);
                    if (nearest_code(t, entries.data(), formats) != under)
                        FAIL("nearest code at t " << t.u << ", " << t.v);
                });
            });
        }
}

TEST_CASE("bilinear: a texel's centre has its code, equal texels have theirs everywhere") {
    Random random(4);
    for (int fraction = 1; fraction <= 5; ++fraction) {
        const Formats formats = formats_of(2, fraction, 7);
        each_map(random, 127, 4, [&](const TestMap& map) {
            for (std::uint32_t x = 0; x < map.geometry.width; ++x)
                for (std::uint32_t y = 0; y < map.geometry.height; ++y) {
                    const TexCoord centre{(2 * x + 1) << (fraction - 1), (2 * y + 1) << (fraction - 1)};
                    const auto entries = map.read(centre, formats);
                    CHECK(map_code(centre, entries.data(), formats) == map.at(x, y) << code_fraction(formats));
                }
            TestMap flat = map;
            std::fill(flat.entries.begin(), flat.entries.end(), 127);
            each_coordinate(flat, formats, [&](const TexCoord& t) {
                const auto entries = flat.read(t, formats);
                if (map_code(t, entries.data(), formats) != 127u << code_fraction(formats))
                    FAIL("t " << t.u << ", " << t.v);
            });
        });
    }
}

TEST_CASE("bilinear: mirroring the map mirrors the codes, exchanging the axes changes none") {
    Random random(5);
    for (int fraction = 0; fraction <= 4; ++fraction) {
        const Formats formats = formats_of(2, fraction, 9);
        each_map(random, 511, 4, [&](const TestMap& map) {
            const TestMap mirror = map.mirrored(), transposed = map.transposed();
            for (std::uint32_t u = 0; u <= map.geometry.width << fraction; ++u)
                for (std::uint32_t v = 0; v <= map.geometry.height << fraction; ++v) {
                    const TexCoord t{u, v}, back{(map.geometry.width << fraction) - u, v}, exchanged{v, u};
                    const auto entries = map.read(t, formats), mirrored = mirror.read(back, formats),
                               other = transposed.read(exchanged, formats);
                    const std::uint32_t code = map_code(t, entries.data(), formats);
                    if (code != map_code(back, mirrored.data(), formats) ||
                        code != map_code(exchanged, other.data(), formats))
                        FAIL("fraction " << fraction << ", t " << u << ", " << v);
                }
        });
    }
}

TEST_CASE("bilinear: codes are exact in wide formats, up to the last border, many periods away") {
    Random random(6);
    for (int k = 0; k < 20'000; ++k) {
        const int fraction = random.integer32(0, 12);
        const Formats formats = formats_of(12, fraction, random.integer32(1, 16));
        const auto mode = [&] { return random.coin() ? AddressMode::repeat : AddressMode::clamp; };
        TestMap map{{random.natural(1, 9), random.natural(1, 9), mode(), mode()}, {}};
        for (std::uint32_t texel = 0; texel < map.geometry.width * map.geometry.height; ++texel)
            map.entries.push_back(random.natural(0, static_cast<std::uint32_t>(formats.displacement.highest)));
        const std::uint32_t border = 1u << (formats.texture.bits - 1);
        const auto coordinate = [&] { return random.chance(10) ? border : random.natural(0, border); };
        const TexCoord t{coordinate(), coordinate()};
        const auto entries = map.read(t, formats);
        CHECK(Wide{map_code(t, entries.data(), formats)} ==
              nearest(exact(map, t, fraction, [](std::uint64_t code) { return Wide{code}; }),
                      2 * fraction + 2 - code_fraction(formats)));
        CHECK(nearest_code(t, entries.data(), formats) == map.at(t.u >> fraction, t.v >> fraction));
    }
}

TEST_CASE("bilinear: normals are interpolated by component, rounded to their format") {
    Random random(7);
    for (const int bits : {6, 9, 16, 18})
        for (int fraction = 0; fraction <= 4; ++fraction) {
            const Formats formats = formats_of(2, fraction, 8, bits);
            const auto component = [&] {
                return static_cast<std::int32_t>(random.chance(25)
                                                     ? (random.coin() ? formats.normal.lowest : formats.normal.highest)
                                                     : random.integer(formats.normal.lowest, formats.normal.highest));
            };
            each_map(random, 1, 3, [&](TestMap map) {
                for (std::uint64_t& entry : map.entries)
                    entry = pack_normal({component(), component(), component()}, bits);
                each_coordinate(map, formats, [&](const TexCoord& t) {
                    const auto entries = map.read(t, formats);
                    const Direction n = map_normal(t, entries.data(), formats);
                    const auto expected = [&](std::int32_t Direction::*which) {
                        return nearest(
                            exact(map, t, fraction,
                                  [&](std::uint64_t entry) { return Wide{unpack_normal(entry, bits).*which}; }),
                            2 * fraction + 2);
                    };
                    if (n.x != expected(&Direction::x) || n.y != expected(&Direction::y) ||
                        n.z != expected(&Direction::z))
                        FAIL(bits << " bits, t " << t.u << ", " << t.v);
                });
            });
        }
}

TEST_CASE("bilinear: addresses and codes computed by hand") {
    const Formats formats = formats_of(12, 12, 16);
    const TableLayout table{1000, 4, 2, 2};
    const auto addresses = [&](const TexCoord& t, AddressMode mode) {
        std::vector<std::uint64_t> found;
        map_entries(t, table, {4, 2, mode, mode}, formats, [&](std::uint64_t address) { found.push_back(address); });
        return found;
    };
    using Addresses = std::vector<std::uint64_t>;
    CHECK(addresses({6144, 3072}, AddressMode::clamp) == Addresses{1002, 1004, 1010, 1012});  // 1.5, 0.75
    CHECK(addresses({0, 0}, AddressMode::clamp) == Addresses{1000, 1000, 1000, 1000});
    CHECK(addresses({0, 0}, AddressMode::repeat) == Addresses{1014, 1008, 1006, 1000});
    CHECK(addresses({4 << 12, 2 << 12}, AddressMode::repeat) == Addresses{1014, 1008, 1006, 1000});
    CHECK(addresses({4 << 12, 2 << 12}, AddressMode::clamp) == Addresses{1014, 1014, 1014, 1014});
    // Half way along, a quarter of the way up: 0.75 * (100 + 200) / 2 + 0.25 * (300 + 501) / 2 = 212.625.
    const std::array<std::uint64_t, 4> entries{100, 200, 300, 501};
    CHECK(map_code({4096, 3072}, entries.data(), formats) == 212 * 256 + 160);
    CHECK(map_code({4096, 3072}, entries.data(), Formats{}) == 100);
    CHECK(code_fraction(Formats{}) == 0);
}

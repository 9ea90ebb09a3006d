#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "modules/datapath/map_address.h"

using namespace tessera::datapath;

TEST_CASE("integer part: the floor of the coordinate, every coordinate of a narrow format") {
    for (int fraction = 0; fraction <= 12; ++fraction) {
        Formats formats;
        formats.texture = Format::make_unsigned(3 + fraction + 1, fraction);
        for (std::uint32_t t = 0; t <= 8u << fraction; ++t)
            if (integer_part(t, formats) != std::floor(std::ldexp(t, -fraction)))
                FAIL(t << " with " << fraction << " fraction bits");
    }
}

TEST_CASE("texel index: unchanged inside the map, beyond the border the last texel (clamp), modulo the size (repeat)") {
    for (std::uint32_t size = 1; size <= 9; ++size) {
        for (std::uint32_t index = 0; index <= 40; ++index) {
            CHECK(texel_index(index, size, AddressMode::clamp) == (index < size ? index : size - 1));
            CHECK(texel_index(index, size, AddressMode::repeat) ==
                  index - size * static_cast<std::uint32_t>(std::floor(index / double{1} / size)));
        }
    }
    CHECK(texel_index(336, 336, AddressMode::clamp) == 335);
    CHECK(texel_index(336, 336, AddressMode::repeat) == 0);
}

TEST_CASE("texel address: rows bottom first, each axis with its own address mode") {
    const Formats formats;
    const TableLayout table{1000, 6, 3, 2};
    MapGeometry map{6, 3, AddressMode::clamp, AddressMode::repeat};
    const auto at = [](double u, double v) {
        return TexCoord{static_cast<std::uint32_t>(u * 4096), static_cast<std::uint32_t>(v * 4096)};
    };
    CHECK(texel_address(at(0, 0), table, map, formats) == 1000);
    CHECK(texel_address(at(4.999, 0.5), table, map, formats) == 1008);
    CHECK(texel_address(at(1, 2.75), table, map, formats) == 1000 + 2 * (2 * 6 + 1));
    CHECK(texel_address(at(6, 3), table, map, formats) == 1010);
    map = {6, 3, AddressMode::repeat, AddressMode::clamp};
    CHECK(texel_address(at(6, 3), table, map, formats) == 1000 + 2 * 2 * 6);
}

#include "modules/datapath/curvature.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "modules/datapath/height_tests.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/table_shapes.h"
#include "testbench/common/random.h"

using namespace tessera;
using namespace tessera::datapath;

namespace {

Formats narrow_formats(int fraction) {
    Formats f;
    f.texture = Format::make_unsigned(3 + fraction + 1, fraction);
    return f;
}

CurvatureEntry random_entry(Random& random) {
    return {static_cast<std::uint8_t>(random.natural(0, 15)), random.integer32(-128, 127), random.integer32(-128, 127),
            random.integer32(-128, 127), random.natural(0, 255)};
}

/// The header's formula in real numbers, with rounded u and v.
double expected_measure(const CurvatureEntry& entry, double du, double dv, int level) {
    const double u = std::floor(8 * std::abs(du) / std::exp2(level)),
                 v = std::floor(8 * std::abs(dv) / std::exp2(level));
    const double xy = du * dv < 0 ? -entry.xy : entry.xy;
    const double bent = std::floor(std::abs(entry.xx * u * u + xy * u * v + entry.yy * v * v) / 64);
    const double longer = std::max<double>(bent, entry.rest), shorter = std::min<double>(bent, entry.rest);
    return (longer + std::floor(shorter / 2)) * std::exp2(entry.exponent + level);
}

}  // namespace

TEST_CASE("curvature: an entry survives packing in 36 bits") {
    Random random(1);
    for (int trial = 0; trial < 1000; ++trial) {
        const CurvatureEntry entry = random_entry(random);
        const std::uint64_t packed = pack_curvature(entry);
        REQUIRE(packed >> curvature_entry_bits == 0);
        const CurvatureEntry read = unpack_curvature(packed);
        REQUIRE(read.exponent == entry.exponent);
        REQUIRE(read.xx == entry.xx);
        REQUIRE(read.xy == entry.xy);
        REQUIRE(read.yy == entry.yy);
        REQUIRE(read.rest == entry.rest);
    }
}

TEST_CASE("curvature: every edge of narrow formats, from both ends, agrees with real numbers") {
    Random random(2);
    const int fraction = GENERATE(0, 1, 2);
    const Formats f = narrow_formats(fraction);
    const std::uint32_t most = 8u << fraction;
    int wrong = 0;
    for (std::uint32_t at = 0; at < (most + 1) * (most + 1) * (most + 1) * (most + 1); ++at) {
        std::uint32_t rest = at;
        const auto next = [&] {
            const std::uint32_t value = rest % (most + 1);
            rest /= most + 1;
            return value;
        };
        const TexCoord i{next(), next()}, j{next(), next()};
        const int level = curvature_level(i, j, f);
        const double du = std::ldexp(static_cast<double>(j.u) - i.u, -fraction),
                     dv = std::ldexp(static_cast<double>(j.v) - i.v, -fraction);
        const double longer = std::max(std::abs(du), std::abs(dv));
        wrong += longer > std::exp2(level) || (level > 1 && longer <= std::exp2(level - 1)) ? 1 : 0;
        wrong += curvature_level(j, i, f) != level ? 1 : 0;
        const CurvatureEntry entry = random_entry(random);
        const std::uint64_t measure = curvature_measure(entry, i, j, level, f);
        wrong += static_cast<double>(measure) != expected_measure(entry, du, dv, level) ? 1 : 0;
        wrong += curvature_measure(entry, j, i, level, f) != measure ? 1 : 0;
    }
    CHECK(wrong == 0);
}

TEST_CASE("curvature: at level 1 the measure comes from three codes, in either direction") {
    for (std::uint32_t i = 0; i < 16; ++i)
        for (std::uint32_t j = 0; j < 16; ++j)
            for (std::uint32_t ij = 0; ij < 16; ++ij) {
                const std::uint64_t measure = curvature_measure_of_codes(i, j, ij);
                CHECK(static_cast<double>(measure) == 16 * std::abs(ij - (i + j) / 2.0));
                CHECK(measure == curvature_measure_of_codes(j, i, ij));
            }
}

TEST_CASE("curvature: cells are 2^(l - 1) texels apart, the nearest is read, and levels follow one another") {
    const Formats f;
    const MapGeometry covered{21, 13, AddressMode::clamp, AddressMode::repeat};
    CHECK(highest_curvature_level(covered) == 5);
    CHECK(highest_curvature_level({13, 21, AddressMode::clamp, AddressMode::clamp}) == 5);
    CHECK(highest_curvature_level({32, 33, AddressMode::clamp, AddressMode::clamp}) == 6);
    CHECK(highest_curvature_level({1, 1, AddressMode::clamp, AddressMode::clamp}) == 2);
    std::uint64_t entries = 0;
    for (int level = 2; level <= 5; ++level) {
        const CurvatureCells cells = curvature_cells(level, covered);
        CHECK(cells.first_entry == entries);
        entries += std::uint64_t{cells.columns} * cells.rows;
        for (std::uint32_t v = 0; v < 30; ++v) {
            for (std::uint32_t u = 0; u < 30; ++u) {
                const auto cell = [&](std::uint32_t texel) {
                    return static_cast<std::uint32_t>(std::floor(texel / std::exp2(level - 1) + 0.5));
                };
                const std::uint32_t column = cell(std::min(u, 20u)), row = cell(v % 13);
                REQUIRE(column < cells.columns);
                REQUIRE(row < cells.rows);
                const TexCoord t{(u << 12) + 5, (v << 12) + 4095};
                REQUIRE(curvature_address(t, level, 4096, covered, f) ==
                        4096 + 5 * (cells.first_entry + row * cells.columns + column));
            }
        }
    }
    CHECK(curvature_address({0, 0}, 9, 0, covered, f) == curvature_address({0, 0}, 5, 0, covered, f));
}

TEST_CASE("CT: every edge of narrow formats measures and decides alike from both ends, for any table contents") {
    const int fraction = GENERATE(0, 1);
    Registers r;
    r.formats = narrow_formats(fraction);
    r.formats.height_test = number_of<CurvatureTest>();
    r.map = {7, 6, AddressMode::repeat, AddressMode::clamp};
    r.covered = {7, 9};
    r.displacement_map.base = 0x1000;
    r.height_table.base = 0x2000;
    shape_tables(r);
    CHECK(r.height_table.columns == curvature_entries(covered_texels(r)));
    Registers empty;
    empty.formats.height_test = number_of<CurvatureTest>();
    shape_tables(empty);
    CHECK(empty.height_table.bytes() == 0);
    // Random bits, by address.
    const auto memory = [&](std::uint64_t address) {
        const std::uint64_t bits = (address + 1) * 0x9e3779b97f4a7c15u;
        return bits >> (address >= r.height_table.base ? 64 - curvature_entry_bits : 64 - 16);
    };
    const auto measure = [&](const TexCoord& i, const TexCoord& j) {
        Entries read{};
        std::size_t count = 0;
        bool inside = true;
        curvature_reads(i, j, midpoint(i, j), r, [&](std::uint64_t address) {
            const TableLayout& table = address >= r.height_table.base ? r.height_table : r.displacement_map;
            inside = inside && address - table.base < table.bytes();
            read[count++] = memory(address);
        });
        const bool counted = count == (curvature_by_codes(i, j, r.formats) ? 3u : 1u);
        return inside && counted ? curvature_of_entries(i, j, read, r.formats) : ~std::uint64_t{0};
    };
    const std::uint32_t most = 8u << fraction;
    int wrong = 0, splits = 0;
    TestParameters parameters;
    parameters.height_thresholds[0] = 1u << 16;
    for (std::uint32_t iu = 0; iu <= most; ++iu)
        for (std::uint32_t iv = 0; iv <= most; ++iv)
            for (std::uint32_t ju = 0; ju <= most; ++ju)
                for (std::uint32_t jv = 0; jv <= most; ++jv) {
                    const std::uint64_t found = measure({iu, iv}, {ju, jv});
                    wrong += found == ~std::uint64_t{0} || found != measure({ju, jv}, {iu, iv}) ? 1 : 0;
                    splits += curvature_test(found, parameters) ? 1 : 0;
                }
    CHECK(wrong == 0);
    CHECK(splits > 100);
}

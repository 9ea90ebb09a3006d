#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <string>

#include "modules/datapath/curvature.h"
#include "modules/datapath/height_tests.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/mipmap.h"
#include "modules/datapath/table_shapes.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/tests/check/conformance/scoreboard_cases.h"

// The decisions of the Curvature Test and the Mipmap Test equal golden's, to the last step of the threshold.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// A table of random bits, with the Curvature Test alone.
MachineSetup random_setup(Random& random, const datapath::Formats& formats) {
    MachineSetup setup = Case::make_setup(random, formats, Manner::tame);
    datapath::Registers& registers = setup.registers;
    registers.formats.height_test = datapath::number_of<datapath::CurvatureTest>();
    registers.covered = {registers.map.width + random.natural(0, 9), registers.map.height};
    setup.curvature_table.covered = covered_texels(registers);
    for (std::uint64_t k = 0; k < curvature_entries(covered_texels(registers)); ++k)
        setup.curvature_table.entries.push_back(std::uint64_t{random.natural(0, 262143)} << 18 |
                                                random.natural(0, 262143));
    datapath::TestParameters& tests = registers.tests;
    tests.normal_test = tests.view_test = tests.tex_coord_test = tests.generation_test = false;
    return setup;
}

/// Levels computed from the map, with the Mipmap Test alone.
MachineSetup mipmap_setup(Random& random, const datapath::Formats& formats) {
    MachineSetup setup = Case::make_setup(random, formats, Manner::tame);
    setup.registers.formats.height_test = datapath::number_of<datapath::MipmapTest>();
    setup.mipmap_table = make_mipmap_table(setup.map, random.one_of({MipmapFilter::mean, MipmapFilter::maximum}));
    datapath::TestParameters& tests = setup.registers.tests;
    tests.normal_test = tests.view_test = tests.tex_coord_test = tests.generation_test = false;
    return setup;
}

void set_threshold(MachineSetup& setup, std::uint64_t threshold) {
    setup.registers.tests.height_thresholds[0] = static_cast<std::int64_t>(threshold);
}

std::uint64_t measure(const MachineSetup& setup, const datapath::TexCoord& i, const datapath::TexCoord& j,
                      const datapath::TexCoord& ij) {
    datapath::Registers r = setup.registers;
    shape_tables(r);
    r.displacement_map.base = r.height_table.base = 0;
    datapath::Entries read{};
    std::size_t count = 0;
    if (r.formats.height_test == datapath::number_of<datapath::MipmapTest>()) {
        mipmap_reads(i, j, ij, r, [&](std::uint64_t address) {
            read[count++] = setup.mipmap_table.entries[address / r.height_table.entry_bytes];
        });
        return datapath::mipmap_difference(read);
    }
    curvature_reads(i, j, ij, r, [&](std::uint64_t address) {
        const bool codes = curvature_by_codes(i, j, r.formats);
        read[count++] = codes ? setup.map.codes[address / r.displacement_map.entry_bytes]
                              : setup.curvature_table.entries[address / r.height_table.entry_bytes];
    });
    return curvature_of_entries(i, j, read, r.formats);
}

std::uint64_t measure(const MachineSetup& setup, const datapath::TrianglePass& pass, int k) {
    return measure(setup, pass.edge_begin(k).texture, pass.edge_end(k).texture,
                   pass.edges[static_cast<std::size_t>(k)].texture);
}

/// The pass as the hardware decides it for this setup; `flipped` selects edges whose height test is inverted.
datapath::TrianglePass decided(const MachineSetup& setup, datapath::TrianglePass pass, unsigned flipped = 0) {
    pass.split = 0;
    for (unsigned k = 0; k < 3; ++k) {
        std::uint8_t& tests = pass.edges[k].tests;
        const std::uint64_t found = measure(setup, pass, static_cast<int>(k));
        const bool above = setup.registers.formats.height_test == datapath::number_of<datapath::MipmapTest>()
                               ? mipmap_test(found, setup.registers.tests)
                               : curvature_test(found, setup.registers.tests);
        const bool splits = above != ((flipped >> k & 1u) != 0);
        tests = static_cast<std::uint8_t>(datapath::gating_tests | (splits ? datapath::summed_height_bit : 0));
        pass.split = static_cast<std::uint8_t>(pass.split | (splits ? 1u << k : 0));
    }
    return pass;
}

}  // namespace

TEST_CASE("the Curvature Test and the Mipmap Test conform in many formats, at thresholds equal to their own measures") {
    for (const auto make_setup : {random_setup, mipmap_setup}) {
        Random random(1);
        std::uint64_t split = 0, compared = 0;
        for (const datapath::Formats& formats : many_formats()) {
            for (int design = 0; design < 40; ++design) {
                MachineSetup setup = make_setup(random, formats);
                datapath::TrianglePass pass = Case(setup, Manner::tame).pass(random);
                const std::uint64_t found = measure(setup, pass, 0);
                for (const std::uint64_t threshold : {found, found == 0 ? found : found - 1}) {
                    set_threshold(setup, threshold);
                    const Case c(setup, Manner::tame);
                    pass = decided(setup, pass);
                    const ConformanceResult result = check(c, pass);
                    INFO(result.first_mismatch);
                    REQUIRE(result.mismatches == 0);
                    CHECK(test(result, "SHT").allowed_flips == 0);
                    split += pass.split != 0 ? 1 : 0;
                    ++compared;
                }
            }
        }
        CHECK(split > compared / 4);
        CHECK(split < compared);
    }
}

TEST_CASE("a wrong decision of the Curvature Test is caught, one step from the threshold") {
    Random random(2);
    int by_codes = 0, by_table = 0;
    for (int design = 0; design < 300; ++design) {
        MachineSetup setup = random_setup(random, datapath::Formats{});
        datapath::TrianglePass pass = Case(setup, Manner::tame).pass(random);
        if (design % 2 == 0) {  // a short edge
            const datapath::TexCoord begin = pass.edge_begin(0).texture;
            pass.triangle.vertices[1].texture = {begin.u ^ 4096, begin.v};
            for (const int k : {0, 1})
                pass.edges[static_cast<std::size_t>(k)].texture = pass.new_vertex[static_cast<std::size_t>(k)].texture =
                    midpoint(pass.edge_begin(k).texture, pass.edge_end(k).texture);
        }
        const bool codes =
            curvature_by_codes(pass.edge_begin(0).texture, pass.edge_end(0).texture, setup.registers.formats);
        (codes ? by_codes : by_table) += 1;
        const std::uint64_t found = measure(setup, pass, 0);
        for (const std::uint64_t threshold : {found, found == 0 ? found : found - 1}) {
            set_threshold(setup, threshold);
            const Case c(setup, Manner::tame);
            CHECK(test(check(c, decided(setup, pass, 1)), "SHT").mismatches == 1);
        }
    }
    CHECK(by_codes > 100);
    CHECK(by_table > 100);
}

TEST_CASE("a wrong decision of the Mipmap Test is caught, one step from the threshold") {
    Random random(3);
    for (int design = 0; design < 300; ++design) {
        MachineSetup setup = mipmap_setup(random, datapath::Formats{});
        const datapath::TrianglePass pass = Case(setup, Manner::tame).pass(random);
        const std::uint64_t found = measure(setup, pass, 0);
        for (const std::uint64_t threshold : {found, found == 0 ? found : found - 1}) {
            set_threshold(setup, threshold);
            CHECK(test(check(Case(setup, Manner::tame), decided(setup, pass, 1)), "SHT").mismatches == 1);
        }
    }
}

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "testbench/check/conformance/error_bounds.h"
#include "testbench/tests/check/conformance/scoreboard_cases.h"

// The scoreboard on the Highlight Test: what it allows, what it detects, and the bound it uses.

using namespace tessera;
using namespace tessera::testing;

namespace {

Case case_with_highlight(Random& random, const datapath::Formats& formats, Manner manner) {
    MachineSetup setup = Case::make_setup(random, formats, manner);
    const int fraction = formats.normal.fraction;
    datapath::TestParameters& tests = setup.registers.tests;
    tests.highlight_test = true;
    const datapath::Direction half = rounded(unit_vector(random), formats.normal);
    tests.half_vector = {half.x, half.y, half.z};
    tests.highlight_cosine = random.integer(0, std::int64_t{1} << (2 * fraction));
    tests.highlight_normal_threshold = random.natural(0, 1u << fraction);
    return {setup, manner};
}

datapath::TrianglePass with_flipped_highlight(datapath::TrianglePass pass, std::size_t edge) {
    pass.edges[edge].tests = static_cast<std::uint8_t>(pass.edges[edge].tests ^ datapath::highlight_bit);
    return pass;
}

}  // namespace

TEST_CASE("Highlight Test: the datapath conforms on random edges of many formats") {
    Random random(61);
    std::uint64_t flips = 0, agreed = 0;
    for (const datapath::Formats& formats : many_formats()) {
        for (const Manner manner : {Manner::tame, Manner::wild}) {
            for (int design = 0; design < 60; ++design) {
                Case c = case_with_highlight(random, formats, manner);
                Scoreboard scoreboard(c.setup.registers, c.inputs);
                for (int k = 0; k < 100; ++k)
                    scoreboard.write(c.pass(random));
                const ConformanceResult result = scoreboard.result();
                INFO(result.first_mismatch);
                REQUIRE(result.mismatches == 0);
                CHECK(test(result, "HT").compared == 300);
                flips += test(result, "HT").allowed_flips;
                agreed += test(result, "HT").agreed;
            }
        }
    }
    CHECK(flips > 50);  // from the narrow formats; with none the bound would be unnecessary
    CHECK(flips < agreed / 20);
}

TEST_CASE("Highlight Test: a flipped bit is caught") {
    Random random(62);
    std::uint64_t caught = 0, allowed = 0;
    for (int design = 0; design < 30; ++design) {
        Case c = case_with_highlight(random, datapath::Formats{}, Manner::tame);
        for (int k = 0; k < 10; ++k) {
            const ConformanceResult result = check(c, with_flipped_highlight(c.pass(random), 1));
            caught += test(result, "HT").mismatches;
            allowed += test(result, "HT").allowed_flips;
            if (result.mismatches > 0)
                CHECK(result.first_mismatch.find("golden's HT") != std::string::npos);
        }
    }
    CHECK(caught + allowed == 300);
    CHECK(allowed < 10);
}

TEST_CASE("Highlight Test: an end's own product is exact, no flip is allowed there") {
    Random random(63);
    int tried = 0;
    while (tried < 200) {
        Case c = case_with_highlight(random, datapath::Formats{}, Manner::tame);
        datapath::TrianglePass pass = c.pass(random);
        datapath::TestParameters& tests = c.setup.registers.tests;
        const auto product = [&](const datapath::Direction& n) {
            return std::int64_t{n.x} * tests.half_vector[0] + std::int64_t{n.y} * tests.half_vector[1] +
                   std::int64_t{n.z} * tests.half_vector[2];
        };
        // the limit lies one step of the product below the end with the larger product, which exceeds the midpoint's
        const std::int64_t end = std::max(product(pass.triangle.vertices[0].displaced_normal),
                                          product(pass.triangle.vertices[1].displaced_normal));
        if (end - product(pass.edges[0].displaced_normal) < std::int64_t{1} << 20)
            continue;
        tests.highlight_cosine = end - 1;
        tests.highlight_normal_threshold = 0;
        const Case exact(c.setup, Manner::tame);
        EdgeMachine machine = exact.machine;
        const datapath::TrianglePass good = machine.evaluate(pass.triangle);
        if (good.edges[0].displaced_normal == good.triangle.vertices[0].displaced_normal)
            continue;
        ++tried;
        REQUIRE((good.edges[0].tests & datapath::highlight_bit) != 0);
        CHECK(test(check(exact, with_flipped_highlight(good, 0)), "HT").mismatches == 1);
    }
}

TEST_CASE("Highlight Test: only an allowed flip excuses a different split decision") {
    Random random(64);
    int followed = 0;
    const datapath::Formats narrow = make_formats(16, 8, 8, 6, 4, 8, 16, 2);
    for (int design = 0; design < 4000 && followed < 20; ++design) {
        Case c = case_with_highlight(random, narrow, Manner::tame);
        datapath::TestParameters& tests = c.setup.registers.tests;
        tests.normal_test = tests.summed_height_test = false;
        tests.view_test = tests.tex_coord_test = tests.generation_test = false;
        const Case alone(c.setup, Manner::tame);
        EdgeMachine machine = alone.machine;
        const datapath::TrianglePass good = machine.evaluate(c.pass(random).triangle);
        const datapath::TrianglePass flipped = with_flipped_highlight(good, 2);
        if (test(check(alone, flipped), "HT").allowed_flips == test(check(alone, good), "HT").allowed_flips)
            continue;
        if (test(check(alone, flipped), "HT").mismatches > 0)
            continue;
        ++followed;
        CHECK(test(check(alone, good), "split").mismatches == 0);
        // a flipped bit without its split, then together with its split
        CHECK(test(check(alone, flipped), "split").mismatches == 1);
        datapath::TrianglePass whole = flipped;
        whole.split = static_cast<std::uint8_t>(whole.split ^ 4);
        CHECK(test(check(alone, whole), "split").mismatches == 0);
    }
    CHECK(followed == 20);
}

TEST_CASE("Highlight Test: the bound on N'.H holds and is no more than four times the largest error") {
    Random random(65);
    for (const datapath::Formats& formats : {datapath::Formats{}, make_formats(24, 12, 12, 10, 8, 12, 24, 8)}) {
        const ErrorBounds bounds(formats);
        const Dequantise dequantise(formats);
        double largest_bound = 0, largest_error = 0;
        for (int k = 0; k < 200'000; ++k) {
            const auto unit = [&] { return dequantise.direction(rounded(unit_vector(random), formats.normal)); };
            const glm::dvec3 half = unit(), golden = unit_vector(random);
            const glm::dvec3 hardware = dequantise.direction(rounded(golden, formats.normal));
            const double bound = bounds.cosine(golden, glm::dvec3(std::ldexp(0.5, -formats.normal.fraction)), half);
            const double error = std::abs(glm::dot(hardware, half) - glm::dot(golden, half));
            if (error > bound)
                FAIL(error << " beyond " << bound);
            largest_bound = std::max(largest_bound, bound);
            largest_error = std::max(largest_error, error);
        }
        CHECK(largest_bound < 4 * largest_error);
    }
}

TEST_CASE("Highlight Test: the result of a design without one does not list it") {
    Random random(66);
    Case c(random, datapath::Formats{}, Manner::tame);
    for (const ConformanceResult::Test& t : check(c, c.pass(random)).tests)
        CHECK(t.name != "HT");
}

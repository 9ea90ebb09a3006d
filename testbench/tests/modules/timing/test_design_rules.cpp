#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "modules/timing/design_check.h"
#include "modules/timing/design_keys.h"
#include "testbench/tests/support/timed_checks.h"
#include "testbench/tests/support/timed_modules.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

/// What a machine of the default job's registers says of its design.
std::string complaint(const std::function<void(Design&, datapath::Formats&)>& change) {
    MachineSetup setup = setup_of(one_quad_job());
    change(setup.design, setup.registers.formats);
    return error_of([&] { const Machine machine("machine", setup.registers, setup.design); });
}

/// Sets each declared number beyond both ends of its range.
template <typename Group>
struct BeyondRanges {
    const Design& good;
    std::string prefix;
    Group& (*group)(Design&);
    int& tried;

    template <typename Member>
    void add_number(const DesignName& name, Member member, const char*, DesignRange range, const std::string&) const {
        using Value = std::remove_reference_t<decltype(member(group(const_cast<Design&>(good))))>;  // NOLINT: a type
        std::vector<std::uint64_t> values;
        if (range.least > 0)
            values.push_back(range.least - 1);
        values.push_back(std::uint64_t{range.most} + 1);
        values.push_back(std::numeric_limits<Value>::max());
        for (const std::uint64_t value : values) {
            Design design = good;
            member(group(design)) = static_cast<Value>(value);
            CHECK_THAT(design_faults(design, datapath::Formats{}),
                       Contains("Design::" + prefix + name.member + " = " + std::to_string(value) + ": must be " +
                                std::to_string(range.least) + " to " + std::to_string(range.most)));
            ++tried;
        }
        for (const std::uint64_t value : {range.least, range.most}) {
            Design design = good;
            member(group(design)) = static_cast<Value>(value);
            CHECK_THAT(design_faults(design, datapath::Formats{}), !Contains("must be "));
        }
    }
    template <typename Enum, typename Member>
    void add_choice(const DesignName& name, Member member, const std::string&) const {
        Design design = good;
        member(group(design)) = static_cast<Enum>(7);
        CHECK_THAT(design_faults(design, datapath::Formats{}),
                   Contains("Design::" + prefix + name.member + " = 7: must be 0 to "));
        ++tried;
    }
    template <typename Member>
    void add_switch(const DesignName&, Member, const char*) const {}
};

}  // namespace

TEST_CASE("design rules: each declared member's range is held, both ends included") {
    const Design good;
    REQUIRE(design_faults(good, datapath::Formats{}).empty());
    int tried = 0;
    declare_option_keys(BeyondRanges<DesignOptions>{good, "", [](Design& d) -> DesignOptions& { return d; }, tried});
    CHECK(tried > 15);
    declare_timing_keys(BeyondRanges<Timing>{good, "timing.", [](Design& d) -> Timing& { return d.timing; }, tried});
    CHECK(tried > 200);
}

// Ranges: above. Here one of them, as the machine says it, and the rules that join several members.
TEST_CASE("design rules: a machine refuses what would end in a signal, or never end") {
    struct Row {
        std::function<void(Design&)> change;
        const char* said;
    };
    const std::vector<Row> rows{
        {[](Design& d) { d.timing.displace_vertex.interval = 0; },
         "machine: Design::timing.displace_vertex.interval = 0: must be 1 to 1000000 cycles"},
        {[](Design& d) {
             d.timing.summed_height_table.banks = 3;
             d.timing.summed_height_table.interleave = Interleave::exclusive_or;
         },
         "Design::timing.summed_height_table.banks = 3: exclusive ORs of column and row number a power of two of banks; "
         "set summed_height_table.banks = 2"},
        {[](Design& d) { d.tests_units = 2; }, "Design::tests_units = 2: a design has 1 Tessellation Tests unit, or 3"},
        {[](Design& d) { d.edge_lanes = 3; },
         "Design::edge_lanes = 3: only the family design with its tests cheapest first has several; set work = "
         "\"family\" and test_order = \"cheap_first\""},
        {[](Design& d) { d.normal_tests = 2; }, "Design::normal_tests = 2: only the family design"},
        {[](Design& d) { d.work = Work::family; }, "Design::work and Formats::families disagree: set both, or neither"},
    };
    for (const Row& row : rows)
        CHECK_THAT(complaint([&](Design& d, datapath::Formats&) { row.change(d); }), Contains(row.said));
    CHECK_THAT(complaint([](Design& d, datapath::Formats& f) {
                   d.work = Work::family;
                   f.families = true;
                   d.tests_units = 3;
               }),
               Contains("Design::tests_units = 3: the family design has 1 Tessellation Tests unit"));
    CHECK(complaint([](Design&, datapath::Formats&) {}).empty());
}

TEST_CASE("design rules: what a fault of a design and its formats advises is accepted") {
    CHECK(complaint([](Design& d, datapath::Formats& f) {
              d.work = Work::family;
              f.families = true;
          }).empty());
    CHECK(complaint([](Design& d, datapath::Formats& f) {
              d.test_order = TestOrder::cheap_first;
              f.distances = true;
          }).empty());
    CHECK(complaint([](Design& d, datapath::Formats& f) {
              d.work = Work::family;
              f.families = true;
              d.test_order = TestOrder::cheap_first;
              d.edge_lanes = 2;
          }).empty());
}

TEST_CASE("design rules: several faults are said at once") {
    CHECK_THAT(complaint([](Design& d, datapath::Formats&) {
                   d.timing.normal_map.ports = 0;
                   d.queue.watermark = 0;
               }),
               Contains("queue.watermark = 0: must be 1 to 2147483647 triangles") && Contains("normal_map.ports = 0"));
}

TEST_CASE("design rules: a format beyond the datapath's limits is refused") {
    struct Row {
        std::function<void(datapath::Formats&)> change;
        const char* said;
    };
    const std::vector<Row> rows{
        {[](auto& f) { f.position.bits = 33; }, "Formats::position.bits = 33: must be 8 to 32 bits"},
        {[](auto& f) { f.position.fraction = f.position.bits; }, "Formats::position.fraction = "},
        {[](auto& f) { f.normal.bits = 19; }, "Formats::normal.bits = 19: must be 6 to 18"},
        {[](auto& f) { f.normal.fraction = f.normal.bits; }, "Formats::normal.fraction = "},
        {[](auto& f) { f.texture.bits = 1 + 13 + f.texture.fraction; }, "Formats::texture.bits = 26: must be 14 to 25"},
        {[](auto& f) { f.texture.fraction = 13; }, "Formats::texture.fraction = 13: must be 0 to 12"},
        {[](auto& f) { f.tex_coord_fraction = f.texture.fraction + 1; }, "Formats::tex_coord_fraction = "},
        {[](auto& f) { f.displacement.bits = 17; }, "Formats::displacement.bits = 17: must be 1 to 16"},
        {[](auto& f) { f.summed_height.bits = 49; }, "Formats::summed_height.bits = 49: must be 8 to 48"},
        {[](auto& f) { f.screen.bits = 32; }, "Formats::screen.bits = 32: must be 8 to 31"},
        {[](auto& f) { f.screen.fraction = f.screen.bits; }, "Formats::screen.fraction = "},
        {[](auto& f) { f.generation_bits = 5; }, "Formats::generation_bits = 5: must be 1 to 4"},
        {[](auto& f) { f.rank_bits = 17; }, "Formats::rank_bits = 17: must be 6 to 16"},
        {[](auto& f) { f.rank_bits = f.bound_bits = 0; }, "Formats::bound_bits = 0: must be 6 to 16"},
        {[](auto& f) { f.distances = true; }, "Formats::distances = true, which the View Test computes"},
    };
    for (const Row& row : rows)
        CHECK_THAT(complaint([&](Design&, datapath::Formats& f) { row.change(f); }), Contains(row.said));
}

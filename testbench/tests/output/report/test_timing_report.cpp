#include "testbench/output/report/timing_report.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "testbench/output/report/timing_statistics.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/timed_checks.h"

// Bottlenecks of a machine that has not run: its units' activities are set by hand, over 1000 cycles.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

constexpr std::uint64_t cycles = 1000;

/// A machine whose units have done nothing.
struct TimedMachine {
    MachineSetup setup;
    Simulation simulation{setup, 1000};
    Machine& machine = simulation.machine;
    TessellationTests& tests = machine.tessellation_tests[0];

    explicit TimedMachine(const Job& job = timed_job()) : setup(setup_of(job)) {}
};

/// `count` items one after another, from cycle `first`, each for one cycle; with an interval of one the unit is
/// occupied for `count` cycles.
void work_on(Unit& unit, std::uint64_t count, std::uint64_t first = 0) {
    for (std::uint64_t k = 0; k < count; ++k) {
        unit.activity().item_in(first + k);
        unit.activity().item_out(first + k + 1);
    }
}

}  // namespace

TEST_CASE("utilisation: the share of occupied cycles, at most 1") {
    TimedMachine m;
    work_on(m.machine.transform, 250);
    CHECK(utilisation(m.machine.transform, cycles) == 0.25);
    CHECK(utilisation(m.machine.transform, 200) == 1);
    CHECK(utilisation(m.machine.transform, 0) == 0);
}

TEST_CASE("bottleneck: the next limit names all units within one per cent of it, in pipeline order") {
    TimedMachine m;
    work_on(m.machine.transform, 1000);
    work_on(m.tests.view_test, 400);
    work_on(m.tests.normal_test, 396);  // one percent less
    work_on(m.machine.calculate_new_p, 398);
    work_on(m.machine.displace_vertex, 395);
    const Bottleneck found = find_bottleneck(m.machine, cycles);
    CHECK(found.binding);
    CHECK(found.first.units == std::vector<const Unit*>{&m.machine.transform});
    CHECK(found.first.utilisation == 1);
    CHECK(found.next.units ==
          std::vector<const Unit*>{&m.machine.calculate_new_p, &m.tests.normal_test, &m.tests.view_test});
    CHECK(found.next.utilisation == 0.4);
    CHECK(found.bound() == Approx(2.5));
    CHECK(bottleneck_text(m.machine, cycles) ==
          "transform: 100.0 % of its throughput is used; without it at most 2.5 times "
          "faster, bounded by calculate_new_p, tessellation_tests_0.normal_test and "
          "tessellation_tests_0.view_test, which tie at 40.0 %");
}

// The bound is on the run's length, so it depends on the work that remains, not on how far the first limit is ahead:
// without a unit at 90 % at least half of the cycles remain.
TEST_CASE("bottleneck: the bound is that of the other units, and the unit that waits longest is named") {
    TimedMachine m;
    work_on(m.machine.lighting, 900);
    work_on(m.machine.calculate_new_p, 500);
    Activity& waiting = m.machine.pass_or_tessellate.activity();
    waiting.set(0, State::blocked, &m.machine.tessellation);
    waiting.set(500, State::blocked, &m.machine.lighting);
    waiting.finish(800);
    Activity& less = m.machine.get_triangle.activity();
    less.set(0, State::blocked, &m.machine.lighting);
    less.finish(299);
    CHECK(bottleneck_text(m.machine, cycles) ==
          "lighting: 90.0 % of its throughput is used; pass_or_tessellate is delayed by it in "
          "30.0 % of all cycles; without it at most 2.0 times faster, bounded by calculate_new_p, at 50.0 %");
}

TEST_CASE("bottleneck: units that tie bind together") {
    TimedMachine m;
    work_on(m.machine.calculate_new_p, 1000);
    work_on(m.machine.transform, 995);
    work_on(m.machine.lighting, 100);
    Activity& get = m.machine.get_triangle.activity();
    get.set(0, State::blocked, &m.machine.calculate_new_p);
    get.finish(700);
    CHECK(bottleneck_text(m.machine, cycles) ==
          "calculate_new_p and transform, which tie: 100.0 % of their throughput is used; "
          "get_triangle is delayed by calculate_new_p in 70.0 % of all cycles; without them at most 10.0 "
          "times faster, bounded by "
          "lighting, at 10.0 %");
}

TEST_CASE("bottleneck: the only unit that worked has no next limit") {
    TimedMachine m;
    work_on(m.machine.lighting, 1000);
    CHECK(find_bottleneck(m.machine, cycles).bound() == 0);
    CHECK(bottleneck_text(m.machine, cycles) == "lighting: 100.0 % of its throughput is used");
}

TEST_CASE("bottleneck: below 85 % latency binds, and no key is named, since none surely helps") {
    TimedMachine m;
    work_on(m.machine.lighting, 849);
    work_on(m.machine.calculate_new_p, 845);
    Activity& transform = m.machine.transform.activity();
    transform.item_in(0);
    transform.item_out(35);  // longer than in any other stage
    transform.item_in(100);
    transform.item_out(120);
    Activity& get = m.machine.get_triangle.activity();
    get.item_in(0);
    get.item_out(900);  // waiting for other units
    SECTION("Get Triangle is starved") {
        get.set(0, State::blocked, &m.machine.calculate_new_p);
        get.set(200, State::starved);
        get.finish(cycles);
        CHECK(bottleneck_text(m.machine, cycles) ==
              "none: bound by latency; of the busiest (calculate_new_p and lighting) 84.9 % of the "
              "throughput is "
              "used; at most 1.2 times faster with more triangles in flight "
              "(get_triangle is starved 80.0 %) or "
              "shorter latencies (an item stays 27.5 cycles in transform)");
    }
    SECTION("Get Triangle is blocked") {
        get.set(0, State::blocked, &m.machine.calculate_new_p);
        get.set(600, State::starved);
        get.finish(cycles);
        CHECK_THAT(bottleneck_text(m.machine, cycles), Contains("(get_triangle is blocked 60.0 %)"));
    }
    CHECK_FALSE(find_bottleneck(m.machine, cycles).binding);
    work_on(m.machine.lighting, 1, 950);
    CHECK(find_bottleneck(m.machine, cycles).binding);
}

TEST_CASE("bottleneck: below 85 %, a unit that waits for a cache most of the time is named") {
    Job job = timed_job();
    job.timing.summed_height_table.cache.bytes = 1024;
    TimedMachine m(job);
    work_on(m.machine.lighting, 500);
    Activity& waiting = m.tests.height_test.activity();
    waiting.set(0, State::waiting_for_memory, m.machine.height_table_cache.get());
    waiting.set(501, State::waiting_for_memory, &m.machine.normal_map);  // less long
    waiting.finish(600);
    CHECK_THAT(bottleneck_text(m.machine, cycles),
               Contains("(tessellation_tests_0.summed_height_test waits for summed_height_table_cache 50.1 %)"));
}

TEST_CASE("bottleneck: of five units that tie one is named") {
    TimedMachine m;
    for (Unit* unit : {static_cast<Unit*>(&m.machine.calculate_new_p), static_cast<Unit*>(&m.machine.transform),
                       static_cast<Unit*>(&m.tests.view_test), static_cast<Unit*>(&m.machine.lighting)})
        work_on(*unit, 100);
    CHECK(find_bottleneck(m.machine, cycles).first.names() ==
          "calculate_new_p, transform, tessellation_tests_0.view_test and lighting");
    work_on(m.tests.tex_coord_test, 100);
    CHECK(find_bottleneck(m.machine, cycles).first.names() == "calculate_new_p and 4 others");
}

TEST_CASE("bottleneck: an idle machine has none") {
    TimedMachine m;
    CHECK(bottleneck_text(m.machine, cycles) == "none: no unit was busy");
    CHECK(find_bottleneck(m.machine, cycles).bound() == 0);
}

// 12 entries per edge through one port: 36 of the 86 cycles (modules/test_one_triangle.cpp). The bound is the nine
// parts that four units pass on, one per cycle.
TEST_CASE("bottleneck of one triangle: latency binds") {
    Job job = timed_job();
    job.mesh.columns = job.mesh.rows = 1;
    job.map.source = MapSource::constant;
    MachineSetup setup = setup_of(job);
    setup.base_triangles.resize(1);
    TimedRun simulation(setup);
    const std::string text = bottleneck_text(simulation.machine, simulation.cycles());
    CHECK_THAT(text, StartsWith("none: bound by latency; of the busiest (summed_height_table) 41.9 % of the "
                                "throughput is used; at most 2.4 times faster ") &&
                         EndsWith("(an item stays 20.0 cycles in transform)"));
}

namespace {

struct MemoryUse {
    std::string name, settings, text;
};

const CaseTable memory_uses("bottleneck, a memory: ",
                            {MemoryUse{"its ports", "", "summed_height_table: 99.9 % of its port slots are taken; "},
                             {"requests that wait for a bank", "timing.summed_height_table_banks=8",
                              "summed_height_table: in 99.3 % of all cycles a request waits for its ports; "},
                             {"the off-chip channel", "hardware.queue_capacity=4 timing.off_chip_bandwidth=1",
                              "off_chip_memory: 99.9 % of the off-chip channel's cycles are taken; "}},
                            [](const MemoryUse& use) {
                                TimedRun simulation(setup_of(with_settings(full_split_job(1, 4), use.settings)));
                                CHECK_THAT(bottleneck_text(simulation.machine, simulation.cycles()),
                                           StartsWith(use.text));
                            });

}  // namespace

// The second machine has no base triangles.
TEST_CASE("timing of two machines: rows of each, and the bottleneck of the last one to finish") {
    Job job = timed_job();
    job.mesh.columns = job.mesh.rows = 1;
    job.map.source = MapSource::constant;
    job.hardware.machines = 2;
    MachineSetup setup = setup_of(job);
    setup.base_triangles.resize(1);
    TimedRun simulation(setup);
    const HostedMachine &first = *simulation.machines[0], &second = *simulation.machines[1];
    CHECK(&simulation.last_machine() == &first);
    CHECK(second.machine.get_triangle.host_triangles() == 0);
    std::vector<Figure> figures;
    timing_figures(figures, simulation);
    const auto items = [&](const std::string& unit) {
        for (const Figure& figure : figures)
            if (figure.row == unit && figure.name == "items")
                return std::get<std::uint64_t>(figure.value);
        return UINT64_MAX;
    };
    CHECK(items("transform") == 9);
    CHECK(unit_name(second.machine.transform) == "tessera_1.transform");
    CHECK(items("tessera_1.transform") == 0);
    for (const Figure& figure : figures)
        if (figure.name == "bottleneck_in_words")
            CHECK(std::get<std::string>(figure.value) == bottleneck_text(first.machine, 86));
}

TEST_CASE("queue_levels.csv: each row has the first cycle of a stretch and its highest level") {
    LevelHistory history;
    history.set(1, 4);
    history.set(3, 2);
    history.finish(5);
    CHECK(queue_levels_csv(history) == "first_cycle,highest_level\n0,0\n1,4\n2,4\n3,4\n4,2\n");
    history.finish(2000);
    const std::string text = queue_levels_csv(history);
    CHECK_THAT(text, StartsWith("first_cycle,highest_level\n0,4\n2,4\n4,2\n"));
    CHECK_THAT(text, EndsWith("\n1998,2\n"));
}

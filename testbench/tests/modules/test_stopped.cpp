#include <array>
#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/timed_checks.h"
#include "testbench/tests/support/timed_modules.h"

// A machine that is stopped in any cycle: a unit describes its contents, in complete phrases, exactly while it holds
// something, and the pipeline's overall state is correct.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using Texts = std::set<std::string>;

namespace {

/// A list without empty elements: each separator has text on both sides.
bool is_well_formed(const std::string& text) {
    for (const char* broken : {", ,", "; ;", ", ;", "; ,", "  "})
        if (text.find(broken) != std::string::npos)
            return false;
    return text.find_first_of(",; ") != 0 && text.find_last_of(",; ") != text.size() - 1;
}

/// Runs the machine cycle by cycle. Returns all descriptions of units' contents, with digits as #.
Texts texts_of_every_cycle(const MachineSetup& setup) {
    Simulation simulation(setup, 1'000'000, 1'000'000);
    Machine& machine = simulation.machine;
    Texts texts;
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    while (!machine.clock.idle()) {
        sc_core::sc_start(machine.clock.period());
        bool all_empty = true;
        for (const Unit* unit : machine.units()) {
            std::string text = unit->describe_contents();
            INFO("cycle " << machine.clock.last_cycle() << ": " << unit->name() << ": \"" << text << '"');
            REQUIRE((text.empty() || is_well_formed(text)));
            if (!unit->idle())
                REQUIRE_FALSE(text.empty());
            all_empty = all_empty && unit->idle() && text.empty();
            for (char& c : text)
                c = c >= '0' && c <= '9' ? '#' : c;
            texts.insert(unit->basename() + (": " + text));
        }
        REQUIRE(machine.idle() == all_empty);
    }
    sc_core::sc_report_handler::set_actions(sc_core::SC_ID_NO_SC_START_ACTIVITY_, sc_core::SC_DO_NOTHING);
    run_timed(simulation);
    return texts;
}

bool any_contains(const Texts& texts, const std::string& unit, const std::string& what) {
    for (const std::string& text : texts)
        if (text.rfind(unit + ": ", 0) == 0 && text.find(what) != std::string::npos)
            return true;
    return false;
}

/// Records the state whenever Machine::drained() is notified, with base triangles that become 16 each.
struct DrainedWatch : sc_core::sc_module {
    DrainedWatch(const std::string& name, HostedMachine& hosted) : sc_module(name.c_str()), hosted_(hosted) {
        SC_HAS_PROCESS(DrainedWatch);
        SC_METHOD(note);
        dont_initialize();
        sensitive << hosted.machine.drained();
    }
    unsigned notified = 0;
    bool always_whole = true;  ///< as many frames as notifications were lit, and nothing was in flight

  private:
    void note() {
        ++notified;
        always_whole =
            always_whole && hosted_.drained() && hosted_.rasteriser.triangles() == 16 * hosted_.host.total() * notified;
    }
    HostedMachine& hosted_;
};

struct Drained {
    std::string name;
    std::string settings;
    unsigned machines = 1;
};

const CaseTable<Drained> drained(
    "drained: notified once for each frame, when all of it is lit: ",
    {
        {"timed, three Tessellation Tests units, random stalls",
         "mode=timed hardware.tests_units=3 " + random_stalls(3, 300, 9)},
        {"timed, modern design", "mode=timed hardware.design=modern"},
        {"timed, a queue that spills, two machines", "mode=timed hardware.queue_capacity=4", 2},
        {"functional, watermark 8", "mode=functional hardware.queue_watermark=8"},
        {"functional, modern design, three machines", "mode=functional hardware.design=modern", 3},
    },
    [](const Drained& row) {
        MachineSetup setup = setup_of(with_settings(full_split_job(2, 2), row.settings));
        setup.machines = row.machines;
        Simulation simulation(setup, 1'000'000);
        std::vector<std::unique_ptr<DrainedWatch>> watches;
        for (std::size_t k = 0; k < row.machines; ++k)
            watches.push_back(std::make_unique<DrainedWatch>("watch_" + std::to_string(k), *simulation.machines[k]));
        for (unsigned frame = 1; frame <= 3; ++frame) {
            REQUIRE(simulation.run().empty());
            for (const auto& watch : watches) {
                CHECK(watch->notified == frame);
                CHECK(watch->always_whole);
            }
            for (const auto& hosted : simulation.machines)
                hosted->host.send_again();
        }
    });

/// Sends one triangle, and begins no frame.
struct FramelessSource : sc_core::sc_module, CycleProcess {
    StreamOutput<datapath::Triangle> out{"out"};

    FramelessSource(const sc_core::sc_module_name& name, Machine& machine, const datapath::Triangle& triangle)
        : sc_module(name), machine_(machine), triangle_(triangle) {
        machine.clock.attach(*this);
        out.clocked_by(machine.clock, *this);
        out.bind(machine.get_triangle.from_host);
        SC_HAS_PROCESS(FramelessSource);
        if (machine.transport() == Transport::blocking)
            SC_THREAD(send);
    }

  private:
    void start_of_simulation() override {
        if (machine_.transport() == Transport::non_blocking)
            machine_.clock.wake(*this);
    }
    void step() override {
        if (!std::exchange(sent_, true))
            out.send(triangle_);
    }
    void send() {
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        out->b_transport(triangle_, delay);
    }
    Machine& machine_;
    datapath::Triangle triangle_;
    bool sent_ = false;
};

struct Frameless {
    std::string name;
    Mode mode;
};

const CaseTable<Frameless> frameless("a triangle before any frame is an error that says how to begin one: ",
                                     {{"timed", Mode::timed}, {"functional", Mode::functional}},
                                     [](const Frameless& row) {
                                         Job job = one_quad_job();
                                         job.mode = row.mode;
                                         const MachineSetup setup = setup_of(job);
                                         Machine machine("pipeline", setup.registers, setup.design);
                                         Rasteriser rasteriser("rasteriser", machine.clock, {});
                                         machine.lighting.to_rasteriser.bind(rasteriser.from_lighting);
                                         const FramelessSource source("source", machine, setup.base_triangles.front());
                                         CHECK_THAT(error_of([] { sc_core::sc_start(); }),
                                                    Contains("pipeline.get_triangle: a triangle outside a frame: "
                                                             "call Machine::begin_frame()"));
                                         CHECK(machine.get_triangle.host_triangles() == 0);
                                     });

struct Row {
    std::string name;
    std::string settings;
    std::vector<std::pair<std::string, std::string>> said;  ///< by which unit, what
};

const CaseTable stopped(
    "contents of units described in every cycle: ",
    {
        Row{"the paper's design, random stalls",
            random_stalls(3, 300, 9) + "hardware.queue_capacity=2",
            {{"get_triangle", "partly sent"},
             {"get_triangle", "not accepted because the queue is at its watermark"},
             {"pass_or_tessellate", "waiting for both branches"},
             {"pass_or_tessellate", "waiting for Tessellation Tests"},
             {"transform", "waiting at the input"},
             {"summed_height_table", "one waiting at the input"},
             {"off_chip_memory", "one waiting at the input"}}},
        // A triangle's nine edges take some sixty cycles in the tests: each of the last three units then waits for the
        // next one.
        {"every interval longer than the latency, a queue of three that spills",
         every_unit("latency", 1) + every_unit("interval", 7) + every_unit("buffer", 1) +
             "hardware.queue_capacity=3 hardware.queue_order=lifo timing.pass_or_tessellate_interval=100 "
             "timing.pass_or_tessellate_buffer=8 timing.tessellation_interval=60 "
             "timing.triangle_queue_interval=100",
         {{"pass_or_tessellate", "the first (#) complete"},
          {"triangle_queue", "of them off chip"},
          {"triangle_queue", "no room for the next (capacity #)"},
          {"tessellation", "children of a triangle, a waiting triangle"}}},
        {"three tests units, a slow Transform, host triangles at any time",
         "hardware.tests_units=3 hardware.queue_watermark=1000 timing.summed_height_table_ports=12 "
         "timing.transform_latency=300 timing.transform_interval=90",
         {{"pass_or_tessellate", "waiting for Transform"}, {"get_triangle", "a host triangle"}}},
        {"cheap tests first, random stalls",
         "hardware.test_order=cheap_first tests.normal_threshold=1 " + random_stalls(3, 300, 9),
         {{"sequence_tests", "the oldest waits for the Normal Test to take it"},
          {"sequence_tests", "the oldest waits for the Summed Height Test"},
          {"sequence_tests", "the oldest waits for Pass or Tessellate to take it"},
          {"sequence_tests", "a vertex that the Normal Test does not accept"},
          {"sequence_tests", "from calculate_new_u for summed_height_test"},
          {"sequence_tests", "from view_test"}}},
        {"families, three lanes, random stalls",
         "hardware.work=family hardware.test_order=cheap_first hardware.edge_lanes=3 tests.normal_threshold=1 " +
             random_stalls(3, 300, 9),
         {{"tessellation", ", waiting for parts"},
          {"tessellation", ", complete"},
          {"tessellation", ", partly sent"},
          {"tessellation", "that wait for their parts"},
          {"pass_or_tessellate", "that waits for Tessellation Tests"},
          {"pass_or_tessellate", "that is complete"},
          {"pass_or_tessellate", "decided triangle"},
          {"sequence_tests", " in the Normal Test"},
          {"sequence_tests", " in the Summed Height Test"},
          {"sequence_tests", " that Pass or Tessellate does not accept"},
          {"sequence_tests", " from tex_coord_test"}}},
        {"an unbounded queue that takes a triangle every forty cycles",
         "timing.triangle_queue_latency=50 timing.triangle_queue_interval=40",
         {{"triangle_queue", "of them leaving"}, {"triangle_queue", "no room for the next"}}},
    },
    [](const Row& row) {
        const Texts texts = texts_of_every_cycle(setup_of(with_settings(full_split_job(2, 2), row.settings)));
        for (const auto& [unit, what] : row.said) {
            CAPTURE(unit, what);
            CHECK(any_contains(texts, unit, what));
        }
    });

}  // namespace

TEST_CASE("drained: not notified in a deadlock") {
    Job job = timed_job();
    job.hardware.queue.capacity = 8;
    job.hardware.queue.overflow = QueueOverflow::stall;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    DrainedWatch watch("watch", *simulation.machines[0]);
    CHECK_THAT(simulation.run(), Catch::StartsWith("deadlock: "));
    CHECK(watch.notified == 0);
}

TEST_CASE("a table's row that no memory accepts is an error") {
    const MachineSetup setup = setup_of(one_quad_job());
    Machine machine("pipeline", setup.registers, setup.design);
    Rasteriser rasteriser("rasteriser", machine.clock, {});
    Host host("host", machine, setup.base_triangles, [&](const TableWriter& write) {
        const std::array<unsigned char, 4> row{};
        write(setup.registers.displacement_map.base + setup.registers.displacement_map.bytes(), row.data(), row.size());
    });
    host.bind();
    machine.lighting.to_rasteriser.bind(rasteriser.from_lighting);
    CHECK_THAT(error_of([] { sc_core::sc_start(); }),
               Contains("displace_vertex.displacement_map: the machine's own memory has room for the tables of the "
                        "registers with which the machine was built"));
}

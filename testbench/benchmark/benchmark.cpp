#include <benchmark/benchmark.h>

#include <array>
#include <cstdlib>
#include <optional>
#include <systemc>
#include <vector>

#include "golden/golden_model.h"
#include "modules/device/device.h"
#include "modules/device/program_registers.h"
#include "modules/device/records.h"
#include "testbench/check/conformance/golden_inputs.h"
#include "testbench/examples/platform/bus.h"
#include "testbench/examples/platform/processor.h"
#include "testbench/job/design_preset.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/simulation.h"

// One process, one job: half donut on the plane of 18 triangles with a map of 1024 x 1024 texels, about 0.2 million
// triangles out; an argument sets another number of texels per side. Measures, in edges evaluated and triangles
// finished per second: the golden model, the bare datapath, functional and timed mode of both machines, and the device on
// a loosely timed bus.

namespace tessera {
namespace {

Job benchmark_job(int map_side) {
    Job job;
    job.mode = Mode::functional;
    job.map.width = job.map.height = map_side;
    job.tests.normal_threshold = 0.02;
    job.tests.threshold("summed_height_threshold") = 1;
    job.tests.view_threshold = 0.5;
    return job;
}

MachineSetup benchmark_setup(DesignPreset design, int map_side) {
    Job job = benchmark_job(map_side);
    job.hardware.design = design;
    apply_design(job);
    const Inputs inputs = load_inputs(job);
    return make_setup(inputs.resolved.job, inputs.mesh, inputs.map);
}

void report(benchmark::State& state, std::uint64_t edges, std::size_t triangles) {
    state.counters["edges_per_second"] = benchmark::Counter(static_cast<double>(edges), benchmark::Counter::kIsRate);
    state.counters["triangles"] = static_cast<double>(triangles);
    state.counters["triangles_per_second"] =
        benchmark::Counter(static_cast<double>(triangles), benchmark::Counter::kIsIterationInvariantRate);
}

void golden_model(benchmark::State& state, const MachineSetup& setup) {
    const GoldenInputs inputs(setup);
    const std::vector<std::array<golden::Vertex, 3>> base = golden_base_triangles(setup);
    std::uint64_t edges = 0;
    std::size_t triangles = 0;
    for (auto _ : state) {
        triangles = 0;
        edges += golden::tessellate(base, inputs.map, inputs.parameters, std::uint64_t{1} << 40,
                                    [&](const golden::Triangle&) { ++triangles; })
                     .edges_evaluated;
    }
    report(state, edges, triangles);
}

void bare_datapath(benchmark::State& state, BareRecursion& bare) {
    EmittedMesh mesh;
    std::uint64_t edges = 0;
    for (auto _ : state)
        edges += bare.run(mesh);
    report(state, edges, mesh.triangles.size());
}

/// Runs one frame in the mode that the simulation was set up with.
void one_frame(benchmark::State& state, Simulation& simulation) {
    const auto edges_so_far = [&] { return simulation.machine.edges_tested(); };
    const std::uint64_t before = edges_so_far();
    const bool timed = simulation.setup.design.transport == Transport::non_blocking;
    std::uint64_t cycles = 0;
    for (auto _ : state) {
        simulation.monitor.mesh.triangles.clear();
        simulation.host.send_again();
        // Between two frames the other simulations advance simulated time: a timed frame begins at the present cycle.
        const std::uint64_t first_cycle = simulation.last_machine().machine.clock.cycle();
        if (!simulation.run().empty())
            state.SkipWithError("the simulation did not drain");
        if (timed)
            cycles += simulation.last_machine().last_cycle() - first_cycle;
    }
    report(state, edges_so_far() - before, simulation.monitor.mesh.triangles.size());
    if (timed)
        state.counters["cycles"] = benchmark::Counter(static_cast<double>(cycles), benchmark::Counter::kAvgIterations);
}

/// A processor, a memory, and the machine as a device in functional mode.
class Platform {
  public:
    explicit Platform(const MachineSetup& setup) : device_("device", setup.registers, design_of(setup)) {
        processor_.bus.bind(router_.from);
        device_.bus.bind(router_.from);
        router_.to_device.bind(device_.registers);
        router_.to_memory.bind(memory_.bus);
        device_.interrupt.bind(interrupt_);
        processor_.interrupt.bind(interrupt_);
        write_tables(setup, [this](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
            std::copy_n(bytes, count, &memory_.bytes.at(address));
        });
        for (std::size_t k = 0; k < setup.base_triangles.size(); ++k)
            write_base_triangle(setup.base_triangles[k], &memory_.bytes.at(triangles_at + k * base_triangle_bytes));
        processor_.program = [this, &setup](Processor&) { draw_frames(setup); };
    }

    /// Returns whether the frame succeeded. The first frame copies the tables.
    bool draw_frame() {
        start_.notify(sc_core::SC_ZERO_TIME);
        sc_core::sc_start();
        return result_ == TESSERA_OK;
    }
    std::uint32_t triangles() const { return triangles_; }
    std::uint64_t edges_tested() { return device_.machine().edges_tested(); }

  private:
    static constexpr std::size_t triangles_at = std::size_t{32} << 20, ring_at = std::size_t{33} << 20;
    static constexpr std::uint32_t ring_records = 400'000;

    static DeviceDesign design_of(const MachineSetup& setup) {
        DeviceDesign design;
        design.machine = setup.design;
        design.largest_map = {setup.registers.map.width, setup.registers.map.height};
        return design;
    }
    void draw_frames(const MachineSetup& setup) {
        const tessera_platform platform = processor_.platform();
        const datapath::Registers& r = setup.registers;
        tessera_driver driver;
        tessera_init(&driver, &platform);
        program_registers(platform, r);
        tessera_set_tables(&driver, r.displacement_map.base, r.normal_map.base, r.height_table.base);
        tessera_set_triangles(&driver, triangles_at, static_cast<std::uint32_t>(setup.base_triangles.size()));
        tessera_set_ring(&driver, ring_at, ring_records);
        tessera_enable_interrupts(&driver, TESSERA_INTERRUPT_DONE);
        for (std::uint32_t tables = 7;; tables = 0) {
            wait(start_);
            tessera_fetch_tables(&driver, tables);
            result_ = tessera_start(&driver);
            if (result_ == TESSERA_OK)
                result_ = tessera_wait(&driver, ~0u);
            std::uint32_t interrupts = 0;
            tessera_acknowledge(&driver, &interrupts);
            tessera_ring_count(&driver, &triangles_);
        }
    }

    Device device_;
    Memory memory_{"memory", ring_at + ring_records* std::size_t{finished_triangle_bytes}};
    Router router_{"router"};
    Processor processor_{"processor"};
    sc_core::sc_signal<bool> interrupt_{"interrupt"};
    sc_core::sc_event start_{"start"};
    int result_ = TESSERA_BUSY;
    std::uint32_t triangles_ = 0;
};

void device_frame(benchmark::State& state, Platform& platform) {
    const std::uint64_t before = platform.edges_tested();
    for (auto _ : state)
        if (!platform.draw_frame())
            state.SkipWithError("the device refused the frame");
    report(state, platform.edges_tested() - before, platform.triangles());
}

MachineSetup in_timed_mode(MachineSetup setup) {
    setup.design.transport = Transport::non_blocking;
    return setup;
}

}  // namespace
}  // namespace tessera

int sc_main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    const int map_side = argc > 1 ? std::atoi(argv[1]) : 1024;
    const tessera::MachineSetup setup = tessera::benchmark_setup(tessera::DesignPreset::paper, map_side);
    tessera::BareRecursion bare(setup);
    tessera::Simulation simulation(setup, std::uint64_t{1} << 40);
    // All simulations share one elaboration; SystemC numbers repeated names.
    sc_core::sc_report_handler::set_actions(sc_core::SC_ID_INSTANCE_EXISTS_, sc_core::SC_DO_NOTHING);
    const tessera::MachineSetup timed_setup = tessera::in_timed_mode(setup);
    tessera::Simulation timed_simulation(timed_setup, std::uint64_t{1} << 40);
    const tessera::MachineSetup modern_setup = tessera::benchmark_setup(tessera::DesignPreset::modern, map_side);
    tessera::Simulation modern_simulation(modern_setup, std::uint64_t{1} << 40);
    const tessera::MachineSetup modern_timed_setup = tessera::in_timed_mode(modern_setup);
    tessera::Simulation modern_timed_simulation(modern_timed_setup, std::uint64_t{1} << 40);
    tlm::tlm_global_quantum::instance().set(sc_core::sc_time(1, sc_core::SC_MS));
    std::optional<tessera::Platform> platform;  // its memory is sized for the default map
    if (map_side <= 1024)
        platform.emplace(setup);
    simulation.run();
    if (platform)
        platform->draw_frame();
    const auto add = [](const char* name, auto run) {
        benchmark::RegisterBenchmark(name, run)->Unit(benchmark::kMillisecond);
    };
    const auto add_frames = [&](const char* name, tessera::Simulation& machine) {
        add(name, [&machine](benchmark::State& state) { tessera::one_frame(state, machine); });
    };
    add("golden_model", [&](benchmark::State& state) { tessera::golden_model(state, setup); });
    add("bare_datapath", [&](benchmark::State& state) { tessera::bare_datapath(state, bare); });
    add_frames("functional_mode", simulation);
    if (platform)
        add("device_functional", [&](benchmark::State& state) { tessera::device_frame(state, *platform); });
    add_frames("timed_mode", timed_simulation);
    add_frames("modern_functional_mode", modern_simulation);
    add_frames("modern_timed_mode", modern_timed_simulation);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}

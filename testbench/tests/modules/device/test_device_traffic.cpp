#include <fmt/format.h>

#include "testbench/machine/host_traffic.h"
#include "testbench/tests/modules/device/bench.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/source_folder.h"
#include "testbench/tests/support/test_folder.h"

// The bytes that a frame moves over the bus, compared with those that `tessera run` reports; and a slow sink.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// Takes the machine's triangles in a thread and waits after each.
struct WaitingSink : sc_core::sc_module {
    FrameStreams streams;
    std::vector<LitTriangle> taken;

    WaitingSink(const sc_core::sc_module_name& name, CycleScheduler& clock, const Design& design)
        : sc_module(name), streams("streams", clock, design, 1, 2) {
        streams.to_get_triangle.bind(unused_);
        SC_HAS_PROCESS(WaitingSink);
        SC_THREAD(take);
    }

  private:
    void take() {
        for (;;) {
            while (!streams.has_finished())
                wait(streams.come());
            taken.push_back(streams.take().triangle);
            wait(sc_core::sc_time(1, sc_core::SC_US));
        }
    }

    StreamInput<datapath::Triangle> unused_{"unused"};  // the host sends triangles itself
};

const CaseTable<BenchMode> waiting_sink{
    "a sink that waits after each triangle gets all from a buffer: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        const MachineSetup setup = setup_of(small_job(mode.timed));
        Reference reference("reference", setup);
        Machine machine("pipeline", setup.registers, setup.design);
        Host host("host", machine, setup.base_triangles, tables_of(setup));
        WaitingSink sink("sink", machine.clock, setup.design);
        host.bind();
        machine.lighting.to_rasteriser.bind(sink.streams.from_lighting);
        sc_core::sc_start();
        LitKeys found;
        for (const LitTriangle& lit : sink.taken) {
            std::array<unsigned char, finished_triangle_bytes> record{};
            write_finished_triangle(lit, record.data());
            found.insert(key_of(record.data()));
        }
        expect_same(found, reference.keys);
        CHECK(sc_core::sc_time_stamp() > sc_core::sc_time(0.9 * static_cast<double>(found.size()), sc_core::SC_US));
    }};

}  // namespace

TEST_CASE("the default job's bytes on the bus match the table in README.md") {
    const Job job = with_settings({}, "mode=functional");
    const MachineSetup setup = setup_of(job);
    Reference reference("reference", setup);
    Bench bench({formats_of(setup)}, design_of(setup));
    const FramePlaces places = bench.place(setup, 20'000);
    bench.cpu.program = [&](Processor& cpu) {
        tessera_driver& driver = bench.init();
        set_frame(driver, setup, places);
        REQUIRE(tessera_enable_interrupts(&driver, 1) == TESSERA_OK);
        REQUIRE(tessera_start(&driver) == TESSERA_OK);
        cpu.wait_for_interrupt();
    };
    bench.run();
    const HostTraffic host = host_traffic(setup);
    const std::uint64_t tables = host.displacement_map + host.normal_map + host.summed_height_table;
    const std::uint64_t mesh = setup.base_triangles.size() * base_triangle_bytes;
    CHECK(bench.memory.bytes_read == tables + mesh);
    CHECK(bench.memory.bytes_written == reference.keys.size() * finished_triangle_bytes);

    const std::string page = read_all(source_folder() / "modules/device/README.md");
    for (const std::string& row :
         {fmt::format("| three tables | {} | {} |\n", tables, tables),
          fmt::format("| {} base triangles | {} | {} |\n", setup.base_triangles.size(), mesh, host.base_mesh),
          fmt::format("| {} finished triangles | {} | - |\n", reference.keys.size(), bench.memory.bytes_written)})
        CHECK_THAT(page, Catch::Contains(row));
}

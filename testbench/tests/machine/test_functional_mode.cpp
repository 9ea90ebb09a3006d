#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/tests/machine/mesh_keys.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"

// The whole machine, from the host's triangles to the rasteriser. SystemC elaborates once per process, so each case
// runs one simulation.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// In functional mode; test_timed_mode.cpp tests the other.
MachineSetup functional_setup(const std::string& settings = "") {
    return setup_of(with_settings({}, "mode=functional " + settings));
}

/// Requires that no value saturates and no base edge stays open, as holds with the paper's formats or any that are wide
/// enough for the mesh.
void expect_sound(const CheckedRun& run) {
    CHECK(run.conformance.passed(0.5));
    CHECK(run.machine.saturations().total() == 0);
    run.expect_closed_in_texture();
    const auto& made = run.machine.tessellation.made_into();
    const bool families = run.setup.design.work == Work::family;
    const std::uint64_t waited =
        families ? made[1] + made[2] + made[3] + made[4] : made[1] + 2 * made[2] + 3 * made[3] + 4 * made[4];
    CHECK(run.machine.triangle_queue.taken() == waited);
    CHECK(run.machine.get_triangle.queue_triangles() == waited);
}

const CaseTable meshes("",
                       {
                           SettingsRow{"half donut: the pipeline's mesh equals the bare datapath's, bit for bit", ""},
                           {"half donut, many host triangles at a time: the same mesh",
                            "hardware.queue_watermark=1000"},
                           {"half donut, always the second diagonal", "hardware.triangulation=second"},
                           {"cylinder in repeat: the seam stays closed",
                            "mesh.source=cylinder map.source=noise map.width=64 map.height=33 map.address_u=repeat "
                            "displacement.scale=0.1 tests.view_threshold=8"},
                       },
                       [](const SettingsRow& row) {
                           const CheckedRun run(functional_setup(row.settings));
                           expect_sound(run);
                           CHECK(run.mesh.triangles.size() > 1000);
                       });

}  // namespace

TEST_CASE("memories read by transactions: the same mesh, and reads are counted as through DMI") {
    const CheckedRun run(functional_setup("hardware.direct_memory=false"));
    const Machine& p = run.machine;
    CHECK(p.displace_vertex.displacement_map.reads() == p.displacement_map.transactions());
    CHECK(p.normal_map_reads() == p.normal_map.transactions());
    CHECK(p.height_table_reads() == p.height_table.transactions());
    CHECK(p.height_table.transactions() == 12 * p.edges_tested());
    CHECK(p.displacement_map.transactions() == p.edges_tested() + 3 * run.setup.base_triangles.size());
}

namespace {

/// Delays every third item of a stream, so that the host's triangles and the queue's may overtake one another.
template <class Item>
struct Detour : sc_core::sc_module, tlm::tlm_fw_transport_if<Stream<Item>>, tlm::tlm_bw_transport_if<Stream<Item>> {
    tlm::tlm_target_socket<32, Stream<Item>> in{"in"};
    tlm::tlm_initiator_socket<32, Stream<Item>> out{"out"};
    unsigned items = 0;
    unsigned& overtaken;

    Detour(const sc_core::sc_module_name& name, unsigned& overtakings) : sc_module(name), overtaken(overtakings) {
        in.bind(*this);
        out.bind(*this);
    }

  private:
    void b_transport(Item& item, sc_core::sc_time& delay) override {
        if (++items % 3 == 0) {
            const unsigned before = items;
            sc_core::wait(sc_core::sc_time(50, sc_core::SC_NS));
            overtaken += items > before ? 1 : 0;
        }
        out->b_transport(item, delay);
    }
    tlm::tlm_sync_enum nb_transport_fw(Item&, tlm::tlm_phase&, sc_core::sc_time&) override { return tlm::TLM_ACCEPTED; }
    tlm::tlm_sync_enum nb_transport_bw(Item&, tlm::tlm_phase&, sc_core::sc_time&) override { return tlm::TLM_ACCEPTED; }
    bool get_direct_mem_ptr(Item&, tlm::tlm_dmi&) override { return false; }
    unsigned transport_dbg(Item&) override { return 0; }
    void invalidate_direct_mem_ptr(sc_dt::uint64, sc_dt::uint64) override {}
};

/// Inserts a detour into each stream of parts.
struct Detours : UnitFactory {
    std::vector<std::unique_ptr<sc_core::sc_module>> detours;
    unsigned overtaken = 0;

    void made(sc_core::sc_module& module) override {
        for_each_output(module, [&](auto& output) { interpose(output); });
    }
    template <class Item>
    void interpose(StreamOutput<Item>& output) {
        if constexpr (is_part<Item>)
            output.interpose([this](StreamOutput<Item>& from, StreamInput<Item>& to) {
                auto detour = std::make_unique<Detour<Item>>(sc_core::sc_gen_unique_name("detour"), overtaken);
                from.bind(detour->in);
                detour->out.bind(to);
                detours.push_back(std::move(detour));
            });
    }
};

const CaseTable overtaking(
    "functional mode: triangles may overtake one another on every stream, and the mesh is the same, ",
    {SettingsRow{"the paper's design", ""},
     {"the cheap tests first",
      "hardware.test_order=cheap_first hardware.final_edges=true hardware.one_texel_from_map=true"},
     {"a bilinear filter, families", "hardware.displacement_filter=bilinear hardware.design=modern"}},
    [](const SettingsRow& row) {
        Detours detours;
        // many at a time, so that host and queue send concurrently
        const CheckedRun run(functional_setup("hardware.queue_watermark=1000 " + row.settings), &detours);
        expect_sound(run);
        CHECK(detours.overtaken > 0);
    });

}  // namespace

TEST_CASE("the triangle limit ends a run with a message that names its key") {
    const MachineSetup setup = functional_setup();
    Simulation simulation(setup, 500);
    CHECK_THROWS_AS(simulation.run(), ResourceError);
    CHECK(simulation.monitor.mesh.triangles.size() == 500);
}

TEST_CASE("a recursion without end is stopped before a triangle is finished, with culling too") {
    const MachineSetup setup = functional_setup(
        "map.source=noise tests.normal_threshold=0 tests.view=false tests.tex_coord=false tests.generation=false "
        "hardware.culling=back");
    Simulation simulation(setup, 500);
    CHECK_THROWS_AS(simulation.run(), ResourceError);
    CHECK(simulation.monitor.mesh.triangles.empty());
}

TEST_CASE("a machine that is stopped with triangles in its queue is not idle") {
    // a base triangle that makes more than go without a pause
    const MachineSetup setup = functional_setup("mesh.columns=1 mesh.rows=1");
    Simulation simulation(setup, 500);
    CHECK(simulation.machine.idle());
    CHECK_THROWS_AS(simulation.run(), ResourceError);
    CHECK(simulation.machine.triangle_queue.waiting() > 0);
    CHECK_FALSE(simulation.machine.idle());
}

TEST_CASE("a read outside a table is an error that names the reader") {
    MachineSetup setup = functional_setup("hardware.direct_memory=false");
    Simulation simulation(setup, 1'000'000);
    setup.registers.map.height *= 2;  // the units now assume a map larger than its memory
    try {
        simulation.run();
        FAIL("no error");
    } catch (const sc_core::sc_report& report) {
        CHECK_THAT(report.what(), Catch::Contains("tessera.displace_vertex") && Catch::Contains("TLM_ADDRESS_ERROR"));
    }
}

TEST_CASE("a base triangle's View Test waits for its corners' screen positions") {
    MachineSetup setup = functional_setup(
        "mesh.columns=1 mesh.rows=1 map.source=constant "
        "timing.transform_latency=500");  // far more than the tests take
    setup.base_triangles.resize(1);
    Simulation simulation(setup, 1'000'000);
    REQUIRE(simulation.run().empty());
    // The host's time is the first pass of one base triangle: Get Triangle 1, Calculate New P 1, Displace Vertex 6 and
    // a read of the map (a triangle's parts run in parallel), Transform, the View Test 1, Pass or Tessellate 1,
    // Tessellation 1, Triangle Queue 1. The second pass, for the normals, is shorter and starts at the same time.
    const std::uint64_t expected = 1 + 1 + 6 + 1 + 500 + 1 + 1 + 1 + 1;
    CHECK(sc_core::sc_time_stamp().value() == expected * setup.design.timing.cycle_picoseconds);
}

TEST_CASE("at a join time continues from the later branch") {
    MachineSetup setup = functional_setup(
        "mesh.columns=1 mesh.rows=1 map.source=noise tests.normal_threshold=0 tests.view_threshold=0 "
        "tests.generation_limit=1 timing.transform_latency=500");
    setup.base_triangles.resize(1);
    Simulation simulation(setup, 1'000'000);
    REQUIRE(simulation.run().empty());
    REQUIRE(simulation.monitor.mesh.triangles.size() == 4);
    // Four children in sequence; for them the tests do not wait for Transform: Get Triangle 1, Calculate New P 1,
    // Displace Vertex 6 and a read of the map, Transform, Pass or Tessellate 1, Lighting 4.
    const std::uint64_t expected = 4 * (1 + 1 + 6 + 1 + 500 + 1 + 4);
    CHECK(sc_core::sc_time_stamp().value() == expected * setup.design.timing.cycle_picoseconds);
}

TEST_CASE("a second frame gives the same triangles again") {
    const MachineSetup setup = functional_setup();
    Simulation simulation(setup, 1'000'000);
    REQUIRE(simulation.run().empty());
    const auto first = keys(simulation.monitor.mesh);
    simulation.monitor.mesh.triangles.clear();
    simulation.host.send_again();
    REQUIRE(simulation.run().empty());
    CHECK((keys(simulation.monitor.mesh) == first));  // extra parentheses: nothing is printed
}

#include <catch2/catch.hpp>
#include <memory>
#include <tuple>
#include <vector>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/common/error.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/simulation.h"
#include "testbench/tests/machine/mesh_keys.h"

// The whole machine, from the host's triangles to the rasteriser. SystemC elaborates once a process, so each case runs
// one simulation.

using namespace tessera;
using tessera::testing::keys;

namespace {

/// In functional mode; test_timed_*.cpp have the other.
MachineSetup setup_of(Job job) {
    job.mode = Mode::functional;
    const Inputs inputs = load_inputs(job);
    return make_setup(inputs.resolved.job, inputs.mesh, inputs.map);
}

void check_run(const MachineSetup& setup, Simulation& simulation) {
    GoldenInputs golden(setup);
    Scoreboard scoreboard(setup.registers, golden);
    simulation.pipeline.pass_or_tessellate.decided.bind(scoreboard);
    REQUIRE(simulation.run().empty());

    const auto& counts = simulation.pipeline.pass_or_tessellate.counts();
    const EmittedMesh& mesh = simulation.monitor.mesh;
    CHECK(counts.finished == mesh.triangles.size());
    CHECK(simulation.rasteriser.triangles() + counts.culled == counts.finished);
    // conservation: every split adds one triangle
    CHECK(counts.finished == setup.base_triangles.size() + counts.edges_split);
    const auto& made = simulation.pipeline.tessellation.made_into();
    CHECK(simulation.pipeline.triangle_queue.taken() == made[1] + 2 * made[2] + 3 * made[3] + 4 * made[4]);
    CHECK(simulation.pipeline.get_triangle.queue_triangles() == simulation.pipeline.triangle_queue.taken());
    CHECK(simulation.pipeline.saturations().total() == 0);

    const ConformanceResult result = scoreboard.result();
    INFO(result.first_mismatch);
    CHECK(result.mismatches == 0);
    CHECK(result.passed(0.5));
    CHECK(result.edges == simulation.pipeline.edges_tested());
    const InvariantResult invariants = check_invariants(mesh, setup.base_triangles, setup.registers);
    INFO(invariants.first_violation);
    CHECK(invariants.passed());
    CHECK(invariants.collapsed == 0);
    CHECK(invariants.turned_over == 0);
    CHECK(invariants.open_texture_seam_edges == 0);
}

void expect_bare_mesh(const MachineSetup& setup) {
    Simulation simulation(setup, 1'000'000);
    check_run(setup, simulation);
    BareRecursion bare(setup);
    EmittedMesh mesh;
    CHECK(bare.run(mesh) == simulation.pipeline.edges_tested());
    CHECK(mesh.triangles.size() > setup.base_triangles.size());
    CHECK((keys(mesh) == keys(simulation.monitor.mesh)));  // not to be printed
}

void expect_bare_mesh(const Job& job) {
    expect_bare_mesh(setup_of(job));
}

/// A constant map must leave every triangle of the mesh whole.
void expect_whole(Job job, double value) {
    job.map.source = MapSource::constant;
    job.map.value = value;
    job.map.width = 97;
    job.map.height = 61;
    job.tests.summed_height_threshold = 0;
    job.tests.view_threshold = 0;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    REQUIRE(simulation.run().empty());
    CHECK(simulation.monitor.mesh.triangles.size() == setup.base_triangles.size());
    CHECK(simulation.pipeline.pass_or_tessellate.counts().edges_split == 0);
    CHECK(simulation.rasteriser.triangles() == setup.base_triangles.size());
}

Job cylinder_job() {
    Job job;
    job.mesh.source = MeshSource::cylinder;
    return job;
}

Job sphere_job() {
    Job job;
    job.mesh.source = MeshSource::sphere;
    return job;
}

}  // namespace

TEST_CASE("half donut: the pipeline's mesh is the bare datapath's, bit for bit") {
    expect_bare_mesh(Job{});
}

TEST_CASE("half donut, every item through its packed form: the same mesh") {
    MachineSetup setup = setup_of(Job{});
    setup.design.packed_streams = true;
    expect_bare_mesh(setup);
}

TEST_CASE("half donut, last in first out: the same mesh") {
    Job job;
    job.hardware.queue_order = QueueOrder::lifo;
    expect_bare_mesh(job);
}

TEST_CASE("half donut, many host triangles at a time: the same mesh") {
    Job job;
    job.hardware.queue_watermark = 1000;
    expect_bare_mesh(job);
}

TEST_CASE("half donut, memories read by transactions: the same mesh, reads and time") {
    Job job;
    job.hardware.direct_memory = false;
    expect_bare_mesh(job);
}

TEST_CASE("reads through DMI and by transactions are counted alike") {
    Job job;
    job.hardware.direct_memory = false;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    REQUIRE(simulation.run().empty());
    const Pipeline& p = simulation.pipeline;
    CHECK(p.displace_vertex.displacement_map.reads() == p.displacement_map.transactions());
    CHECK(p.normal_map_reads() == p.normal_map.transactions());
    CHECK(p.summed_height_table_reads() == p.summed_height_table.transactions());
    CHECK(p.summed_height_table.transactions() == 12 * p.edges_tested());
    CHECK(p.displacement_map.transactions() == p.edges_tested() + 3 * setup.base_triangles.size());
}

TEST_CASE("half donut, always the first diagonal") {
    Job job;
    job.hardware.triangulation = Triangulation::first;
    expect_bare_mesh(job);
}

TEST_CASE("half donut, always the second diagonal") {
    Job job;
    job.hardware.triangulation = Triangulation::second;
    expect_bare_mesh(job);
}

TEST_CASE("half donut, culling: Lighting gets fewer, the mesh stays whole") {
    Job job;
    job.hardware.culling = Culling::back;
    job.camera.eye = {0, -4, 0.6};
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    check_run(setup, simulation);
    CHECK(simulation.pipeline.pass_or_tessellate.counts().culled > 0);
    CHECK(simulation.rasteriser.triangles() > 0);
}

TEST_CASE("narrow formats: wide SAT entries, few fraction bits") {
    Job job;
    job.formats.summed_height_bits = 44;
    job.formats.normal_bits = 12;
    job.formats.normal_fraction = 10;
    job.formats.position_bits = 24;
    job.formats.position_fraction = 12;
    job.formats.texture_fraction = 10;
    job.formats.displacement_bits = 10;
    expect_bare_mesh(job);
}

TEST_CASE("cylinder in repeat: the seam stays closed") {
    Job job = cylinder_job();
    job.map.source = MapSource::noise;
    job.map.width = 64;
    job.map.height = 33;
    job.map.address_u = Addressing::repeat;
    job.displacement.scale = 0.1;
    job.tests.view_threshold = 8;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    check_run(setup, simulation);
    CHECK(simulation.monitor.mesh.triangles.size() > 1000);
}

TEST_CASE("constant map splits nothing: plane, clamp") {
    expect_whole(Job{}, 0);
}
TEST_CASE("constant map splits nothing: plane, repeat") {
    Job job;
    job.map.address_u = job.map.address_v = Addressing::repeat;
    expect_whole(job, 1);
}
TEST_CASE("constant map splits nothing: cylinder, clamp") {
    expect_whole(cylinder_job(), 0.37);
}
TEST_CASE("constant map splits nothing: cylinder, repeat") {
    Job job = cylinder_job();
    job.map.address_u = Addressing::repeat;
    expect_whole(job, 1);
}
TEST_CASE("constant map splits nothing: sphere, clamp") {
    expect_whole(sphere_job(), 0.5);
}
TEST_CASE("constant map splits nothing: sphere, repeat") {
    Job job = sphere_job();
    job.map.address_u = Addressing::repeat;
    expect_whole(job, 0.001);
}

namespace {

/// Every third item of a stream waits on its way: the host's triangles and the queue's may overtake one another there.
template <class Item>
struct Detour : sc_core::sc_module,
                tlm::tlm_fw_transport_if<Stream<Item>>,
                tlm::tlm_bw_transport_if<Stream<Item>> {
    tlm::tlm_target_socket<32, Stream<Item>> in{"in"};
    tlm::tlm_initiator_socket<32, Stream<Item>> out{"out"};
    unsigned items = 0;
    unsigned& overtaken;

    Detour(const sc_core::sc_module_name& name, unsigned& overtakings)
        : sc_module(name), overtaken(overtakings) {
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
    tlm::tlm_sync_enum nb_transport_fw(Item&, tlm::tlm_phase&, sc_core::sc_time&) override {
        return tlm::TLM_ACCEPTED;
    }
    tlm::tlm_sync_enum nb_transport_bw(Item&, tlm::tlm_phase&, sc_core::sc_time&) override {
        return tlm::TLM_ACCEPTED;
    }
    bool get_direct_mem_ptr(Item&, tlm::tlm_dmi&) override { return false; }
    unsigned transport_dbg(Item&) override { return 0; }
    void invalidate_direct_mem_ptr(sc_dt::uint64, sc_dt::uint64) override {}
};

/// Puts a detour on each stream of parts.
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
                auto detour =
                    std::make_unique<Detour<Item>>(sc_core::sc_gen_unique_name("detour"), overtaken);
                from.bind(detour->in);
                detour->out.bind(to);
                detours.push_back(std::move(detour));
            });
    }
};

}  // namespace

TEST_CASE("functional mode: triangles may overtake one another on every stream, and the mesh is the same") {
    Job job;
    job.hardware.queue_watermark = 1000;  // so that the host sends while the queue does
    const MachineSetup setup = setup_of(job);
    Detours detours;
    Simulation simulation(setup, 1'000'000, 0, &detours);
    check_run(setup, simulation);
    BareRecursion bare(setup);
    EmittedMesh mesh;
    CHECK(bare.run(mesh) == simulation.pipeline.edges_tested());
    CHECK((keys(mesh) == keys(simulation.monitor.mesh)));  // not to be printed
    CHECK(simulation.pipeline.idle());
    CHECK(detours.overtaken > 0);
}

TEST_CASE("the triangle limit ends a run with a message that names its key") {
    Job job;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 500);
    CHECK_THROWS_AS(simulation.run(), ResourceError);
    CHECK(simulation.monitor.mesh.triangles.size() == 500);
}

TEST_CASE("a machine that is stopped with triangles in its queue is not idle") {
    Job job;
    job.mesh.columns = job.mesh.rows = 1;  // a base triangle that makes more than go without a pause
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 500);
    CHECK(simulation.pipeline.idle());
    CHECK_THROWS_AS(simulation.run(), ResourceError);
    CHECK(simulation.pipeline.triangle_queue.waiting() > 0);
    CHECK_FALSE(simulation.pipeline.idle());
}

TEST_CASE("a read outside a table is an error that names the reader") {
    Job job;
    job.hardware.direct_memory = false;
    MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    setup.registers.map.height *= 2;  // the units now take the map to be larger than its memory
    try {
        simulation.run();
        FAIL("no error");
    } catch (const sc_core::sc_report& report) {
        CHECK_THAT(report.what(),
                   Catch::Contains("tessera.displace_vertex") && Catch::Contains("TLM_ADDRESS_ERROR"));
    }
}

TEST_CASE("a base triangle's View Test waits for its corners' screen positions") {
    Job job;
    job.mesh.columns = job.mesh.rows = 1;
    job.map.source = MapSource::constant;
    MachineSetup setup = setup_of(job);
    setup.base_triangles.resize(1);
    setup.design.timing.transform.latency = 500;  // far more than the tests take
    Simulation simulation(setup, 1'000'000);
    REQUIRE(simulation.run().empty());
    // The host's time, one base triangle's first pass: Get Triangle 1, Calculate New P 1, Displace Vertex 6 and a
    // read of the map (a triangle's parts go side by side), Transform, the View Test 1, Pass or Tessellate 1, Tessellation 1, Triangle Queue 1. The
    // second pass, for the normals, is shorter and starts with the first.
    const std::uint64_t expected = 1 + 1 + 6 + 1 + 500 + 1 + 1 + 1 + 1;
    CHECK(sc_core::sc_time_stamp().value() == expected * setup.design.timing.cycle_picoseconds);
}

TEST_CASE("time joins at the later branch, also for what follows the join") {
    Job job;
    job.mesh.columns = job.mesh.rows = 1;
    job.map.source = MapSource::noise;
    job.tests.normal_threshold = 0;
    job.tests.view_threshold = 0;
    job.tests.generation_limit = 1;
    MachineSetup setup = setup_of(job);
    setup.base_triangles.resize(1);
    setup.design.timing.transform.latency = 500;
    Simulation simulation(setup, 1'000'000);
    REQUIRE(simulation.run().empty());
    REQUIRE(simulation.monitor.mesh.triangles.size() == 4);
    // Four children, one after another; for them the tests do not wait for Transform: Get Triangle 1, Calculate New P
    // 1, Displace Vertex 6 and a read of the map, Transform, Pass or Tessellate 1, Lighting 4.
    const std::uint64_t expected = 4 * (1 + 1 + 6 + 1 + 500 + 1 + 4);
    CHECK(sc_core::sc_time_stamp().value() == expected * setup.design.timing.cycle_picoseconds);
}

TEST_CASE("a second frame gives the same triangles again") {
    const MachineSetup setup = setup_of(Job{});
    Simulation simulation(setup, 1'000'000);
    REQUIRE(simulation.run().empty());
    const auto first = keys(simulation.monitor.mesh);
    simulation.monitor.mesh.triangles.clear();
    simulation.host.send_again();
    REQUIRE(simulation.run().empty());
    CHECK((keys(simulation.monitor.mesh) == first));  // not to be printed
}

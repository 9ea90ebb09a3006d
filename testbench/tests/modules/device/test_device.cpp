#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/tests/modules/device/bench.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/source_folder.h"

// The device writes the triangles that the testbench's rasteriser takes.

using namespace tessera;
using namespace tessera::testing;

namespace {

struct Row {
    std::string name;
    std::string settings;
    bool timed;
    std::uint32_t ring_size = 100;
    bool approximately_timed = false;
    int quantum_ns = 0;
    unsigned burst_bytes = 64;
    bool beyond = false;  // bits of table entries beyond their formats are set
    bool wires = true;    // reset and interrupt are connected
};

/// Restores the default job's sizes in small_job().
const char* const whole_job = "mesh.columns=0 mesh.rows=0 map.width=264 map.height=264 tests.generation_limit=12";

const char* const narrow_formats =
    "formats.position_bits=24 formats.position_fraction=12 formats.normal_bits=11 formats.normal_fraction=9 "
    "formats.displacement_bits=12 formats.summed_height_bits=26 tests.highlight=true";
const char* const narrow_and_codes =
    "formats.position_bits=24 formats.position_fraction=12 formats.normal_bits=11 formats.normal_fraction=9 "
    "formats.displacement_bits=5 formats.summed_height_bits=19 hardware.one_texel_from_map=true "
    "hardware.queue_capacity=8";

void same_as_testbench(const Row& row, const MachineSetup& setup) {
    if (row.quantum_ns > 0)
        tlm::tlm_global_quantum::instance().set(sc_core::sc_time(row.quantum_ns, sc_core::SC_NS));
    Reference reference("reference", setup);
    DeviceDesign design = design_of(setup);
    design.burst_bytes = row.burst_bytes;
    // the initial register values are not those that the frame needs
    const datapath::Registers initial = formats_of(setup);
    Bench bench({initial}, design, row.approximately_timed, row.wires);
    bench.cpu.approximately_timed = row.approximately_timed;
    const FramePlaces places = bench.place(setup, row.ring_size, row.beyond);
    LitKeys found;
    bench.cpu.program = [&](Processor&) {
        tessera_driver& driver = bench.init();
        set_frame(driver, setup, places);
        found = run_frame(driver);
        std::int64_t sent = 0;
        CHECK(tessera_get(&driver, TESSERA_REGISTER_TRIANGLES_SENT, &sent) == TESSERA_OK);
        CHECK(sent == places.triangle_count);
    };
    bench.run();
    CHECK(reference.machine.finished());
    CHECK(found.size() > 100);
    expect_same(found, reference.keys);
    CHECK_FALSE(bench.devices[0]->busy());
}

constexpr const char* rank_test =
    "mesh.source=lattice mesh.spacing=16 hardware.height_test=rank hardware.triangulation=greatest_rank "
    "tests.normal=false tests.view=false tests.rank_threshold=0.01 formats.bound_bits=7";
constexpr const char* rank_test_modern =
    "hardware.design=modern mesh.source=lattice mesh.spacing=16 hardware.height_test=rank "
    "hardware.triangulation=greatest_rank tests.normal=false tests.view=false tests.rank_threshold=0.01";

constexpr const char* curvature_test =
    "mesh.source=lattice mesh.spacing=16 hardware.height_test=curvature tests.normal=false tests.view=false "
    "tests.curvature_threshold=0.02";
constexpr const char* curvature_test_modern =
    "hardware.design=modern hardware.height_test=curvature map.address_u=repeat map.address_v=repeat "
    "tests.curvature_threshold=0.02";
constexpr const char* mipmap_test =
    "hardware.design=modern hardware.height_test=mipmap tests.mipmap_filter=maximum tests.mipmap_threshold=0.01";
constexpr const char* rank_test_in_view =
    "hardware.design=modern mesh.source=lattice mesh.spacing=16 hardware.height_test=rank "
    "hardware.triangulation=greatest_rank tests.normal=false tests.rank_view=per_pixel tests.rank_threshold=20 "
    "formats.bound_bits=8 tests.bound_threshold=3";

const CaseTable<Row> same{
    "the device writes the testbench's triangles: ",
    {
        {"functional", "", false},
        {"timed", "", true},
        {"functional, reset and interrupt not connected", "", false, 100, false, 0, 64, false, false},
        {"timed, reset and interrupt not connected", "", true, 100, false, 0, 64, false, false},
        {"timed, random stalls", "timing.stalls_seed=3 timing.stalls_per_mille=500 timing.stalls_longest=2000", true,
         1},
        {"functional, approximately timed processor", "", false, 100, true},
        {"timed, approximately timed processor", "", true, 100, true},
        {"functional, a ring of one record", "", false, 1},
        {"timed, a ring of one record", "", true, 1},
        {"functional, a ring of 7", "", false, 7},
        {"timed, a ring of 7, bursts of 4 bytes", "", true, 7, false, 0, 4},
        {"functional, a large ring", "", false, 20000},
        {"timed, a large ring, bursts of 4096 bytes", "", true, 20000, false, 0, 4096},
        {"functional, quantum 1 us", "", false, 100, false, 1000},
        {"functional, quantum 1 ms", "", false, 1000, false, 1000000},
        {"timed, quantum 1 us", "", true, 100, false, 1000},
        {"functional, culled, a sphere",
         "mesh.source=sphere hardware.culling=back map.source=noise tests.generation_limit=3", false},
        {"timed, culled, a sphere, spilling",
         "mesh.source=sphere hardware.culling=back map.source=noise tests.generation_limit=3 "
         "hardware.queue_capacity=8",
         true},
        {"functional, the default job", whole_job, false},
        {"timed, the default job", whole_job, true},
        {"functional, modern design", "hardware.design=modern", false},
        {"timed, modern design", "hardware.design=modern", true},
        {"timed, tables behind caches",
         "timing.summed_height_table_cache_bytes=1024 timing.normal_map_cache_bytes=1024 "
         "timing.displacement_map_cache_bytes=1024",
         true},
        {"functional, a bilinear filter, a repeated map",
         "hardware.displacement_filter=bilinear map.address_u=repeat map.address_v=repeat", false},
        {"timed, a bilinear filter, modern design", "hardware.displacement_filter=bilinear hardware.design=modern",
         true},
        {"functional, a Rank Test on a lattice wider than the map", rank_test, false, 100, false, 0, 64, true},
        {"timed, a Rank Test, modern design", rank_test_modern, true},
        {"functional, a Curvature Test on a lattice wider than the map", curvature_test, false, 100, false, 0, 64,
         true},
        {"timed, a Curvature Test, modern design, a repeated map", curvature_test_modern, true},
        {"timed, a Mipmap Test, modern design", mipmap_test, true},
        {"timed, a view-dependent Rank Test, modern design", rank_test_in_view, true},
        {"functional, watermark 50", "hardware.queue_watermark=50", false, 3},
        {"timed, watermark 50", "hardware.queue_watermark=50", true, 3},
        {"functional, narrow formats", narrow_formats, false},
        {"functional, narrow formats, surplus bits set in memory", narrow_formats, false, 100, false, 0, 4, true},
        {"timed, narrow formats, surplus bits set in memory, spilling, codes in vertices", narrow_and_codes, true, 100,
         false, 0, 64, true},
    },
    [](const Row& row) { same_as_testbench(row, setup_of(small_job(row.timed, row.settings))); }};

const CaseTable<Row> examples{"the device writes the triangles of an example job: ",
                              {
                                  {"half_donut, functional", "half_donut", false, 5000},
                                  {"half_donut, timed", "half_donut", true, 5000},
                                  {"crater_lake_24, functional", "crater_lake_24", false, 5000},
                                  {"crater_lake_24, timed", "crater_lake_24", true, 5000},
                                  {"crater_lake_704, functional", "crater_lake_704", false, 5000},
                                  {"crater_lake_704, timed", "crater_lake_704", true, 5000},
                                  {"head, functional", "head", false, 5000},
                                  {"head, timed", "head", true, 5000},
                                  {"teapot, functional", "teapot", false, 5000},
                                  {"teapot, timed", "teapot", true, 5000},
                              },
                              [](const Row& row) {
                                  Job job =
                                      read_job(source_folder() / "testbench/examples/jobs" / (row.settings + ".toml"));
                                  resolve_paths(job, {});
                                  job.mode = row.timed ? Mode::timed : Mode::functional;
                                  same_as_testbench(row, setup_of(job));
                              }};

}  // namespace

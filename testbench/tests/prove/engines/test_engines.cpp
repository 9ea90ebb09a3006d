#include <catch2/catch.hpp>
#include <string>

#include "testbench/common/error.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/engine.h"
#include "testbench/machine/inputs.h"
#include "testbench/prove/engines/engine_run.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/source_folder.h"

// Timed mode by a schedule equals timed mode by the clock in all figures, the order of the mesh and every item's
// cycles; and the choice of the engine. testbench/prove/engines compares random designs.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

struct Row {
    std::string name;
    std::string settings;
    std::string job = "half_donut";
};

const CaseTable designs(
    "both engines give the same: ",
    {
        Row{"half donut", ""},
        {"Crater Lake on 24 triangles", "", "crater_lake_24"},
        {"Crater Lake on 704 triangles", "", "crater_lake_704"},
        {"Crater Lake by ranks, tests in parallel",
         "hardware.test_order=parallel tests.rank_view=none tests.rank_threshold=0.02", "crater_lake_rank"},
        {"Crater Lake by curvature", "hardware.height_test=curvature tests.normal=false", "crater_lake_24"},
        {"Crater Lake by curvature, a bilinear filter, banks, random stalls",
         "hardware.height_test=curvature tests.curvature_threshold=1 hardware.displacement_filter=bilinear "
         "timing.displacement_map_banks=4 timing.displacement_map_latency=7 timing.curvature_table_banks=3 "
         "timing.stalls_seed=3 timing.stalls_per_mille=300 timing.stalls_longest=20",
         "crater_lake_24"},
        {"teapot", "", "teapot"},
        {"head", "", "head"},
        {"last in first out", "hardware.queue_order=lifo"},
        {"final edges", "hardware.final_edges=true"},
        {"a bilinear filter", "hardware.displacement_filter=bilinear"},
        {"Highlight Test and culling", "tests.highlight=true hardware.culling=back"},
        {"no tests with tables", "tests.normal=false tests.summed_height=false"},
        {"banks that overlap the reads of rectangles",
         "timing.summed_height_table_banks=8 timing.summed_height_table_interleave=xor "
         "timing.summed_height_table_window=12"},
        {"four Transform pipelines, a high watermark",
         "hardware.transform_pipelines=4 timing.transform_interval=4 hardware.queue_watermark=50"},
        {"two machines", "hardware.machines=2"},
        {"a machine without triangles", "mesh.source=plane mesh.columns=1 mesh.rows=1 hardware.machines=3"},
        {"three tests units", "hardware.tests_units=3"},
        {"three tests units, four ports, last in first out, two machines",
         "hardware.tests_units=3 timing.summed_height_table_ports=4 hardware.queue_order=lifo hardware.machines=2"},
        {"three tests units far ahead of the geometry, one place in Pass or Tessellate, random stalls",
         "hardware.tests_units=3 timing.displacement_map_ports=1 timing.displacement_map_latency=60 "
         "timing.displace_vertex_interval=9 timing.pass_or_tessellate_buffer=1 timing.summed_height_table_ports=12 "
         "timing.stalls_seed=3 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"three tests units, latencies and stalls of thousands of cycles",
         "hardware.tests_units=3 tests.generation_limit=2 timing.transform_latency=3000 timing.normal_map_latency=5000 "
         "timing.stalls_seed=3 timing.stalls_per_mille=20 timing.stalls_longest=2500"},
        {"Crater Lake by curvature, three tests units, random stalls",
         "hardware.tests_units=3 hardware.height_test=curvature tests.curvature_threshold=1 timing.stalls_seed=5 "
         "timing.stalls_per_mille=200 timing.stalls_longest=9",
         "crater_lake_24"},
        {"sums over one texel from the map", "hardware.one_texel_from_map=true"},
        {"sums over one texel from the map, three tests units, one slow port, random stalls",
         "hardware.one_texel_from_map=true hardware.tests_units=3 timing.summed_height_table_ports=12 "
         "timing.displacement_map_ports=1 timing.displacement_map_width=1 timing.stalls_seed=3 "
         "timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"random stalls, last in first out",
         "hardware.queue_order=lifo timing.stalls_seed=3 timing.stalls_per_mille=300 "
         "timing.stalls_longest=20"},
        {"one place in Pass or Tessellate", "timing.pass_or_tessellate_buffer=1"},
        {"stalls longer than a part takes to Pass or Tessellate",
         "timing.stalls_seed=3 timing.stalls_per_mille=20 timing.stalls_longest=200"},
    },
    [](const Row& row) {
        Job job =
            with_settings(read_job(source_folder() / "testbench/examples/jobs" / (row.job + ".toml")), row.settings);
        validate(job);
        resolve_paths(job, {});
        const Inputs inputs = load_inputs(job);
        MachineSetup setup = make_setup(inputs.resolved.job, inputs.mesh, inputs.map);
        choose_engine(inputs.resolved.job, setup);
        REQUIRE(setup.scheduled);
        const std::string clocked = engine_run(inputs.resolved.job, inputs.mesh, inputs.map, false);
        CHECK_THAT(clocked, Contains("timing.cycles,"));
        CHECK(first_difference(clocked, engine_run(inputs.resolved.job, inputs.mesh, inputs.map, true)) == "");
    });

/// For the default job with these settings: the engine and the reason, or the error message.
std::string chosen(const std::string& settings) {
    const Job job = with_settings(Job{}, settings);
    const Inputs inputs = load_inputs(job);
    MachineSetup setup = make_setup(inputs.resolved.job, inputs.mesh, inputs.map);
    try {
        choose_engine(inputs.resolved.job, setup);
    } catch (const InputError& error) {
        return error.what();
    }
    return (setup.scheduled ? "schedule: " : "clocked: ") + setup.engine_reason;
}

}  // namespace

TEST_CASE("the engine of a run is chosen with a reason") {
    CHECK(chosen("") == "schedule: this design supports it");
    CHECK(chosen("hardware.height_test=curvature") == "schedule: this design supports it");
    CHECK(chosen("hardware.tests_units=3") == "schedule: this design supports it");
    CHECK(chosen("hardware.one_texel_from_map=true") == "schedule: this design supports it");
    CHECK(chosen("timing.engine=schedule") == "schedule: timing.engine");
    CHECK(chosen("timing.engine=clocked") == "clocked: timing.engine");
    CHECK(chosen("mode=functional") == "clocked: ");
    const char* const without_schedule[][2] = {
        {"hardware.work", "\"family\""},
        {"hardware.test_order", "\"cheap_first\""},
        {"hardware.queue_capacity", "64"},
        {"timing.displacement_map_cache_bytes", "4096"},
        {"timing.normal_map_cache_bytes", "4096"},
        {"timing.summed_height_table_cache_bytes", "4096"},
        {"limits.cycles_without_progress", "999999"},
        {"output.vcd", "true"},
        {"output.timeline", "true"},
        {"check.reads", "true"},
    };
    for (const auto& [key, value] : without_schedule) {
        const std::string setting = std::string(key) + "=" + value;
        INFO(setting);
        const std::string named = std::string(key) + " = " + value;
        CHECK(chosen(setting) == "clocked: " + named + " has no schedule");
        CHECK_THAT(chosen(setting + " timing.engine=schedule"),
                   Contains("`timing.engine` = \"schedule\", but `" + std::string(key) + "` = " + value +
                            " has no schedule: set " + std::string(key) + " = ") &&
                       Contains("timing.engine = \"auto\""));
    }
}

TEST_CASE("a difference between two engines is reported with its line") {
    CHECK(first_difference("a\nb\n", "a\nb\n").empty());
    CHECK(first_difference("a\nb\n", "a\nc\n") == "clocked:  b\nschedule: c");
    CHECK(first_difference("a\n", "a\nc\n") == "clocked:  \nschedule: c");
}

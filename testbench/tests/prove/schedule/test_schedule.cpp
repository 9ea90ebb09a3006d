#include <catch2/catch.hpp>
#include <string>

#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/inputs.h"
#include "testbench/prove/schedule/schedule_run.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/source_folder.h"

// The schedule of a run equals the run in the order of the triangles and in every item's cycles.
// testbench/prove/schedule compares random designs.

using namespace tessera;
using namespace tessera::testing;

namespace {

struct Row {
    std::string name;
    std::string settings;
    std::string job = "half_donut";
};

const CaseTable designs(
    "the schedule equals the run: ",
    {
        Row{"half donut", ""},
        {"Crater Lake on 24 triangles", "", "crater_lake_24"},
        {"Crater Lake on 704 triangles", "", "crater_lake_704"},
        {"Crater Lake by ranks, tests in parallel",
         "hardware.test_order=parallel tests.rank_view=none tests.rank_threshold=0.02", "crater_lake_rank"},
        {"Crater Lake by curvature", "hardware.height_test=curvature tests.normal=false", "crater_lake_24"},
        {"Crater Lake by curvature, a bilinear filter, banks, random stalls",
         "hardware.height_test=curvature tests.curvature_threshold=1 hardware.displacement_filter=bilinear "
         "timing.displacement_map_banks=4 timing.displacement_map_latency=7 timing.height_table_banks=3 "
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
        job = inputs.resolved.job;
        job.mode = Mode::timed;
        CHECK(schedule_difference(job, inputs.mesh, inputs.map) == "");
    });

}  // namespace

TEST_CASE("designs without a schedule are told apart") {
    for (const char* const settings :
         {"hardware.design=modern", "hardware.test_order=cheap_first", "hardware.queue_capacity=64",
          "hardware.tests_units=3", "hardware.one_texel_from_map=true", "timing.displacement_map_cache_bytes=4096",
          "timing.normal_map_cache_bytes=4096", "timing.summed_height_table_cache_bytes=4096"}) {
        INFO(settings);
        const Job job = with_settings({}, settings);
        const Inputs inputs = load_inputs(job);
        CHECK(schedule_difference(inputs.resolved.job, inputs.mesh, inputs.map) == "this design has no schedule");
    }
}

TEST_CASE("a difference between run and schedule is reported with its line") {
    CHECK(first_difference("a\nb\n", "a\nb\n").empty());
    CHECK(first_difference("a\nb\n", "a\nc\n") == "clocked:  b\nschedule: c");
    CHECK(first_difference("a\n", "a\nc\n") == "clocked:  \nschedule: c");
}
